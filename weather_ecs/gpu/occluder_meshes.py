"""Meshes of occluders on the GPU, one per pair of arrays however many occluders share it."""

from __future__ import annotations

import math
from collections.abc import Iterable
from struct import Struct
from typing import Any, TypeAlias

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import OccluderData
from weather_ecs.gpu.occluder_motion import OccluderMotion
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.physics.vectors import Rows, product_columns

DRAW = ProgramKey(vertex="occluder.vert", fragment="occluder.frag")
MOTION = ProgramKey(vertex="occluder.vert", fragment="occluder.frag", defines=("MOTION",))
MATRIX_BYTES, MOTION_BYTES = 64, 48
FEW = 4  # that share a mesh: so few are placed quicker without numpy
MATRIX, MOTION_ROWS = Struct("<16f"), Struct("<12f")

_Name: TypeAlias = tuple[int, int, bool]  # of vertices, of indices; with velocities


class _Mesh:
    """One mesh, and room for the matrices of those that share it; `moving`: and for velocities."""

    def __init__(
        self,
        ctx: moderngl.Context,
        program: moderngl.Program,
        occluder: OccluderData,
        moving: bool = False,
    ) -> None:
        # Holding the arrays keeps their identities, by which meshes are found, from being reused.
        self.arrays = (occluder.vertices, occluder.indices)
        points = np.ascontiguousarray(occluder.vertices, np.float32)
        low, high = points.min(axis=0), points.max(axis=0)
        self.center: list[float] = (0.5 * (low + high)).astype(np.float64).tolist()
        self.radius = 0.5 * float(np.linalg.norm(high - low))
        self._ctx, self._program, self._moving = ctx, program, moving
        self._vertices = ctx.buffer(points)
        self._indices = ctx.buffer(np.ascontiguousarray(occluder.indices, np.uint32))
        self._make_room(1)

    def _make_room(self, count: int) -> None:
        self._room = count
        self._matrices = self._ctx.buffer(reserve=count * MATRIX_BYTES, dynamic=True)
        content: list[tuple[Any, ...]] = [
            (self._vertices, "3f", "in_vertex"),
            (self._matrices, "16f/i", "in_to_map"),
        ]
        self._motions: moderngl.Buffer | None = None
        if self._moving:
            self._motions = self._ctx.buffer(reserve=count * MOTION_BYTES, dynamic=True)
            content.append((self._motions, "4f 4f 4f/i", "in_x", "in_y", "in_z"))
        self._array = self._ctx.vertex_array(self._program, content, index_buffer=self._indices)

    def draw(self, count: int, matrices: bytes, motions: bytes | None = None) -> None:
        """Draw it `count` times, float32: with matrices column by column; motions: (n, 3, 4)."""
        if count > self._room:
            self._release_room()
            self._make_room(1 << (count - 1).bit_length())
        self._matrices.orphan()
        self._matrices.write(matrices)
        if self._motions is not None and motions is not None:
            self._motions.orphan()
            self._motions.write(motions)
        self._array.render(moderngl.TRIANGLES, instances=count)

    def placed(self, transform: NDArray[np.float64], to_map: Rows) -> bytes | None:
        """The matrix of one that stands so, column by column; None where it lies outside."""
        m = product_columns(to_map, transform.tolist())
        x, y, z = self.center
        for k in (0, 1):
            a, b, c = m[k], m[4 + k], m[8 + k]
            # How far the sphere about a mesh reaches in the map, which is sheared.
            reach = self.radius * math.sqrt(a * a + b * b + c * c)
            if abs(a * x + b * y + c * z + m[12 + k]) > 1.0 + reach:
                return None
        return MATRIX.pack(*m)

    def all_placed(
        self, transforms: list[NDArray[np.float64]], to_map: NDArray[np.float64]
    ) -> tuple[bytes, NDArray[np.intp]]:
        """The same of many: the matrices of those within, and which they are."""
        matrices = to_map @ np.array(transforms, np.float64)
        level = matrices[:, :2]
        at = np.abs(level[:, :, :3] @ np.array(self.center) + level[:, :, 3])
        reach = self.radius * np.sqrt(np.square(level[:, :, :3]).sum(axis=2))
        within = np.flatnonzero((at <= 1.0 + reach).all(axis=1))
        return matrices[within].transpose(0, 2, 1).astype(np.float32).tobytes(), within

    def _release_room(self) -> None:
        for thing in (self._array, self._matrices, self._motions):
            if thing is not None:
                thing.release()

    def release(self) -> None:
        self._release_room()
        self._indices.release()
        self._vertices.release()


class OccluderMeshes:
    """Uploads meshes at their first use and gives back those of occluders that are gone."""

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader) -> None:
        self._ctx = ctx
        self._programs = shaders.program(DRAW), shaders.program(MOTION)
        self._meshes: dict[_Name, _Mesh] = {}

    def draw(
        self,
        occluders: Iterable[OccluderData],
        to_map: NDArray[np.float64],
        motion: OccluderMotion | None = None,
    ) -> int:
        """Draw occluders that have meshes with the map's matrix (4, 4); returns how many are in it.

        `to_map` takes world points to the map's clip space. What lies outside is left out, and what
        shares a mesh is drawn at once. With `motion` their velocities are drawn, too.
        """
        moving = motion is not None
        groups: dict[_Name, list[OccluderData]] = {}
        for occluder in occluders:
            key = (id(occluder.vertices), id(occluder.indices), moving)
            group = groups.get(key)
            if group is None:
                group = groups[key] = []
                if key not in self._meshes:
                    program = self._programs[moving]
                    self._meshes[key] = _Mesh(self._ctx, program, occluder, moving)
            group.append(occluder)
        return sum(
            self._draw(self._meshes[key], some, to_map, motion) for key, some in groups.items()
        )

    @staticmethod
    def _draw(
        mesh: _Mesh,
        group: list[OccluderData],
        to_map: NDArray[np.float64],
        motion: OccluderMotion | None,
    ) -> int:
        if len(group) <= FEW:
            rows = to_map.tolist()
            each = [(o, mesh.placed(o.transform, rows)) for o in group]
            shown = [o for o, matrix in each if matrix is not None]
            matrices = b"".join([matrix for _, matrix in each if matrix is not None])
        else:
            matrices, within = mesh.all_placed([o.transform for o in group], to_map)
            shown = [group[k] for k in within.tolist()]
        if shown:
            motions = None
            if motion is not None:
                motions = b"".join([MOTION_ROWS.pack(*motion.of(o)) for o in shown])
            mesh.draw(len(shown), matrices, motions)
        return len(shown)

    def keep(self, occluders: Iterable[OccluderData]) -> None:
        """Give back the meshes that none of `occluders` uses."""
        wanted = {(id(o.vertices), id(o.indices)) for o in occluders if o.vertices is not None}
        for key in [k for k in self._meshes if k[:2] not in wanted]:
            self._meshes.pop(key).release()

    def __len__(self) -> int:
        return len(self._meshes)

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for mesh in self._meshes.values():
            mesh.release()
        self._meshes.clear()
