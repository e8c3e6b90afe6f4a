"""How high in the picture rain hides clouds and sky: what is below needs no drawing.

Veils are drawn over them. Where there is so much rain before the lowest clouds that no pixel could
tell them from what is behind, they only cost.
"""

from __future__ import annotations

import math

import numpy as np

from weather_ecs.frame import ViewData
from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.cloud_scene import CloudScene
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.veil_list import important, rays
from weather_ecs.physics.front import SETTLED
from weather_ecs.physics.veil import BEYOND, curtain_share, rain_path

LINES, COLUMNS = 33, 5  # of the picture, that are looked along
OPAQUE = math.log(2.0 * 255.0)  # optical depth behind which white and black are the same
MOST = 4  # veils that are looked at


def hidden_below(view: ViewData, scene: CloudScene) -> float:
    """Height in the picture, -1 to 1, below which rain hides all clouds; -1: nowhere."""
    seen = scene.order
    if scene.parallel or not len(seen):
        return -1.0
    return opaque_below(view, float(scene.lowest[seen].min()))


def opaque_below(view: ViewData, height: float = math.inf) -> float:
    """Height in the picture, -1 to 1, below which rain hides what is so many m over the camera."""
    over = [veil for veil in view.veils if veil.span[1] >= view.position[1]]
    thick = important(view, [veil for veil in over if veil.dry == SETTLED])[:MOST]
    if height <= 1.0 or sum(each.optical for each in thick) < OPAQUE:
        return -1.0
    middle, right, up = rays(view)
    lines = np.linspace(-1.0, 1.0, LINES)
    across = np.linspace(-1.0, 1.0, COLUMNS)
    ray = middle + lines[:, None, None] * up + across[:, None] * right
    # Nothing of the scene that is seen behind a cloud is nearer than the cloud's base.
    end = np.minimum(height / np.maximum(ray[..., 1], 1e-6), BEYOND)
    depth = np.zeros(ray.shape[:2])
    for veil in (each.veil for each in thick):
        place = view.position, ray, end, veil.axis, veil.shape, veil.span[1], veil.shown
        share = curtain_share(*place, veil.top, veil.ragged, veil.phase, veil.drift)
        depth += veil.extinction * rain_path(*place) * share
    hidden = (depth > OPAQUE).all(axis=1)
    if hidden.all():
        return 1.0
    first = int(np.argmin(hidden))
    return float(lines[first - 1]) if first > 0 else -1.0


class Window:
    """The part of the picture above a height, -1 to 1; while it is on, all that is drawn."""

    def __init__(
        self, gl: GL, low: float = -1.0, viewport: tuple[int, int, int, int] = (0, 0, 0, 0)
    ) -> None:
        self._gl = gl
        self.low = low
        self.viewport = viewport

    def on(self) -> None:
        """From now on."""
        if self.low > -1.0:
            x, y, width, height = self.viewport
            self._gl.glScissor(x, y + below(self.low, height), width, height)
            self._gl.glEnable(e.SCISSOR_TEST)

    def off(self) -> None:
        """No more."""
        if self.low > -1.0:
            self._gl.glDisable(e.SCISSOR_TEST)


def below(low: float, height: int) -> int:
    """Rows of a picture so many pixels high that are all below a height, -1 to 1."""
    return math.floor((0.5 * low + 0.5) * height)
