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
        "afternoon", _towards(227.0, 25.0),
        (1.00, 0.86, 0.66), (0.20, 0.32, 0.52), (0.62, 0.68, 0.74), (0.19, 0.18, 0.14), 0.45,
    ),
    TimeOfDay(
        "evening", _towards(272.0, 9.0),
        (0.95, 0.50, 0.22), (0.15, 0.20, 0.36), (0.66, 0.47, 0.36), (0.14, 0.11, 0.09), 0.85,
    ),
    TimeOfDay(
        "dusk", _towards(296.0, 4.0),
        (0.10, 0.07, 0.08), (0.030, 0.045, 0.095), (0.13, 0.12, 0.15), (0.03, 0.03, 0.035), 1.0,
    ),
    TimeOfDay(
        "morning", _towards(98.0, 14.0),
        (0.92, 0.72, 0.50), (0.20, 0.32, 0.54), (0.66, 0.65, 0.66), (0.17, 0.16, 0.13), 0.6,
    ),
    TimeOfDay(
        "noon", _towards(186.0, 55.0),
        (1.00, 0.94, 0.84), (0.16, 0.32, 0.62), (0.52, 0.64, 0.78), (0.20, 0.20, 0.16), 0.3,
    ),
)  # fmt: skip

# Under a full moon, which an `Atmosphere` shows; it stands there on the evening of the night tour.
NIGHT = TimeOfDay(
    "night", _towards(130.0, 38.0),
    (0.050, 0.058, 0.075), (0.010, 0.014, 0.026), (0.020, 0.025, 0.038), (0.008, 0.008, 0.010), 1.0,
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
    """The same light under clouds: broken ones leave it, a closed cover makes it grey and dark."""
    closed = min(max((overcast - 0.3) / 0.7, 0.0), 1.0)
    grey = 0.62 * (0.5 * _brightness(clear.zenith_color) + 0.5 * _brightness(clear.horizon_color))
    return Light(
        clear.sun_direction,
        _dimmed(clear.sun_color, 1.0 - 0.94 * closed),
        _mix(clear.zenith_color, (0.92 * grey, 0.98 * grey, 1.06 * grey), closed),
        _mix(clear.horizon_color, (1.16 * grey, 1.20 * grey, 1.24 * grey), closed),
        _dimmed(clear.ground_color, 1.0 - 0.3 * closed),
        clear.lamps + closed * 0.5 * (1.0 - clear.lamps),
    )


def hide(light: Light, left: float) -> Light:
    """The same light under fog that leaves so much of the sun's, 0 to 1: the rest comes from all
    round.
    """
    if left >= 1.0:
        return light
    high = 0.25 * max(light.sun_direction[1], 0.0)
    around = _mix(_mix(light.zenith_color, light.horizon_color, 0.5), light.sun_color, high)
    grey = 0.5 * _brightness(around)
    r, g, b = (0.5 * value + grey for value in around)
    return Light(
        light.sun_direction,
        _dimmed(light.sun_color, left),
        _mix((1.06 * r, 1.06 * g, 1.06 * b), light.zenith_color, left),
        _mix((r, g, b), light.horizon_color, left),
        light.ground_color,
        light.lamps + 0.5 * (1.0 - left) * (1.0 - light.lamps),
    )


def dim(light: Light, left: float) -> Light:
    """The same light with so much of it left, 0 to 1, as under the depth of a storm's cloud."""
    if left >= 1.0:
        return light
    return Light(
        light.sun_direction,
        _dimmed(light.sun_color, left),
        _dimmed(light.zenith_color, left),
        _dimmed(light.horizon_color, left),
        _dimmed(light.ground_color, left),
        light.lamps + (1.0 - left) * (1.0 - light.lamps),
    )


def under_cloud(rain_rate: float) -> float:
    """Share of the daylight that is left to what falls under the cloud that rains so many mm/h."""
    return 1.0 - 0.45 * (1.0 - math.exp(-rain_rate / 4.0))


def _dimmed(color: Color, share: float) -> Color:
    return color[0] * share, color[1] * share, color[2] * share


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

    def be_night(self) -> None:
        """Be at night at once."""
        self._before = self._after = NIGHT
        self._time = self.CHANGE_TIME

    def update(self, dt: float) -> None:
        """Let dt seconds pass."""
        self._time = min(self._time + dt, self.CHANGE_TIME)

    def light(self, overcast: float) -> Light:
        """The light now."""
        share = self._time / self.CHANGE_TIME
        share = share * share * (3.0 - 2.0 * share)
        return cover(light(self._before, self._after, share), overcast)
