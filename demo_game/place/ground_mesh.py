"""Meshes of the ground: the walkable grid in chunks, the hills around it, the pond's sheet."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import layout, palette
from .noise import smoothstep
from .paint import MARGIN
from .terrain import Terrain

CHUNK = 8  # cells along a chunk's side
HILL_RINGS = (330.0, 420.0, 520.0, 640.0, 780.0, 950.0, 1150.0, 1400.0, 1700.0, 2100.0, 2600.0)
HILL_SECTORS = 288
CHUNK_SECTORS = 24


SKIRT = 0.7  # m, how far a coarse chunk's rim hangs down to close the gaps


@dataclass(frozen=True)
class GroundMesh:
    """The ground's triangles; chunks are (first triangle, triangles) with their boxes."""

    vertices: NDArray  # (n, 3) f4, m
    normals: NDArray  # (n, 3) f4
    colors: NDArray  # (n, 3) f4, linear albedo where the painted map does not reach
    painted: NDArray  # (n,) f4, 1 where the painted map holds
    indices: NDArray  # (m, 3) u4
    chunks: NDArray  # (c, 2) in full
    coarse: NDArray  # (c, 2) for the distance; the same as `chunks` where there is none
    skirts: NDArray  # (c, 2) round a coarse chunk, for where it meets one in full
    beside: NDArray  # (c, 4) neighbours of a chunk, itself where there is none
    low: NDArray  # (c, 3) m
    high: NDArray


def wild_color(terrain: Terrain, x: NDArray, z: NDArray) -> NDArray:
    """(..., 3) albedo of the land beyond the meadow: grass, heath, woods."""
    noise = terrain.noise
    out = np.hypot(x, z + 40.0)[..., None]
    dry = noise.fbm(x / 90.0, z / 90.0, 3)[..., None]
    color = palette.GRASS + (palette.GRASS_DRY - palette.GRASS) * np.clip(dry + 0.3, 0, 1)
    heath = smoothstep(0.05, 0.35, noise.fbm(x / 260.0 + 9, z / 260.0, 3))[..., None]
    color = color + (palette.HEATH - color) * heath * smoothstep(200.0, 600.0, out)
    wood = smoothstep(-0.02, 0.10, noise.fbm(x / 330.0, z / 330.0 + 4, 4))[..., None]
    return color + (palette.FOREST - color) * wood * smoothstep(170.0, 330.0, out) * 0.9


def _normals(points: NDArray, triangles: NDArray) -> NDArray:
    flat = np.cross(
        points[triangles[:, 1]] - points[triangles[:, 0]],
        points[triangles[:, 2]] - points[triangles[:, 0]],
    )
    normals = np.zeros_like(points)
    for k in range(3):
        np.add.at(normals, triangles[:, k], flat)
    return normals / np.linalg.norm(normals, axis=1, keepdims=True)


def _cells(columns: NDArray, rows: NDArray, width: int) -> NDArray:
    """(n, 3) triangles between grid lines, of vertices numbered row by row, `width` a row."""
    grid = np.meshgrid(np.arange(len(columns) - 1), np.arange(len(rows) - 1))
    i, j = grid[0].ravel(), grid[1].ravel()
    a, b = rows[j] * width + columns[i], rows[j] * width + columns[i + 1]
    c, d = rows[j + 1] * width + columns[i], rows[j + 1] * width + columns[i + 1]
    return np.stack([a, c, b, b, c, d], 1).reshape(-1, 3)


def _rim(columns: NDArray, rows: NDArray, width: int) -> NDArray:
    """Vertices round about a block of cells, closed: x up, z up, x down, z down."""
    return np.concatenate([
        rows[0] * width + columns, rows[1:] * width + columns[-1],
        rows[-1] * width + columns[-2::-1], rows[-2::-1] * width + columns[0],
    ])  # fmt: skip


