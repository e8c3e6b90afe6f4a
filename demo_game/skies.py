"""Times of day: the game's `Atmosphere`, what covers its sky, and the lamps that it calls for."""

from __future__ import annotations

import math
from dataclasses import dataclass
from datetime import datetime
from typing import Any

from weather_ecs.components import Atmosphere

Color = tuple[float, float, float]

LATITUDE = 50.0  # degrees north
DAY = 86_400.0  # s
LEAST_HEIGHT = 0.06  # sine, of what casts shadows: long ones find no end
# Of the light on level ground of a bright day, below which the game shows more of it, and by which
# power: under clouds, and in the dark.
SEEN = (0.5, 0.3), (0.15, 0.4)
MOST_EXPOSURE = 5.0
LAMPS_DARK, LAMPS_LIGHT = 0.25, 0.85  # light on level ground between which lamps are turned up
LAMPS_LEAST = 0.04  # by day


@dataclass(frozen=True)
class TimeOfDay:
    """A moment of the game's day."""

    name: str
    time: str  # UTC, at longitude 0


# The day of the tours, in March before the night of a full moon, from the afternoon on.
TOUR_TIMES = (
    TimeOfDay("afternoon", "2025-03-13T14:30:00Z"),
    TimeOfDay("evening", "2025-03-13T17:00:00Z"),
    TimeOfDay("dusk", "2025-03-13T18:20:00Z"),
    TimeOfDay("night", "2025-03-13T21:30:00Z"),
    TimeOfDay("morning", "2025-03-13T07:40:00Z"),
    TimeOfDay("noon", "2025-03-13T12:10:00Z"),
)
# The day that is played, in November, whose sun is low and behind who looks along the path: the
# shower ahead has a whole rainbow, and things have long shadows. The key goes round.
TIMES = (
    TimeOfDay("afternoon", "2025-11-05T13:40:00Z"),
    TimeOfDay("evening", "2025-11-05T15:20:00Z"),
    TimeOfDay("dusk", "2025-11-05T16:50:00Z"),
    TimeOfDay("night", "2025-11-05T20:00:00Z"),
    TimeOfDay("morning", "2025-11-05T08:33:00Z"),
    TimeOfDay("noon", "2025-11-05T11:45:00Z"),
)


@dataclass(frozen=True)
class Light:
    """Light of sun, sky and ground, linear RGB, and the lamps in it."""

    sun_direction: tuple[float, float, float] = (-0.77, 0.42, 0.48)  # unit, towards sun or moon
    sun_color: Color = (0.95, 0.84, 0.66)
    zenith_color: Color = (0.14, 0.23, 0.43)
    horizon_color: Color = (0.69, 0.82, 0.95)
    ground_color: Color = (0.13, 0.14, 0.13)
    lamps: float = LAMPS_LEAST  # 0..1, how bright they burn

    @property
    def fog_color(self) -> Color:
        """Of fog and of the air far off: as the weather has it, lit from all round."""
        high = 0.05 * self.sun_direction[1]
        r, g, b = (
            0.75 * horizon + 0.25 * zenith + high * sun
            for horizon, zenith, sun in zip(
                self.horizon_color, self.zenith_color, self.sun_color, strict=True
            )
        )
        return r, g, b

    @property
    def level(self) -> float:
        """Luminance on level ground in the open."""
        sky = brightness(self.zenith_color) + brightness(self.horizon_color)
        return brightness(self.sun_color) * self.sun_direction[1] + 0.5 * sky


def light_of(sky: Any) -> Light:
    """The light that `Weather.light` tells, with its lamps."""
    x, y, z = sky.sun_direction
    y = max(y, LEAST_HEIGHT)
    length = math.sqrt(x * x + y * y + z * z)
    light = Light(
        (x / length, y / length, z / length),
        sky.sun_color,
        sky.zenith_color,
        sky.horizon_color,
        sky.ground_color,
    )
    return Light(
        light.sun_direction,
        light.sun_color,
        light.zenith_color,
        light.horizon_color,
        light.ground_color,
        lamps_in(light.level),
    )


def lamps_in(level: float) -> float:
    """How bright lamps burn in such a light on level ground."""
    dark = (LAMPS_LIGHT - level) / (LAMPS_LIGHT - LAMPS_DARK)
    return LAMPS_LEAST + (1.0 - LAMPS_LEAST) * _smooth(dark)


def under_cloud(rain_rate: float) -> float:
    """Share of the daylight that is left to what falls under the cloud that rains so many mm/h."""
    return 1.0 - 0.45 * (1.0 - math.exp(-rain_rate / 4.0))


def brightness(color: Color) -> float:
    """Luminance of linear RGB."""
    return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]


def _smooth(x: float) -> float:
    x = min(max(x, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


class SkyChanger:
    """Carries the time of an `Atmosphere` to the one that was asked for, and on from there."""

    CHANGE_TIME = 5.0  # s

    def __init__(
        self,
        *,
        draw: bool = False,
        runs: bool = False,
        rainbow: bool = True,
        times: tuple[TimeOfDay, ...] = TIMES,
    ) -> None:
        self._times = times
        self._index, self._passed, self._runs = 0, self.CHANGE_TIME, runs
        self._from = self._to = seconds(times[0].time)
        self.atmosphere = Atmosphere(
            times[0].time,
            latitude=LATITUDE,
            speed=float(runs),
            draw=draw,
            rainbow=float(rainbow),
            overcast=0.0,
        )

    @property
    def name(self) -> str:
        """The time of day that is there or will be reached."""
        return self._times[self._index].name

    def next(self) -> None:
        """Go on to the next time of day."""
        self._index = (self._index + 1) % len(self._times)
        self._from, self._passed = float(self.atmosphere.time), 0.0
        self._to = seconds(self._times[self._index].time)
        if self._to < self._from:
            self._to += DAY

    def be(self, name: str) -> None:
        """Be at a time of day at once."""
        self._index = next(k for k, time in enumerate(self._times) if time.name == name)
        self._to = seconds(self._times[self._index].time)
        self._passed = self.CHANGE_TIME
        self._arrive()

    def update(self, dt: float) -> None:
        """Let dt seconds pass."""
        if self._passed >= self.CHANGE_TIME:
            return
        self._passed += dt
        if self._passed >= self.CHANGE_TIME:
            self._arrive()
            return
        share = _smooth(self._passed / self.CHANGE_TIME)
        self.atmosphere.time = self._from + share * (self._to - self._from)
        self.atmosphere.speed = 0.0

    def cover(self, overcast: float, gloom: float, light: Light) -> None:
        """Say how much of the sky is covered, and what share of the light such clouds leave.

        light: as it was; in the dark more of it is shown, as by an eye that has got used to it.
        """
        air = self.atmosphere
        bare = light.level / air.exposure
        wider = 1.0
        for level, power in SEEN:
            wider *= max(level / max(bare, 1e-6), 1.0) ** power
        wider = min(wider, MOST_EXPOSURE)
        # What changes by less nobody sees, and it would make the light anew every frame.
        overcast, exposure = round(overcast, 2), round(50.0 * wider * gloom) / 50.0
        if air.overcast != overcast:
            air.overcast = overcast
        if air.exposure != exposure:
            air.exposure = exposure

    def _arrive(self) -> None:
        # The next day's is this one's: the year does not go on with the key.
        self.atmosphere.time = seconds(self._times[self._index].time)
        self.atmosphere.speed = float(self._runs)


def seconds(time: str) -> float:
    """Since 1970, of a moment in ISO 8601."""
    return datetime.fromisoformat(time).timestamp()
