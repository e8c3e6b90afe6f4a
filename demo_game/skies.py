"""Times of day: where the sun stands and what colours its light and the sky have."""

from __future__ import annotations

import math
from dataclasses import dataclass

Color = tuple[float, float, float]


@dataclass(frozen=True)
class TimeOfDay:
    """Light of a clear sky, linear RGB."""

    name: str
    sun_direction: tuple[float, float, float]  # unit, towards the sun
    sun_color: Color
    zenith_color: Color
    horizon_color: Color
    ground_color: Color
    lamps: float  # 0..1, how bright the lamps burn


@dataclass(frozen=True)
class Light:
    """Light under a sky that is partly covered, linear RGB."""

    sun_direction: tuple[float, float, float]
    sun_color: Color
    zenith_color: Color
    horizon_color: Color
    ground_color: Color
    lamps: float


def _towards(azimuth: float, height: float) -> tuple[float, float, float]:
    """Unit vector; azimuth in degrees from -z (north) over +x (east)."""
    a, h = math.radians(azimuth), math.radians(height)
    return math.sin(a) * math.cos(h), math.sin(h), -math.cos(a) * math.cos(h)


TIMES = (
    TimeOfDay(
        "afternoon", _towards(236.0, 38.0),
        (1.00, 0.93, 0.80), (0.20, 0.36, 0.68), (0.60, 0.70, 0.80), (0.19, 0.19, 0.15), 0.35,
    ),
    TimeOfDay(
        "evening", _towards(278.0, 11.0),
        (1.00, 0.62, 0.33), (0.17, 0.25, 0.46), (0.78, 0.58, 0.44), (0.16, 0.13, 0.11), 0.8,
    ),
    TimeOfDay(
        "dusk", _towards(296.0, 3.5),
        (0.34, 0.22, 0.20), (0.050, 0.075, 0.155), (0.20, 0.17, 0.20), (0.045, 0.045, 0.05), 1.0,
    ),
    TimeOfDay(
        "morning", _towards(96.0, 17.0),
        (1.00, 0.80, 0.58), (0.22, 0.36, 0.62), (0.74, 0.72, 0.72), (0.18, 0.17, 0.14), 0.5,
    ),
    TimeOfDay(
        "noon", _towards(180.0, 58.0),
        (1.05, 1.00, 0.92), (0.17, 0.36, 0.74), (0.55, 0.69, 0.85), (0.21, 0.21, 0.17), 0.15,
    ),
)  # fmt: skip


def light(before: TimeOfDay, after: TimeOfDay, share: float) -> Light:
    """The light on the way from one time of day to another, under a clear sky."""
    direction = _mix(before.sun_direction, after.sun_direction, share)
    # Halfway between opposite suns the mixture must not pass under the ground or vanish.
    direction = (direction[0], max(direction[1], 0.06), direction[2])
    length = math.sqrt(sum(value * value for value in direction))
    x, y, z = (value / length for value in direction)
    return Light(
        (x, y, z),
        _mix(before.sun_color, after.sun_color, share),
        _mix(before.zenith_color, after.zenith_color, share),
        _mix(before.horizon_color, after.horizon_color, share),
        _mix(before.ground_color, after.ground_color, share),
        before.lamps + share * (after.lamps - before.lamps),
    )


def cover(clear: Light, overcast: float) -> Light:
    """The same light under clouds: no sun to speak of, and a grey, darker sky."""
    sun = 1.0 - 0.94 * overcast
    grey = 0.62 * (0.5 * _brightness(clear.zenith_color) + 0.5 * _brightness(clear.horizon_color))
    zenith = (0.92 * grey, 0.98 * grey, 1.06 * grey)
    horizon = (1.16 * grey, 1.20 * grey, 1.24 * grey)
    ground = _mix((0.0, 0.0, 0.0), clear.ground_color, 0.7)
    return Light(
        clear.sun_direction,
        _mix((0.0, 0.0, 0.0), clear.sun_color, sun),
        _mix(clear.zenith_color, zenith, overcast),
        _mix(clear.horizon_color, horizon, overcast),
        _mix(clear.ground_color, ground, overcast),
        clear.lamps + overcast * 0.5 * (1.0 - clear.lamps),
    )


def _brightness(color: Color) -> float:
    return 0.2126 * color[0] + 0.7152 * color[1] + 0.0722 * color[2]


def _mix(a: Color, b: Color, share: float) -> Color:
    return (
        a[0] + share * (b[0] - a[0]),
        a[1] + share * (b[1] - a[1]),
        a[2] + share * (b[2] - a[2]),
    )


class SkyChanger:
    """The current time of day, on its way to the one that was asked for."""

    CHANGE_TIME = 5.0  # s

    def __init__(self, index: int = 0) -> None:
        self._before = self._after = TIMES[index]
        self._index, self._time = index, self.CHANGE_TIME

    @property
    def name(self) -> str:
        """The time of day that is there or will be reached."""
        return self._after.name

    def next(self) -> None:
        """Go on to the next time of day."""
        self._index = (self._index + 1) % len(TIMES)
        self._before, self._after = self._after, TIMES[self._index]
        self._time = 0.0

    def update(self, dt: float) -> None:
        """Let dt seconds pass."""
        self._time = min(self._time + dt, self.CHANGE_TIME)

    def light(self, overcast: float) -> Light:
        """The light now."""
        share = self._time / self.CHANGE_TIME
        share = share * share * (3.0 - 2.0 * share)
        return cover(light(self._before, self._after, share), overcast)
