"""How high in the picture rain hides clouds and sky: what is below needs no drawing.

Veils are drawn over them. Where there is so much rain before the lowest clouds that no pixel could
tell them from what is behind, they only cost.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

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


def hidden_below(view: ViewData, scene: CloudScene) -> tuple[float, float]:
    """Heights in the picture, -1 to 1, below which rain hides all clouds, and the sky as well.

    -1: nowhere.
    """
    seen = scene.order
    none = scene.parallel or not len(seen)
    lowest = -math.inf if none else float(scene.lowest[seen].min())
    clouds, sky = opaque_below(view, lowest, math.inf)
    return clouds, sky


def opaque_below(view: ViewData, *heights: float) -> list[float]:
    """Heights in the picture, -1 to 1, below which rain hides what is so many m over the camera."""
    over = [veil for veil in view.veils if veil.span[1] >= view.position[1]]
    thick = important(view, [veil for veil in over if veil.dry == SETTLED])[:MOST]
    if max(heights) <= 1.0 or sum(each.optical for each in thick) < OPAQUE:
        return [-1.0] * len(heights)
    middle, right, up = rays(view)
    lines = np.linspace(-1.0, 1.0, LINES)
    across = np.linspace(-1.0, 1.0, COLUMNS)
    ray = middle + lines[:, None, None] * up + across[:, None] * right
    # Nothing of the scene that is seen behind a cloud is nearer than the cloud's base.
    over_camera = np.array(heights)[:, None, None]
    end = np.minimum(over_camera / np.maximum(ray[..., 1], 1e-6), BEYOND)
    depth = np.zeros(end.shape)
    for veil in (each.veil for each in thick):
        place = view.position, ray, end, veil.axis, veil.shape, veil.span[1], veil.shown
        share = curtain_share(*place, veil.top, veil.ragged, veil.phase, veil.drift)
        depth += veil.extinction * rain_path(*place) * share
    hidden = (depth > OPAQUE).all(axis=2) & (over_camera[:, 0] > 1.0)
    return [_highest(lines, each) for each in hidden]


def _highest(lines: NDArray, hidden: NDArray[np.bool_]) -> float:
    """Of the lines from the lowest on, all of which are hidden."""
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
        self._sky: tuple[ViewData, float] | None = None

    def find(self, view: ViewData, scene: CloudScene) -> None:
        """The part in which a view's clouds may be seen."""
        self.low, sky = hidden_below(view, scene)
        self._sky = view, sky

    def sky_low(self, view: ViewData) -> float:
        """Height below which rain hides the sky: as found with the clouds, or found now."""
        if self._sky is not None and self._sky[0] is view:
            return self._sky[1]
        return opaque_below(view, math.inf)[0]

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
