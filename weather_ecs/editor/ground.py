"""`Ground`: land in haze below a view, so that up and down and far can be told."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs import Weather
from weather_ecs.editor.marks import program

SECTORS, RINGS = 48, 40  # as in shaders/ground.vert
GRID = 0.20  # strength of the lines


class Ground:
    """The plane at height 0 of a weather's world."""

    def __init__(self, gl: moderngl.Context) -> None:
        self._gl = gl
        self._program = program(gl, "ground")
        self._array = gl.vertex_array(self._program, [])
        tile = fields()
        self._tile = gl.texture(tile.shape[1::-1], 2, tile.tobytes())
        self._tile.build_mipmaps()

    def draw(self, weather: Weather, matrix: NDArray, eye: NDArray, *, grid: bool) -> None:
        """Into what is bound, with depth; matrix: projection @ view for column vectors."""
        if eye[1] <= 1.0:
            return
        gl = self._gl
        gl.enable_only(moderngl.DEPTH_TEST)
        gl.depth_func = "<="
        weather.sky().use(self._program)
        self._tile.use(0)
        self._program["ground_tile"] = 0
        self._program["ground_matrix"].write(np.ascontiguousarray(matrix.T, np.float32).tobytes())
        self._program["ground_eye"] = tuple(eye.tolist())
        self._program["ground_grid"] = GRID if grid else 0.0
        vertices = 2 * (SECTORS + 1)
        self._array.render(moderngl.TRIANGLE_STRIP, vertices, instances=RINGS)

    def release(self) -> None:
        """Give everything back."""
        self._tile.release()
        self._array.release()
        self._program.release()


def fields() -> NDArray[np.uint8]:
    """(256, 256, 2): smooth noise that repeats, broad and fine, always the same."""
    rng = np.random.default_rng(22)
    fx, fy = np.meshgrid(np.fft.rfftfreq(256), np.fft.fftfreq(256))
    away = np.hypot(fx, fy) * 256.0
    layers = []
    for scale in (9.0, 30.0):
        spectrum = np.fft.rfft2(rng.standard_normal((256, 256))) * np.exp(-((away / scale) ** 2))
        spectrum[0, 0] = 0.0
        noise = np.fft.irfft2(spectrum, s=(256, 256))
        layers.append(np.clip(0.5 + 0.22 * noise / noise.std(), 0.0, 1.0))
    return np.rint(np.stack(layers, axis=-1) * 255.0).astype(np.uint8)
