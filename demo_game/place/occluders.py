"""Simple meshes for what rain can hit; coarser than what is drawn."""

from __future__ import annotations

from collections.abc import Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from .cabin import WINDOWS
from .cabin_solid import Block, pane_blocks
from .figure import PARTS
from .jetty import deck
from .layout import BIRCH, BUSH, CONIFER
from .mesh import Builder, Mesh
from .rocks import sphere
from .scatter import VARIANTS, Trees
from .terrain import Terrain


class Occluder(NamedTuple):
    """A mesh rain can hit; a dynamic one is in its own axes, placed by `Place.poses` by name."""

    name: str
    vertices: NDArray  # (n, 3) f4, m
    indices: NDArray  # (m, 3) u4
    dynamic: bool


def _block_mesh(blocks: list[Block], origin: NDArray) -> tuple[NDArray, NDArray]:
    build = Builder()
    for block in blocks:
        build.box(block.center + origin, block.size, (1, 1, 1), rotation=block.rotation)
    mesh = build.build()
    return mesh.vertices, mesh.indices


def _tree_mesh(trees: Trees) -> tuple[NDArray, NDArray]:
    points, faces = sphere(1)
    vertices, indices, count = [], [], 0
    for shape, foot, tall in zip(trees.shape, trees.foot, trees.height, strict=True):
        kind = shape // VARIANTS
        if kind == CONIFER:
            angle = np.linspace(0, 2 * np.pi, 8, endpoint=False)
            ring = np.stack([0.21 * np.cos(angle), np.full(8, 0.14), 0.21 * np.sin(angle)], 1)
            shell = np.concatenate([ring, [[0.0, 1.0, 0.0]]])
            triangles = np.array([[(k + 1) % 8, k, 8] for k in range(8)])
        elif kind == BUSH:
            shell, triangles = points * (0.75, 0.45, 0.75) + (0.0, 0.42, 0.0), faces
        else:
            wide = 0.19 if kind == BIRCH else 0.30
            shell, triangles = points * (wide, 0.30, wide) + (0.0, 0.62, 0.0), faces
        vertices.append(shell * tall + foot)
        indices.append(triangles + count)
        count += len(shell)
    return np.concatenate(vertices).astype("f4"), np.concatenate(indices).astype("u4")


def _ground_mesh(terrain: Terrain, step: float = 2.0) -> tuple[NDArray, NDArray]:
    xs, zs = np.arange(-110.0, 110.1, step), np.arange(-175.0, 100.1, step)
    gx, gz = np.meshgrid(xs, zs)
    vertices = np.stack([gx, np.asarray(terrain.height(gx, gz)), gz], -1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(len(xs) - 1), np.arange(len(zs) - 1))
    a = (j * len(xs) + i).ravel()
    n = len(xs)
    quads = np.stack([a, a + n, a + 1, a + 1, a + n, a + n + 1], 1)
    return vertices.astype("f4"), quads.reshape(-1, 3).astype("u4")


def occluders(
    terrain: Terrain, cabin: list[Block], origin: NDArray, trees: Trees, meshes: dict[str, Mesh],
    figure_parts: list[Mesh],
) -> Iterator[Occluder]:  # fmt: skip
    """Everything rain can hit, ground included."""
    yield Occluder("ground", *_ground_mesh(terrain), False)
    roofs = [b for b in cabin if not b.solid]
    yield Occluder("cabin_roof", *_block_mesh(roofs, origin), False)
    # The windows have panes, which are not drawn; the door stands open.
    closed = [b for b in cabin if b.solid] + pane_blocks(WINDOWS)
    yield Occluder("cabin", *_block_mesh(closed, origin), False)
    near = Trees(*(getattr(trees, f)[~trees.far] for f in ("shape", "foot", "height", "turn",
                                                           "far")))  # fmt: skip
    yield Occluder("trees", *_tree_mesh(near), False)
    for name in ("lamps", "fences", "rocks", "windmill", "mailbox"):
        yield Occluder(name, meshes[name].vertices, meshes[name].indices, False)
    center, size = deck(terrain)
    build = Builder()
    build.box(center, size, (1, 1, 1))
    planks = build.build()
    yield Occluder("jetty", planks.vertices, planks.indices, False)
    yield Occluder("sails", meshes["sails"].vertices, meshes["sails"].indices, True)
    for name, mesh in zip(PARTS, figure_parts, strict=True):
        yield Occluder(f"figure/{name}", mesh.vertices, mesh.indices, True)
