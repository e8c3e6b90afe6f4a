"""After Tariq, "Rain", NVIDIA Direct3D SDK 10 white paper (2007).

The drops are animated by stream-out, expanded to sprites in a geometry shader, and each pixel looks
its opacity up in a library of streak appearances by the angles of view and light, blended between
the four nearest. The white paper takes the library from Garg and Nayar (2006), which is
photographic and not ours to give: a small procedural one of the same structure (5 elevations by
9 azimuths of the light, in steps of 20 degrees) stands in for it.
"""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from benchmarks.models.box import BoxRain
from benchmarks.models.glsl import put
from benchmarks.models.stage import Stage

ELEVATIONS, AZIMUTHS, KINDS = 5, 9, 2  # also in tariq.geom
WIDTH, HEIGHT = 8, 32  # texels of an appearance
SUN_DIRECTION = (0.35, 0.8, 0.48)
SUN_COLOR = (0.80, 0.84, 0.88)  # encoded


def library() -> NDArray[np.uint8]:
    """(elevations * azimuths * kinds, HEIGHT, WIDTH): opacity of a streak, by light and kind.

    The body of the streak, a highlight that wanders across it with the azimuth of the light, and
    the speckles of an oscillating drop, which a low light brings out.
    """
    x = (np.arange(WIDTH) + 0.5) / WIDTH * 2.0 - 1.0
    y = (np.arange(HEIGHT) + 0.5) / HEIGHT
    ends = np.minimum(np.minimum(y, 1.0 - y) * 6.0, 1.0)[:, None]
    layers = []
    for elevation in range(ELEVATIONS):
        for azimuth in range(AZIMUTHS):
            for kind in range(KINDS):
                body = 0.75 * np.sqrt(1.0 - x**2)[None, :]
                middle = 0.7 * np.sin(np.radians(10.0 + 20.0 * azimuth))
                shine = 0.3 * np.exp(-(((x - middle) / 0.35) ** 2))[None, :]
                wave = np.cos(2.0 * np.pi * (y * (2.0 + kind) + 0.1 * azimuth))[:, None]
                depth = 0.25 * (1.0 - elevation / (ELEVATIONS - 1.0))
                layers.append((body + shine) * ends * (1.0 - depth * (0.5 + 0.5 * wave)))
    return np.round(np.clip(np.array(layers), 0.0, 1.0) * 255.0).astype(np.uint8)


class TariqRain(BoxRain):
    """195 000 drops in the paper's comparison. Sprites out of view end in the geometry shader.

    With a lamp, its light is added as in the white paper; the comparison has none, as the paper's
    frame rates were taken without ("sin incluir ... interacciones con luces").
    """

    name = "tariq"
    kinds = KINDS

    def __init__(
        self,
        stage: Stage,
        drops: int,
        rain_rate: float,
        seed: int = 0,
        lamp: tuple[float, float, float] | None = None,
    ) -> None:
        super().__init__(
            stage,
            drops,
            rain_rate,
            geometry="tariq.geom",
            fragment="tariq.frag",
            defines=("LAMP",) if lamp is not None else (),
            seed=seed,
        )
        layers = library()
        self._library = stage.ctx.texture_array(
            (WIDTH, HEIGHT, len(layers)), 1, layers.tobytes(), alignment=1
        )
        self._library.build_mipmaps()
        self._library.filter = moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR
        self._library.repeat_x = self._library.repeat_y = False
        sun = np.array(SUN_DIRECTION) / np.linalg.norm(SUN_DIRECTION)
        put(self._program, library=0, sun_direction=tuple(sun))
        put(self._program, sun_color=SUN_COLOR)
        if lamp is not None:
            put(self._program, lamp_position=lamp, lamp_color=(1.0, 0.85, 0.6, 2.0))

    def _bind(self) -> None:
        self._library.use(0)

    def release(self) -> None:
        self._library.release()
        super().release()
