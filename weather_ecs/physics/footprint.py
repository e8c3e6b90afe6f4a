"""What a collision heightmap covers, and along which slope the rain falls into it.

A map lies level, in world axes, and looks along the mean fall direction by shearing: a point is
carried along its fall to the height 0 of the world, and where it arrives is its place in the map.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .snow import AGGREGATE, LARGEST_FLAKE, aggregate_speed
from .wind import Profile, wind_at

# The wind is rounded to this slope, so that its small changes do not call for a new capture.
_SLOPE_STEP = 0.02
_STEEPEST = 4.0
_SLOW, _SWIRLED = 2.0, 0.6  # m/s, what falls slower is snow; its steepest slope
# m: a drop takes on the air's motion over speed^2/g, about 3 m for one of 1.5 mm, and so lands with
# the motion of the air that it has come through.
LANDING = 4.0
# Slope that a map may be off in gusts (and as a share of steep ones): 0.2 m on the ground under a
# roof of 2 m. Draws, half a second of them, after which it is brought up to any smaller change.
OFF, RESTED = 0.1, 30
_ABOVE, _BELOW = 120.0, 80.0  # m of height that the map can tell apart, about the observer


@dataclass(frozen=True, slots=True)
class Footprint:
    """What a map covers: its centre carried to height 0, half-size, fall slope and heights."""

    center: tuple[float, float]  # m, (x, z) at height 0
    half: float  # m
    slope: tuple[float, float]  # horizontal metres per metre of fall
    bottom: float
    top: float

    def matrix(self) -> NDArray[np.float64]:
        """World to (u, v, depth) in [0, 1], (4, 4); depth 0 at the top."""
        scale = 0.5 / self.half
        drop = 1.0 / (self.bottom - self.top)
        (cx, cz), (sx, sz) = self.center, self.slope
        return np.array(
            [
                [scale, scale * sx, 0.0, 0.5 - scale * cx],
                [0.0, scale * sz, scale, 0.5 - scale * cz],
                [0.0, drop, 0.0, -drop * self.top],
                [0.0, 0.0, 0.0, 1.0],
            ]
        )


class SlopeFollower:
    """The slope that a map is made for: that of the rain, but not in every little change of it.

    A map costs some milliseconds, and in gusts the slope never rests. It follows where it is off by
    more than OFF, or by any step after it has been the same RESTED times in a row.
    """

    def __init__(self) -> None:
        self._slope: tuple[float, float] | None = None
        self._wanted = (0.0, 0.0)
        self._rested = 0

    def follow(self, wanted: tuple[float, float]) -> tuple[float, float]:
        """The slope to use where the rain falls along `wanted`."""
        self._rested = self._rested + 1 if wanted == self._wanted else 0
        self._wanted = wanted
        kept = self._slope
        if kept is None or self._rested >= RESTED or _apart(kept, wanted):
            self._slope = kept = wanted
        return kept


def _apart(kept: tuple[float, float], wanted: tuple[float, float]) -> bool:
    off = math.dist(kept, wanted)
    return off > OFF * max(math.hypot(*kept), 1.0)


def footprint(
    position: tuple[float, float, float],
    reach: float,
    wind: tuple[float, float, float],
    fall_speed: float,
    size: int,
    before: Footprint | None,
    extent: float = 1.25,
    slope: tuple[float, float] | None = None,
) -> Footprint:
    """What the map should cover for an observer; `before` where that still serves.

    The half-size, `extent` times the reach, leaves room to move; the centre is a whole number of
    texels. Without a `slope`, it is that of wind and fall speed.
    """
    slope = fall_slope(wind, fall_speed) if slope is None else slope
    x, y, z = position
    center = (x + y * slope[0], z + y * slope[1])
    half = extent * reach
    if before is not None and before.slope == slope and before.half == half:
        moved = max(abs(center[0] - before.center[0]), abs(center[1] - before.center[1]))
        room = max(half - 1.05 * reach, 0.02 * half)
        if moved <= room and abs(y - 0.5 * (before.top + before.bottom)) <= 40.0:
            return before
    texel = 2.0 * half / size
    snapped = (round(center[0] / texel) * texel, round(center[1] / texel) * texel)
    middle = round(y / 10.0) * 10.0
    return Footprint(snapped, half, slope, middle - _BELOW, middle + _ABOVE)


def landing_wind(wind: tuple[float, float, float], profile: Profile) -> tuple[float, float, float]:
    """The wind that slants the rain where it lands, m/s: that of LANDING m above the ground."""
    return wind_at(wind, profile, profile.ground + LANDING)


def fall_slope(wind: tuple[float, float, float], fall_speed: float) -> tuple[float, float]:
    """Horizontal metres, x and z, that rain covers in a metre of mean fall, by steps of 0.02."""
    return _slope(wind[0], fall_speed), _slope(wind[2], fall_speed)


def _slope(wind: float, fall_speed: float) -> float:
    slope = round(wind / fall_speed / _SLOPE_STEP) * _SLOPE_STEP
    # What falls slowly is carried in behind houses and trees by the eddies there: the strip that
    # its mean fall would leave bare is not bare.
    steepest = _STEEPEST if fall_speed > _SLOW else _SWIRLED
    return min(max(slope, -steepest), steepest)


def fall_speed_of(rain_rate: float) -> float:
    """Speed in m/s that stands for a rain's mean fall: that of its drop of median water volume.

    Marshall and Palmer's median volume diameter is 3.67 / slope.
    """
    slope = 4.1 * max(rain_rate, 0.1) ** -0.21
    return 9.65 - 10.3 * math.exp(-0.6 * max(3.67 / slope, 0.5))


def fall_speed_over(rain_rates: NDArray, snow_share: float = 0.0) -> float:
    """Mean fall speed in m/s that maps are made for: that of the heaviest of several rains.

    Of what is mostly snow, that of the snow.
    """
    return mean_fall_speed(float(rain_rates.max()) if len(rain_rates) else 0.0, snow_share)


def mean_fall_speed(rate: float, snow_share: float = 0.0) -> float:
    """The same of one rain, mm/h."""
    return snow_speed_of(rate) if snow_share > 0.5 else fall_speed_of(rate)


def snow_speed_of(rate: float) -> float:
    """The same of snow, `rate` mm/h of water: an aggregate of Gunn and Marshall's median volume."""
    slope = 2.55 * min(max(rate, 0.1), 1e3) ** -0.48
    return float(aggregate_speed(AGGREGATE * min(3.67 / slope, LARGEST_FLAKE)))
