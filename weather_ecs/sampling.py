"""`Sample`: the weather at one place, for the game's own rules; plain numbers, no OpenGL.

The formulas are those of `physics.optics` and `physics.phase`, written for one point at a time, and
in arrays for many at once: a game asks for thousands of points a frame.
"""

from __future__ import annotations

from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from weather_ecs.components._base import FAR
from weather_ecs.errors import InvalidValueError
from weather_ecs.frame import FrameData
from weather_ecs.physics.lamps import Lamps
from weather_ecs.physics.lightning import on_level, on_surface
from weather_ecs.physics.optics import CONTRAST, falling_extinction, falling_extinctions
from weather_ecs.physics.phase import (
    share_at,
    shares_at,
    temperature_at,
    temperatures_at,
    warmest_snow,
)
from weather_ecs.physics.rain_field import RainField
from weather_ecs.physics.snow_cover import DENSITY, SOAKED
from weather_ecs.physics.wetness import FILM
from weather_ecs.physics.wind import wind_at, winds_at

Floats = NDArray[np.float64]
_FEW = 100  # points that are quicker asked about one by one
_RED, _GREEN, _BLUE = 0.2126, 0.7152, 0.0722  # luminance of linear RGB (Rec. 709)


class Sample(NamedTuple):
    """The weather at a point."""

    rain_rate: float  # mm/h
    snow_rate: float  # mm/h of water
    sheltered: bool  # something overhead keeps the rain off
    wind: tuple[float, float, float]  # m/s, world axes; gusts are in it, turbulence is not
    visibility: float  # m, through fog, rain and snow as they are there
    wetness: float  # mm of water on level ground there; under shelter 0
    snow_depth: float  # m
    temperature: float  # degrees Celsius; 6.5 less for a kilometre up
    light: float  # luminance of the light on a level surface; about 1 on a bright day
    humidity: float  # 0 to 1, relative


class Samples(NamedTuple):
    """The weather at n points: every field of `Sample` as an array, its units the same."""

    rain_rate: Floats  # (n,)
    snow_rate: Floats  # (n,)
    sheltered: NDArray[np.bool_]  # (n,)
    wind: Floats  # (n, 3)
    visibility: Floats  # (n,)
    wetness: Floats  # (n,)
    snow_depth: Floats  # (n,)
    temperature: Floats  # (n,)
    light: Floats  # (n,)
    humidity: Floats  # (n,)


class Shelter(Protocol):
    """What knows whether something keeps the rain off a point, or off each of many."""

    def covers(self, x: float, y: float, z: float) -> bool: ...

    def many(self, x: Floats, y: Floats, z: Floats) -> NDArray[np.bool_]: ...


class Ground(Protocol):
    """What knows the water in mm on a place where it rains at `rate` mm/h at a time in s."""

    def at(self, x: float, y: float, z: float, rate: float, time: float) -> float: ...

    def many(self, x: Floats, y: Floats, z: Floats, rate: Floats, time: float) -> Floats: ...


