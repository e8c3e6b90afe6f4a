"""A look inside: the seeds' boxes, and the rays along which their light is absorbed."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.gpu.cloud_scene import CloudScene
from weather_ecs.gpu.cloud_store import CloudStore
from weather_ecs.gpu.row_texture import RowTexture
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader

LINES = ProgramKey(vertex="cloud_rays.vert", fragment="cloud_rays.frag")
VERTICES = 26  # twelve edges of a box and a ray


class CloudRays:
    """Lines over the clouds that are drawn with billboards."""

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader, units: dict[str, int]) -> None:
        self._program = shaders.program(LINES)
        for name, unit in units.items():
            if name in self._program:
                self._program[name] = unit
        self._array = ctx.vertex_array(self._program, [])

    def draw(
        self,
        scene: CloudScene,
        store: CloudStore | None,
        which: NDArray[np.intp],
        matrix: bytes,
        rows: RowTexture,
    ) -> None:
        """The clouds `which`, the k-th in row k; their rows and seeds are bound."""
        if store is None:
            return
        program = self._program
        program["cloud_matrix"].write(matrix)
        for row, index in enumerate(which.tolist()):
            shape = store.shapes[int(scene.shapes[index])]
            program["ray_cloud"] = (row, shape.seeds)
            program["ray_light"] = (*shape.data.light, 2.0 * shape.data.radius)
            self._array.render(moderngl.LINES, vertices=VERTICES, instances=len(shape.data.centers))

    def release(self) -> None:
        self._array.release()
