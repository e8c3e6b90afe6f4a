"""Meshes of occluders on the GPU, one per pair of arrays however many occluders share it."""

from __future__ import annotations

from collections.abc import Iterable

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import OccluderData
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader

DRAW = ProgramKey(vertex="occluder.vert", fragment="occluder.frag")
MATRIX_BYTES = 64


class _Mesh:
    """One mesh, and room for the matrices of those that share it."""

    def __init__(
        self, ctx: moderngl.Context, program: moderngl.Program, occluder: OccluderData
    ) -> None:
        # Holding the arrays keeps their identities, by which meshes are found, from being reused.
        self.arrays = (occluder.vertices, occluder.indices)
        points = np.ascontiguousarray(occluder.vertices, np.float32)
        low, high = points.min(axis=0), points.max(axis=0)
        self.center = (0.5 * (low + high)).astype(np.float64)
        self.radius = 0.5 * float(np.linalg.norm(high - low))
        self._ctx, self._program = ctx, program
        self._vertices = ctx.buffer(points)
        self._indices = ctx.buffer(np.ascontiguousarray(occluder.indices, np.uint32))
        self._make_room(1)

    def _make_room(self, count: int) -> None:
        self._room = count
        self._matrices = self._ctx.buffer(reserve=count * MATRIX_BYTES, dynamic=True)
        self._array = self._ctx.vertex_array(
            self._program,
            [(self._vertices, "3f", "in_vertex"), (self._matrices, "16f/i", "in_to_map")],
            index_buffer=self._indices,
        )

    def draw(self, matrices: NDArray[np.float64]) -> None:
        """Draw it once for each matrix, (n, 4, 4) for column vectors."""
        count = len(matrices)
        if count > self._room:
            self._array.release()
            self._matrices.release()
            self._make_room(1 << (count - 1).bit_length())
        self._matrices.orphan()
        self._matrices.write(np.ascontiguousarray(matrices.transpose(0, 2, 1), np.float32))
        self._array.render(moderngl.TRIANGLES, instances=count)

    def release(self) -> None:
        for thing in (self._array, self._matrices, self._indices, self._vertices):
            thing.release()


class OccluderMeshes:
    """Uploads meshes at their first use and gives back those of occluders that are gone."""

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader) -> None:
        self._ctx = ctx
        self._program = shaders.program(DRAW)
        self._meshes: dict[tuple[int, int], _Mesh] = {}

    def draw(self, occluders: Iterable[OccluderData], to_map: NDArray[np.float64]) -> int:
        """Draw occluders that have meshes with the map's matrix (4, 4); returns how many are in it.

        `to_map` takes world points to the map's clip space. What lies outside is left out, and what
        shares a mesh is drawn at once.
        """
        groups: dict[tuple[int, int], list[NDArray]] = {}
        for occluder in occluders:
            key = (id(occluder.vertices), id(occluder.indices))
            group = groups.get(key)
            if group is None:
                group = groups[key] = []
                if key not in self._meshes:
                    self._meshes[key] = _Mesh(self._ctx, self._program, occluder)
            group.append(occluder.transform)
        drawn = 0
        for key, transforms in groups.items():
            mesh = self._meshes[key]
            matrices = to_map @ np.array(transforms, np.float64)
            level = matrices[:, :2]
            at = np.abs(level[:, :, :3] @ mesh.center + level[:, :, 3])
            # How far the sphere about a mesh reaches in the map, which is sheared.
            reach = mesh.radius * np.sqrt(np.square(level[:, :, :3]).sum(axis=2))
            within = (at <= 1.0 + reach).all(axis=1)
            count = int(np.count_nonzero(within))
            if count:
                mesh.draw(matrices if count == len(matrices) else matrices[within])
                drawn += count
        return drawn

    def keep(self, occluders: Iterable[OccluderData]) -> None:
        """Give back the meshes that none of `occluders` uses."""
        wanted = {(id(o.vertices), id(o.indices)) for o in occluders if o.vertices is not None}
        for key in [k for k in self._meshes if k not in wanted]:
            self._meshes.pop(key).release()

    def __len__(self) -> int:
        return len(self._meshes)

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for mesh in self._meshes.values():
            mesh.release()
        self._meshes.clear()