class SampleField:
    """One `FrameData`, prepared to answer for any point."""

    __slots__ = (
        "_air",
        "_day_light",
        "_flashes",
        "_fog",
        "_ground",
        "_melts",
        "_profile",
        "_rain",
        "_rain_from",
        "_settling",
        "_shelter",
        "_snow",
        "_time",
        "_wind",
        "lamps",
        "lights",
    )

    def __init__(
        self,
        frame: FrameData,
        shelter: Shelter | None = None,
        ground: Ground | None = None,
        snow: Ground | None = None,
        before: SampleField | None = None,
    ) -> None:
        """`before`: the last one, whose lamps may serve again."""
        self._rain = RainField(frame.areas, frame.fronts)
        self._air, self._fog = frame.air, frame.fog.extinction
        self._rain_from = warmest_snow(frame.air.humidity)
        self._shelter, self._ground, self._time = shelter, ground, frame.time
        self._snow, self._melts = snow, frame.air.wet_bulb > 0.0
        self._settling = frame.flakes.settling
        self.lights = frame.lights.tobytes()
        same = before is not None and before.lights == self.lights
        self.lamps: Lamps = before.lamps if before and same else _lamps(frame.lights)
        shine = luminance(frame.lightning.color)
        self._flashes = [
            (tuple(row["place"].tolist()), shine * float(row["light"])) for row in frame.strikes
        ]
        sky = frame.sky
        self._day_light = luminance(sky.sun_color) * max(sky.sun_direction[1], 0.0) + 0.5 * (
            luminance(sky.zenith_color) + luminance(sky.horizon_color)
        )
        self._wind, self._profile = frame.wind, frame.profile

    def rain_rate(self, x: float, y: float, z: float) -> float:
        """mm/h at a point in the open: the areas' rates, each falling off over its soft edge."""
        return self._rain.rate(x, y, z)

    def rain_rates(self, x: float, y: float, z: float) -> dict[int, float]:
        """The same by area."""
        return self._rain.rates(x, y, z)

    def sheltered(self, x: float, y: float, z: float) -> bool:
        """Whether something overhead keeps the rain off a point."""
        return self._shelter is not None and self._shelter.covers(x, y, z)

    def light(self, x: float, y: float, z: float) -> float:
        """Luminance of day light, lightning and lamps; a lamp's falls as (1 - (d / reach)^2)^2."""
        total = self._day_light + self.lamps.at(x, y, z)
        for place, strength in self._flashes:
            total += strength * on_surface(place, (x, y, z), (0.0, 1.0, 0.0))
        return total

    def at(self, x: float, y: float, z: float) -> Sample:
        """Everything at a point."""
        rate = self._rain.rate(x, y, z)
        air = self._air
        temperature = temperature_at(air.temperature, y)
        rain, snow, lost = 0.0, 0.0, self._fog
        if rate > 0.0:
            if temperature < self._rain_from:
                snow = rate * share_at(temperature, air.humidity)
            rain = rate - snow
            lost += falling_extinction(rain, snow)
        sheltered = self._shelter is not None and self._shelter.covers(x, y, z)
        wetness, lying = 0.0, 0.0
        if self._ground is not None and self._snow is not None and not sheltered:
            falls = rate * air.snow_share
            wetness = self._ground.at(x, y, z, rate - falls, self._time)
            lying = self._snow.at(x, y, z, falls * self._settling, self._time)
            if lying > 0.0 and self._melts:
                wetness = max(wetness, min(lying / SOAKED * FILM, FILM))
        made = (
            0.0 if sheltered else rain,
            0.0 if sheltered else snow,
            sheltered,
            wind_at(self._wind, self._profile, y),
            CONTRAST / lost,
            wetness,
            lying / DENSITY,
            temperature,
            self.light(x, y, z) if self._flashes else self._day_light + self.lamps.at(x, y, z),
            air.humidity,
        )
        return tuple.__new__(Sample, made)  # at half the cost of its own constructor

    def many(self, points: Floats) -> Samples:
        """Everything at many points (n, 3)."""
        if 0 < len(points) <= _FEW:
            columns = zip(*[self.at(*point) for point in points.tolist()], strict=True)
            return Samples(*[np.array(column) for column in columns])
        x, y, z = np.ascontiguousarray(points.T)
        air = self._air
        rate = self._rain.many(x, y, z)
        temperature = temperatures_at(air.temperature, y)
        snow = rate * shares_at(temperature, air.humidity)
        rain = rate - snow
        visibility = CONTRAST / (self._fog + falling_extinctions(rain, snow))
        none = np.zeros(len(x))
        sheltered = none > 0.0 if self._shelter is None else self._shelter.many(x, y, z)
        wetness, lying = none, none.copy()
        if self._ground is not None and self._snow is not None:
            falls = rate * air.snow_share
            wetness = self._ground.many(x, y, z, rate - falls, self._time)
            lying = self._snow.many(x, y, z, falls * self._settling, self._time)
            if self._melts:
                wetness = np.maximum(wetness, np.minimum(lying / SOAKED * FILM, FILM))
        for each in (rain, snow, wetness, lying):
            each[sheltered] = 0.0
        light = self._day_light + self.lamps.many(x, y, z)
        for place, strength in self._flashes:
            light += strength * on_level(place, x, y, z)
        return Samples(
            rain,
            snow,
            sheltered,
            winds_at(self._wind, self._profile, y),
            visibility,
            wetness,
            lying / DENSITY,
            temperature,
            light,
            np.full(len(x), air.humidity),
        )

    def mode(self, x: float, z: float) -> str:
        """ "near" inside an area (f < 1), "far" where there is one elsewhere, else "none"."""
        if not self._rain:
            return "none"
        return "near" if self._rain.covers(x, z) else "far"


def check_points(field: str, value: Any) -> Floats:
    """Points (n, 3) in m out of an array, or a sequence of sequences, of numbers."""
    allowed = f"an array of shape (n, 3) of numbers >= {-FAR:g} and <= {FAR:g}"
    try:
        points = np.asarray(value)
    except (TypeError, ValueError, OverflowError):
        raise InvalidValueError(field, value, allowed) from None
    if points.shape == (0,):
        points = points.reshape(0, 3)
    if points.ndim != 2 or points.shape[1] != 3 or points.dtype.kind not in "iuf":
        raise InvalidValueError(field, value, allowed)
    points = points.astype(np.float64)
    if not (np.abs(points) <= FAR).all():  # NaN fails the comparison
        raise InvalidValueError(field, value, allowed)
    return points


def _lamps(lights: NDArray) -> Lamps:
    rows = lights.tolist()
    return Lamps([(*place, reach, luminance(color)) for place, color, reach in rows])


def luminance(color: tuple[float, float, float]) -> float:
    """Brightness of a linear RGB colour."""
    return _RED * color[0] + _GREEN * color[1] + _BLUE * color[2]
