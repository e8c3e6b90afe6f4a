"""Trees in levels of detail, instanced."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from demo_game.place import Place, bake, flora, foliage
from demo_game.place.scatter import VARIANTS

from . import geometry
from .frame_block import FrameBlock
from .geometry import PLAIN_FORMAT, PLAIN_NAMES, VERTEX_FORMAT, VERTEX_NAMES
from .programs import Look, Variants, compile_program, release_all, set_matrix
from .quality import Quality

SHAPES = 4 * VARIANTS
SINGLE = 2  # the level whose leaves have no holes and two sides
Content = tuple[list[tuple[Any, ...]], moderngl.Buffer]  # of a vertex array, and its indices
INSTANCE_FORMAT = "4f4 4f4/i"


class Trees:
    """Every tree; each frame those seen are sorted by shape and level."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, place: Place) -> None:
        self.ctx = ctx
        self.shadow = compile_program(ctx, "shadow.vert", "shadow.frag", "TREES")
        trees = place.trees
        self._shape = trees.shape
        self._center = trees.foot + np.outer(trees.height, (0.0, 0.5, 0.0))
        self._radius = trees.height * 0.56
        self._far = trees.far
        up = np.zeros_like(self._center) + (0.0, 1.0, 0.0)
        points = trees.foot + (0.0, 2.0, 0.0)
        lamps = [(lamp.position, max(lamp.color)) for lamp in place.lamps]
        light = bake.lamp_light(points, up, lamps, [])
        tint = 0.86 + 0.28 * np.random.default_rng(place.seed + 9).random(len(light))
        self._rows = np.column_stack(
            [trees.foot, trees.height, np.cos(trees.turn), np.sin(trees.turn), light, tint]
        ).astype("f4")
        levels = foliage.leaf_levels()
        size = (levels[0].shape[1], levels[0].shape[0])
        self.leaves = ctx.texture(size, 2, levels[0].tobytes())
        self.leaves.build_mipmaps(max_level=len(levels) - 1)
        for k, data in enumerate(levels):
            self.leaves.write(data.tobytes(), level=k)
        self.leaves.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
        self.leaves.repeat_x = self.leaves.repeat_y = False
        self._meshes: list[list[moderngl.Buffer]] = []
        self._instances: list[moderngl.Buffer] = []
        plain: list[Content] = []
        holed_ones: list[Content] = []
        self._splits: list[tuple[int, int]] = []  # indices without holes, and all
        self._last: list[bytes] = [b""] * (SHAPES * flora.LEVELS)
        self._shadow_arrays: list[tuple[moderngl.VertexArray, int, moderngl.Buffer]] = []
        for shape in range(SHAPES):
            count = max(int((trees.shape == shape).sum()), 1)
            for level in range(flora.LEVELS):
                mesh = place.tree_mesh(shape, level)
                vertices = ctx.buffer(geometry.pack(mesh).tobytes())
                holed = flora.holed(mesh)
                order = np.argsort(holed, kind="stable")
                self._splits.append((int((~holed).sum()) * 3, mesh.indices.size))
                indices = ctx.buffer(mesh.indices[order].tobytes())
                instances = ctx.buffer(reserve=count * 32, dynamic=True)
                placed = (instances, INSTANCE_FORMAT, "in_foot", "in_turn")
                plain.append(([(vertices, PLAIN_FORMAT, *PLAIN_NAMES), placed], indices))
                textured = (vertices, VERTEX_FORMAT, *VERTEX_NAMES)
                holed_ones.append(([textured, placed], indices))
                self._meshes.append([vertices, indices])
                self._instances.append(instances)
            near = self._rows[(trees.shape == shape) & ~trees.far]
            if len(near):
                vertices, indices = self._meshes[-3]
                whole = ctx.buffer(near.tobytes())
                content: list[tuple[Any, ...]] = [(vertices, "3f4 16x1", "in_position")]
                content.append((whole, INSTANCE_FORMAT, "in_foot", "in_turn"))
                array = ctx.vertex_array(self.shadow, content, indices)
                self._shadow_arrays.append((array, len(near), whole))

        def look(contents: list[Content], *defines: str) -> Look:
            program = compile_program(ctx, "object.vert", "object.frag", "TREES", "SOFT", *defines)
            block.attach(program)
            return program, [ctx.vertex_array(program, *content) for content in contents]

        self.looks = (
            Variants(lambda *defines: look(plain, *defines)),
            Variants(lambda *defines: look(holed_ones, "LEAVES", *defines)),
        )

    def draw(self, planes: NDArray, camera: NDArray, quality: Quality, lowest: int = 0) -> None:
        """Draw what is seen; `lowest` is the finest level allowed."""
        offset = self._center - camera
        away = np.sqrt(np.einsum("ij,ij->i", offset, offset))
        reach = self._center @ planes[:, :3].T + planes[:, 3]
        seen = np.flatnonzero((reach > -self._radius[:, None]).all(axis=1))
        if not len(seen):
            return
        level = (away > quality.near_trees).astype("i8") + (away > quality.middle_trees)
        level += away > quality.far_trees
        np.maximum(level, np.where(self._far, 2, lowest), out=level)
        group = self._shape[seen] * flora.LEVELS + level[seen]
        order = np.lexsort((away[seen], group))
        seen, group = seen[order], group[order]
        starts = np.flatnonzero(np.diff(group, prepend=-1))
        ends = np.append(starts[1:], len(group))
        batches = []
        for start, end in zip(starts.tolist(), ends.tolist(), strict=True):
            slot = int(group[start])
            batches.append((float(away[seen[start]]), slot, end - start))
            raw = self._rows[seen[start:end]].tobytes()
            if raw != self._last[slot]:
                self._instances[slot].write(raw)
                self._last[slot] = raw
        batches.sort()
        bare, leafy = self.looks
        for _, slot, count in batches:  # what has no holes first: it hides the rest early
            if self._splits[slot][0]:
                if slot % flora.LEVELS != SINGLE:
                    self.ctx.enable(moderngl.CULL_FACE)
                else:
                    self.ctx.disable(moderngl.CULL_FACE)
                bare.arrays[slot].render(vertices=self._splits[slot][0], instances=count)
        self.ctx.disable(moderngl.CULL_FACE)
        for _, slot, count in batches:
            solid, whole = self._splits[slot]
            if whole > solid:
                leafy.arrays[slot].render(vertices=whole - solid, first=solid, instances=count)

    def draw_shadow(self, matrix: NDArray) -> None:
        """Draw those of the place itself from the sun."""
        set_matrix(self.shadow, "light_matrix", matrix)
        for array, count, _ in self._shadow_arrays:
            array.render(instances=count)

    def release(self) -> None:
        """Give everything back."""
        for array, _, whole in self._shadow_arrays:
            release_all((array, whole))
        release_all(self.looks)
        for buffers in self._meshes:
            release_all(buffers)
        release_all((*self._instances, self.leaves, self.shadow))
