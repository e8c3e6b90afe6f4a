"""The water beyond the wetness map, and where the map begins: the weather's own coarse field."""

from __future__ import annotations

import math

import moderngl
import numpy as np

from weather_ecs.frame import ViewData
from weather_ecs.physics.front import on_level_ground
from weather_ecs.physics.wet_field import open_water

TEXELS, TEXEL = 64, 8.0  # a side; m
HALF = 0.5 * TEXELS * TEXEL  # m
WATCHED = 1.5 * HALF  # m, within which rain and wet ground matter to it


class FarField:
    """mm on level ground in the open around one observer, a texture made anew once a second."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.texture = ctx.texture((TEXELS, TEXELS), 1, bytes(4 * TEXELS * TEXELS), dtype="f4")
        self.texture.filter = moderngl.LINEAR, moderngl.LINEAR
        self.texture.repeat_x = self.texture.repeat_y = False
        self.middle = (0.0, 0.0)  # m, (x, z)
        self.dry = True
        self._made: tuple[int, int] | None = None  # ground, tick

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
        points = np.stack(grid, axis=-1).reshape(-1, 2)
        levels = [
            (tiles.cell, tiles.places, tiles.water, float(wet.ticks - tiles.since), tiles.rows)
            for tiles in wet.levels
        ]
        rest = max(view.frame.time - wet.ticks, 0.0)
        areas = on_level_ground(view.frame.areas, view.frame.fronts)
        water = open_water(points, levels, rest, areas)
        self.texture.write(water.astype(np.float32).tobytes())
        self._made = (wet.number, wet.ticks)
        self.dry = not water.any()

    def release(self) -> None:
        """Give the texture back; twice does no harm."""
        self.texture.release()


def rains_within(view: ViewData, reach: float) -> bool:
    """Whether an area may rain on what lies within `reach` m."""
    x, _, z = view.position
    for _, (cx, cz), (a, _), _, rate, *_ in view.frame.areas.tolist():
        if rate > 0.0 and math.hypot(cx - x, cz - z) < a + reach:
            return True
    return False


def wet_within(view: ViewData, reach: float) -> bool:
    """Whether the ground is wet within `reach` m, in the weather's own coarse field."""
    wet = view.frame.wetness
    here = np.array((view.position[0], view.position[2]))
    for tiles in wet.levels if wet is not None else ():
        side = 8.0 * tiles.cell
        away = np.abs((tiles.places + 0.5) * side - here).max(axis=1)
        if (away < reach + 0.5 * side).any():
            return True
    return False
