"""`Sample`: the weather at one place, for the game's own rules; plain numbers, no OpenGL.

The formulas are those of `physics.ellipse.edge_factor`, `physics.drops.extinction` and
`physics.optics`, written for one point at a time: a game asks for thousands of points a frame.
"""

from __future__ import annotations

import math
from typing import NamedTuple

from weather_ecs.frame import FrameData
from weather_ecs.physics.drops import extinction
from weather_ecs.physics.optics import CONTRAST

CLEAR_VISIBILITY = 50_000.0  # m, in clean air
TEMPERATURE = 15.0  # degrees Celsius, the standard atmosphere at sea level

_CLEAR = CONTRAST / CLEAR_VISIBILITY  # 1/m
_RAIN = float(extinction(1.0))  # 1/m at 1 mm/h
_RAIN_POWER = 0.63  # three times the 0.21 of Marshall and Palmer's slope
_RED, _GREEN, _BLUE = 0.2126, 0.7152, 0.0722  # luminance of linear RGB (Rec. 709)


class Sample(NamedTuple):
    """The weather at a point."""

    rain_rate: float  # mm/h
    snow_rate: float  # mm/h of water
    sheltered: bool  # something overhead keeps the rain off
    wind: tuple[float, float, float]  # m/s, world axes
    visibility: float  # m
    wetness: float  # mm of water on the ground
    snow_depth: float  # m
    temperature: float  # degrees Celsius
    light: float  # luminance of the light on a level surface; about 1 on a bright day


class SampleField:
    """One `FrameData`, prepared to answer for any point."""

    __slots__ = ("_areas", "_day_light", "_lights", "_wind")

    def __init__(self, frame: FrameData) -> None:
        self._areas = [
            (*center, math.cos(heading), math.sin(heading), *radii, rate, min(edge, radii[1]), top)
            for _, center, radii, heading, rate, edge, top in frame.areas.tolist()
            if rate > 0.0
        ]
        self._lights = [
            (*position, reach, luminance(color)) for position, color, reach in frame.lights.tolist()
        ]
        sky = frame.sky
        self._day_light = luminance(sky.sun_color) * max(sky.sun_direction[1], 0.0) + 0.5 * (
            luminance(sky.zenith_color) + luminance(sky.horizon_color)
        )
        self._wind = frame.wind

    def rain_rate(self, x: float, y: float, z: float) -> float:
        """mm/h at a point in the open: the areas' rates, each falling off over its soft edge."""
        total = 0.0
        hypot = math.hypot
        for cx, cz, cos, sin, a, b, rate, edge, top in self._areas:
            if y >= top:
                continue
            dx, dz = x - cx, z - cz
            u = (dx * cos - dz * sin) / a
            w = (dx * sin + dz * cos) / b
            rho = hypot(u, w)
            if rho >= 1.0:
                continue
            if edge > 0.0:
                slope = hypot(u / a, w / b)
                share = (1.0 - rho) * (rho / slope if slope > 0.0 else b) / edge
                if share < 1.0:
                    rate *= share * share * (3.0 - 2.0 * share)
            total += rate
        return total

    def light(self, x: float, y: float, z: float) -> float:
        """Luminance of day light and lamps; a lamp's falls as (1 - (d / reach)^2)^2."""
        total = self._day_light
        for lx, ly, lz, reach, strength in self._lights:
            dx, dy, dz = x - lx, y - ly, z - lz
            left = 1.0 - (dx * dx + dy * dy + dz * dz) / (reach * reach)
            if left > 0.0:
                total += strength * left * left
        return total

    def at(self, x: float, y: float, z: float) -> Sample:
        """Everything at a point."""
        rate = self.rain_rate(x, y, z)
        lost = _CLEAR + _RAIN * rate**_RAIN_POWER
        return Sample(
            rate,
            0.0,
            False,
            self._wind,
            CONTRAST / lost,
            0.0,
            0.0,
            TEMPERATURE,
            self.light(x, y, z),
        )

    def mode(self, x: float, z: float) -> str:
        """ "near" inside an area (f < 1), "far" where there is one elsewhere, else "none"."""
        if not self._areas:
            return "none"
        for cx, cz, cos, sin, a, b, *_ in self._areas:
            dx, dz = x - cx, z - cz
            if math.hypot((dx * cos - dz * sin) / a, (dx * sin + dz * cos) / b) < 1.0:
                return "near"
        return "far"


def luminance(color: tuple[float, float, float]) -> float:
    """Brightness of a linear RGB colour."""
    return _RED * color[0] + _GREEN * color[1] + _BLUE * color[2]
