"""Meshes of occluders on the GPU, one per pair of arrays however many occluders share it."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import OccluderData
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader

DRAW = ProgramKey(vertex="occluder.vert", fragment="occluder.frag")


class _Mesh:
    def __init__(
        self, ctx: moderngl.Context, program: moderngl.Program, occluder: OccluderData
    ) -> None:
        # Holding the arrays keeps their identities, by which meshes are found, from being reused.
        self.arrays = (occluder.vertices, occluder.indices)
        self.vertices = ctx.buffer(np.ascontiguousarray(occluder.vertices, np.float32))
        self.indices = ctx.buffer(np.ascontiguousarray(occluder.indices, np.uint32))
        self.array = ctx.vertex_array(
            program, [(self.vertices, "3f", "in_vertex")], index_buffer=self.indices
        )
        self.used = True

    def release(self) -> None:
        for thing in (self.array, self.indices, self.vertices):
            thing.release()


class OccluderMeshes:
    """Uploads meshes at their first use and gives back those of occluders that are gone."""

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader) -> None:
        self._ctx = ctx
        self._program = shaders.program(DRAW)
        self._meshes: dict[tuple[int, int], _Mesh] = {}

    def draw(self, occluder: OccluderData, to_map: NDArray[np.float64]) -> None:
        """Draws one occluder with the map's matrix into the bound target."""
        key = (id(occluder.vertices), id(occluder.indices))
        mesh = self._meshes.get(key)
        if mesh is None:
            mesh = self._meshes[key] = _Mesh(self._ctx, self._program, occluder)
        self._program["to_map"].write(np.asfortranarray(to_map @ occluder.transform, np.float32).T)
        mesh.array.render(moderngl.TRIANGLES)

    def keep(self, occluders: tuple[OccluderData, ...]) -> None:
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
