"""Water and snow beyond the wetness map, and where the map begins: the weather's coarse field."""

from __future__ import annotations

import math
from collections.abc import Callable

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import ViewData, WetnessData, plain_areas
from weather_ecs.physics.front import on_level_ground
from weather_ecs.physics.ground_law import WATER, GroundLaw, SnowLaw
from weather_ecs.physics.snow_cover import melt_rate
from weather_ecs.physics.wet_field import open_water

TEXELS, TEXEL = 64, 8.0  # a side; m
HALF = 0.5 * TEXELS * TEXEL  # m
WATCHED = 1.5 * HALF  # m, within which rain and wet ground matter to it


class FarField:
    """mm of water and of snow on level ground in the open around one observer.

    A texture of two components, made anew once a second.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self.texture = ctx.texture((TEXELS, TEXELS), 2, bytes(8 * TEXELS * TEXELS), dtype="f4")
        self.texture.filter = moderngl.LINEAR, moderngl.LINEAR
        self.texture.repeat_x = self.texture.repeat_y = False
        self.middle = (0.0, 0.0)  # m, (x, z)
        self.dry = True
        self._made: tuple[int, int] | None = None  # ground, tick
        self._points: NDArray[np.float64] = np.zeros((0, 2))  # m, (x, z) of the texels

    def is_due(self, view: ViewData) -> bool:
        """Whether there is something to enter, or the last of it to take away."""
        wet = view.frame.wetness
        if wet is None or self._made == (wet.number, wet.ticks):
            return False
        return not self.dry or rains_within(view, WATCHED) or wet_within(view, WATCHED)

    def update(self, view: ViewData) -> None:
        """Enter the frame's field, where it is another one or the observer is elsewhere."""
        wet = view.frame.wetness
        if wet is None:
            return
        x, _, z = view.position
        away = max(abs(x - self.middle[0]), abs(z - self.middle[1]))
        if self._made == (wet.number, wet.ticks) and away < 0.25 * HALF:
            return
        if self._made is None or away >= 0.25 * HALF:
            self.middle = round(x / TEXEL) * TEXEL, round(z / TEXEL) * TEXEL
            across = (np.arange(TEXELS) + 0.5) * TEXEL - HALF
            grid = np.meshgrid(self.middle[0] + across, self.middle[1] + across)
            self._points = np.stack(grid, axis=-1).reshape(-1, 2)
        points, air = self._points, view.frame.air
        water = _field(view, wet, points, 1.0 - air.snow_share, _water_law)
        snow = np.zeros_like(water)
        lying, collects = view.frame.snow_ground, air.snow_share * view.frame.flakes.settling
        if lying is not None and (lying.levels or collects > 0.0):
            snow = _field(view, lying, points, collects, SnowLaw)
        both = np.stack([water, snow], axis=-1)
        self.texture.write(both.astype(np.float32).tobytes())
        self._made = (wet.number, wet.ticks)
        self.dry = not both.any()

    def release(self) -> None:
        """Give the texture back; twice does no harm."""
        self.texture.release()


def _water_law(melt: float) -> GroundLaw:
    return WATER


def _field(
    view: ViewData,
    ground: WetnessData,
    points: NDArray,
    share: float,
    law: Callable[[float], GroundLaw],
) -> NDArray:
    """mm at points (n, 2), now; `share` of what falls is of this kind, or counts so often."""
    frame = view.frame
    levels = [
        (t.cell, t.places, t.water, float(ground.ticks - t.since), t.rows, law(t.melt))
        for t in ground.levels
    ]
    areas = on_level_ground(frame.areas, frame.fronts)
    if share != 1.0:
        areas = areas.copy()
        areas["rain_rate"] *= share
    melt = law(float(melt_rate(frame.air.wet_bulb)))
    return open_water(points, levels, max(frame.time - ground.ticks, 0.0), areas, melt)


def rains_within(view: ViewData, reach: float) -> bool:
    """Whether an area may rain on what lies within `reach` m."""
    x, _, z = view.position
    for _, (cx, cz), (a, _), _, rate, _, _ in plain_areas(view.frame.areas):
        if rate > 0.0 and math.hypot(cx - x, cz - z) < a + reach:
            return True
    return False


def wet_within(view: ViewData, reach: float) -> bool:
    """Whether water or snow lies within `reach` m, in the weather's own coarse field."""
    here = np.array((view.position[0], view.position[2]))
    grounds = (view.frame.wetness, view.frame.snow_ground)
    for tiles in [t for ground in grounds if ground is not None for t in ground.levels]:
        side = 8.0 * tiles.cell
        away = np.abs((tiles.places + 0.5) * side - here).max(axis=1)
        if (away < reach + 0.5 * side).any():
            return True
    return False