def _grid(terrain: Terrain) -> tuple[NDArray, list[NDArray], list[NDArray], list[NDArray]]:
    """Points, chunks of triangles, their rims (vertices round about), their coarse triangles."""
    gx, gz = np.meshgrid(terrain.xs, terrain.zs)
    points = np.stack([gx, terrain.heights, gz], -1).reshape(-1, 3)
    width, depth = len(terrain.xs), len(terrain.zs)
    chunks, rims, coarse = [], [], []
    for j0 in range(0, depth - 1, CHUNK):
        for i0 in range(0, width - 1, CHUNK):
            columns = np.arange(i0, min(i0 + CHUNK, width - 1) + 1)
            rows = np.arange(j0, min(j0 + CHUNK, depth - 1) + 1)
            chunks.append(_cells(columns, rows, width))
            few_columns, few_rows = (np.unique(n[[0, len(n) // 2, -1]]) for n in (columns, rows))
            corner_x, corner_z = np.meshgrid(terrain.xs[columns], terrain.zs[rows])
            if terrain.pond_radius(corner_x, corner_z).min() < 1.8:
                few_columns, few_rows = columns, rows  # coarse, the bowl would hide the water
            coarse.append(_cells(few_columns, few_rows, width))
            rims.append(_rim(few_columns, few_rows, width))
    return points, chunks, rims, coarse


def _hills(terrain: Terrain) -> tuple[NDArray, list[NDArray]]:
    angle = np.linspace(0.0, 2.0 * np.pi, HILL_SECTORS + 1)
    r, a = np.meshgrid(np.array(HILL_RINGS), angle, indexing="ij")
    x, z = r * np.sin(a), r * np.cos(a) - 40.0
    y = terrain.surface(x, z)
    inside = (x > terrain.xs[0]) & (x < terrain.xs[-1])
    inside &= (z > terrain.zs[0]) & (z < terrain.zs[-1])
    y = np.where(inside, y - 9.0, y)  # below the grid where the grid is
    points = np.stack([x, y, z], -1).reshape(-1, 3)
    n = HILL_SECTORS + 1
    chunks = []
    for k in range(0, HILL_SECTORS, CHUNK_SECTORS):
        i, j = np.meshgrid(np.arange(k, k + CHUNK_SECTORS), np.arange(len(HILL_RINGS) - 1))
        a0 = (j * n + i).ravel()
        b, c, d = a0 + 1, a0 + n, a0 + n + 1
        chunks.append(np.stack([a0, c, b, b, c, d], 1).reshape(-1, 3))
    return points, chunks


def ground_mesh(terrain: Terrain, painted_low: NDArray, painted_high: NDArray) -> GroundMesh:
    """The whole ground; `painted_low`, `painted_high` are the painted map's corners (x, z)."""
    near, near_chunks, rims, coarse = _grid(terrain)
    far, far_chunks = _hills(terrain)
    near_normals = _normals(near, np.concatenate(near_chunks))
    points, normals = [near, far], [near_normals, _normals(far, np.concatenate(far_chunks))]
    chunks = near_chunks + [c + len(near) for c in far_chunks]
    count = len(near) + len(far)
    skirts: list[NDArray] = []
    for rim in rims:
        points.append(near[rim] - (0.0, SKIRT, 0.0))
        normals.append(near_normals[rim])
        k = np.arange(len(rim) - 1)
        a, b, c, d = rim[k], rim[k + 1], count + k, count + k + 1
        skirts.append(np.stack([a, b, c, b, d, c], 1).reshape(-1, 3))
        count += len(rim)
    vertices = np.concatenate(points)
    x, z = vertices[:, 0], vertices[:, 2]
    inside = np.minimum.reduce(
        [x - painted_low[0], painted_high[0] - x, z - painted_low[1], painted_high[1] - z]
    )
    boxes = [vertices[np.unique(c)] for c in chunks]
    whole, first = _ranges(chunks, 0)
    less, first = _ranges(coarse, first)
    less = np.concatenate([less, whole[len(less) :]])
    around, _ = _ranges(skirts, first)
    around = np.concatenate([around, np.zeros((len(far_chunks), 2), int)])
    return GroundMesh(
        vertices.astype("f4"),
        np.concatenate(normals).astype("f4"),
        wild_color(terrain, x, z).astype("f4"),
        smoothstep(2.0, MARGIN, inside).astype("f4"),
        np.concatenate(chunks + coarse + skirts).astype("u4"),
        whole,
        less,
        around,
        _beside(len(rims), -(-(len(terrain.xs) - 1) // CHUNK), len(chunks)),
        np.array([b.min(0) for b in boxes]),
        np.array([b.max(0) for b in boxes]),
    )


def _beside(count: int, columns: int, total: int) -> NDArray:
    """(total, 4) chunks next to each of the `count` in a grid; the others have none."""
    grid = np.arange(count).reshape(-1, columns)
    framed = np.pad(grid, 1, mode="edge")
    sides = framed[1:-1, :-2], framed[1:-1, 2:], framed[:-2, 1:-1], framed[2:, 1:-1]
    beside = np.repeat(np.arange(total)[:, None], 4, axis=1)
    beside[:count] = np.stack([side.ravel() for side in sides], 1)
    return beside


def _ranges(chunks: list[NDArray], first: int) -> tuple[NDArray, int]:
    """(c, 2) first triangle and triangles of each, numbered from `first`, and where they end."""
    counts = np.array([len(c) for c in chunks])
    starts = first + np.concatenate([[0], np.cumsum(counts)])
    return np.stack([starts[:-1], counts], 1), int(starts[-1])


def drowned(terrain: Terrain, vertices: NDArray) -> NDArray:
    """(n,) m that vertices lie below the pond's water, -1 to 1; -inf where no pond is near."""
    x, y, z = np.asarray(vertices, "f8").T
    deep = np.clip(terrain.pond_level - y, -1.0, 1.0)
    return np.where(terrain.pond_radius(x, z) < 1.6, deep, -np.inf)


def pond_mesh(terrain: Terrain, step: float = 1.0) -> tuple[NDArray, NDArray]:
    """(n, 4) f4 water vertices (x, y, z, depth m) and (m, 3) triangles, to just past the shore."""
    reach = np.array(layout.POND_RADII) * 1.35
    xs = np.arange(-reach[0], reach[0] + step, step) + layout.POND[0]
    zs = np.arange(-reach[1], reach[1] + step, step) + layout.POND[1]
    gx, gz = np.meshgrid(xs, zs)
    level = terrain.pond_level
    depth = level - np.asarray(terrain.height(gx, gz))
    depth = np.where(terrain.pond_radius(gx, gz) < 1.3, depth, -1.0)
    columns = len(xs)
    i, j = np.meshgrid(np.arange(columns - 1), np.arange(len(zs) - 1))
    a = (j * columns + i).ravel()
    quads = np.stack([a, a + columns, a + 1, a + 1, a + columns, a + columns + 1], 1)
    triangles = quads.reshape(-1, 3)
    triangles = triangles[(depth.ravel()[triangles] > 0.0).any(axis=1)]
    used, back = np.unique(triangles, return_inverse=True)
    vertices = np.stack([gx, np.full_like(gx, level), gz, depth], -1).reshape(-1, 4)[used]
    return vertices.astype("f4"), back.reshape(-1, 3).astype("u4")
