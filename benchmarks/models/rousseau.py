"""After Rousseau, Jolivet and Ghazanfarpour, "Realistic real-time rain rendering" (2006).

Every pixel of a drop shows what the drop refracts: a mask, made once from the optics of a sphere of
water, says where in a wide-angle capture of the scene it looks. A streak's pixel is the mean over
a few points of the drop, which passes over it while the eye retains it.
"""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from benchmarks.models.box import BoxRain
from benchmarks.models.glsl import put
from benchmarks.models.stage import Stage

WATER = 1.33  # refractive index
FIELD = 82.5  # degrees to either side that a drop shows
MASK, CAPTURE = 64, 256  # texels on a side


def refraction_mask(n: int = MASK) -> NDArray[np.uint8]:
    """(n, n, 4): where the point of a drop looks in the capture, 0.5 for straight on; opacity.

    A ray that meets a sphere at the share b of its radius is turned by 2 (asin b - asin(b / WATER))
    towards the axis, and so shows the scene upside down, more so towards the rim.
    """
    axis = (np.arange(n) + 0.5) / n * 2.0 - 1.0
    x, y = np.meshgrid(axis, axis)
    b = np.minimum(np.hypot(x, y), 1.0)
    turned = np.degrees(2.0 * (np.arcsin(b) - np.arcsin(b / WATER)))
    scale = -turned / FIELD / np.maximum(b, 1e-6)
    mask = np.empty((n, n, 4))
    mask[..., 0] = 0.5 + 0.5 * x * scale
    mask[..., 1] = 0.5 + 0.5 * y * scale
    mask[..., 2] = 0.0
    mask[..., 3] = np.clip((1.0 - np.hypot(x, y)) * 8.0, 0.0, 1.0)
    return np.round(np.clip(mask, 0.0, 1.0) * 255.0).astype(np.uint8)


def capture(n: int = CAPTURE) -> NDArray[np.uint8]:
    """(n, n, 4): stands for the wide-angle capture of a scene; overcast sky over dull ground.

    The paper renders it once a frame. Here nothing in it moves, so that it is made once and costs
    the model nothing.
    """
    rise = np.linspace(-1.0, 1.0, n)[:, None]
    side = np.linspace(-1.0, 1.0, n)[None, :]
    zenith, horizon, ground = (0.64, 0.71, 0.80), (0.84, 0.87, 0.89), (0.48, 0.48, 0.45)
    picture = np.full((n, n, 4), 255.0)
    for channel in range(3):
        sky = horizon[channel] + (zenith[channel] - horizon[channel]) * np.maximum(rise, 0.0)
        below = ground[channel] * (0.9 + 0.1 * np.cos(9.0 * side + 3.0 * rise))
        picture[..., channel] = 255.0 * np.where(rise > 0.0, sky, below)
    return np.round(picture).astype(np.uint8)


class RousseauRain(BoxRain):
    """90 000 drops in the paper's comparison. Quads out of view end in the geometry shader."""

    name = "rousseau"

    def __init__(self, stage: Stage, drops: int, rain_rate: float, seed: int = 0) -> None:
        super().__init__(
            stage, drops, rain_rate, geometry="rousseau.geom", fragment="rousseau.frag", seed=seed
        )
        ctx = stage.ctx
        self._mask = ctx.texture((MASK, MASK), 4, refraction_mask().tobytes())
        self._scene = ctx.texture((CAPTURE, CAPTURE), 4, capture().tobytes())
        for texture in (self._mask, self._scene):
            texture.filter = moderngl.LINEAR, moderngl.LINEAR
            texture.repeat_x = texture.repeat_y = False
        put(self._program, mask=0, scene=1)

    def _bind(self) -> None:
        self._mask.use(0)
        self._scene.use(1)

    def release(self) -> None:
        self._mask.release()
        self._scene.release()
        super().release()
