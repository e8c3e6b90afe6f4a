"""`Ground`: land in haze below a view, so that up and down and far can be told."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs import Weather
from weather_ecs.editor.marks import program

FAR = 150_000.0  # m, half of the side of what is drawn
GRID = 0.35  # strength of the lines


class Ground:
    """The plane at height 0 of a weather's world."""

    def __init__(self, gl: moderngl.Context) -> None:
        self._gl = gl
        self._program = program(gl, "ground")
        self._array = gl.vertex_array(self._program, [])

    def draw(self, weather: Weather, matrix: NDArray, eye: NDArray, *, grid: bool) -> None:
        """Into what is bound, with depth; matrix: projection @ view for column vectors."""
        if eye[1] <= 1.0:
            return
        gl = self._gl
        gl.enable_only(moderngl.DEPTH_TEST)
        gl.depth_func = "<="
        weather.sky().use(self._program)
        self._program["ground_matrix"].write(np.ascontiguousarray(matrix.T, np.float32).tobytes())
        self._program["ground_eye"] = (*eye.tolist(), FAR)
        self._program["ground_grid"] = GRID if grid else 0.0
        self._array.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def release(self) -> None:
        """Give everything back."""
        self._array.release()
        self._program.release()
