"""Lightning: currents, the course of a flash in time, its light, thunder, and where it strikes.

Figures are those of V. A. Rakov and M. A. Uman, "Lightning: Physics and Effects" (Cambridge 2003),
where nothing else is said. `word` is a whole number from which a flash draws its chance.
"""

from __future__ import annotations

import math
from functools import lru_cache
from statistics import NormalDist
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from weather_ecs.physics.chance import uniform

SOUND = 340.0  # m/s
LEADER = 0.035  # s that the stepped leader takes to come down
MEDIAN_CURRENT = 30.0  # kA, of first return strokes (Berger et al. 1975)
_CURRENT_SIGMA = 0.61  # of its natural logarithm
LEAST_CURRENT, GREATEST_CURRENT = 3.0, 300.0  # kA (Cooray and Rakov 2012)
ENERGY = 1.0e9  # J, of a flash of the median current
_INTERVAL = 0.060  # s between strokes, geometric mean
_INTERVAL_SIGMA = 0.6
_LATER = 0.40  # of the first stroke's current, what later ones have: 12 of 30 kA
_CONTINUING = 0.3  # share of flashes to ground that have a long continuing current
# The light of a stroke is gone in a millisecond. It is held as long as an eye or an exposure of a
# film camera does, or most frames of a picture would miss it.
HELD = 0.040  # s
FAINTEST = 0.004  # of a first stroke, below which a flash is over
CHANNEL = 2500.0  # m, within which light does not fall off as from a point
ALL_ROUND = 0.45  # share of the light that clouds and air have scattered until it arrives

Vector = tuple[float, float, float]
_NORMAL = NormalDist()


class Course(NamedTuple):
    """Light of a flash in time, s from its beginning; 1: of a first stroke."""

    times: tuple[float, ...]  # of the strokes
    peaks: tuple[float, ...]
    continuing: tuple[float, float, float]  # from, to, level
    end: float  # s


def poisson(mean: float, chance: float) -> int:
    """A number of events of which `mean` are expected, by a chance in [0, 1)."""
    count, share = 0, math.exp(-mean)
    while chance >= share and count < 1000:
        chance -= share
        count += 1
        share *= mean / count
    return count


def peak_current(word: int) -> float:
    """kA of the first return stroke: log-normal, median 30 kA."""
    value = MEDIAN_CURRENT * math.exp(_CURRENT_SIGMA * _normal(word, 1))
    return round(min(max(value, LEAST_CURRENT), GREATEST_CURRENT), 2)


def striking_distance(current: float) -> float:
    """m from which the leader jumps to what stands there: 10 I^0.65 (Love 1973; IEC 62305)."""
    return 10.0 * current**0.65


def strength(current: float) -> float:
    """Light of a flash, 1 for the median current, as which it goes (Idone and Orville 1985).

    Kept in bounds that an eye would adapt to.
    """
    return min(max(current / MEDIAN_CURRENT, 0.5), 2.0)


def energy(current: float) -> float:
    """J: as the charge that is brought down, and so as the current."""
    return ENERGY * current / MEDIAN_CURRENT


@lru_cache(maxsize=512)
def course(word: int, ground: bool) -> Course:
    """The strokes of a flash to ground, or the pulses of one in the cloud."""
    return _strokes(word) if ground else _pulses(word)


def _strokes(word: int) -> Course:
    """One in five has a single stroke; the mean is three."""
    count = 1 + int(5.0 * uniform(word, 2))
    times, peaks = [LEADER], [1.0]
    for k in range(1, count):
        gap = _INTERVAL * math.exp(_INTERVAL_SIGMA * _normal(word, 3, k))
        times.append(times[-1] + min(max(gap, 0.015), 0.25))
        peaks.append(_LATER * (0.6 + 0.8 * uniform(word, 4, k)))
    last = times[-1]
    on = (last, last, 0.0)
    if uniform(word, 5) < _CONTINUING:
        on = (last, last + 0.04 + 0.26 * uniform(word, 6), 0.10 + 0.08 * uniform(word, 7))
    return _ended(times, peaks, on)


def _pulses(word: int) -> Course:
    """A weak steady light with some 4 to 9 recoil streamers, for 0.2 to 0.6 s."""
    count = 4 + int(6.0 * uniform(word, 2))
    length = 0.2 + 0.4 * uniform(word, 3)
    times = sorted(length * uniform(word, 4, k) for k in range(count))
    peaks = [0.12 + 0.45 * uniform(word, 5, k) ** 2 for k in range(count)]
    brightest = int(count * uniform(word, 6))
    peaks[brightest] = 0.75
    return _ended(times, peaks, (0.0, length, 0.06))


def _ended(times: list[float], peaks: list[float], on: tuple[float, float, float]) -> Course:
    end = times[-1] + HELD * math.log(2.0 / FAINTEST)
    if on[2] > 0.0:
        end = max(end, on[1] + HELD * math.log(2.0 * on[2] / FAINTEST))
    return Course(tuple(times), tuple(peaks), on, end)


def intensity(flash: Course, age: float) -> float:
    """Light `age` seconds after a flash began; 1: of a first stroke, just now."""
    if not 0.0 <= age < flash.end:
        return 0.0
    total = 0.0
    if age < flash.times[0]:
        total = 0.03 * age / flash.times[0]  # the leader
    for time, peak in zip(flash.times, flash.peaks, strict=True):
        if age >= time:
            total += peak * math.exp((time - age) / HELD)
    begin, stop, level = flash.continuing
    if age >= begin and level > 0.0:
        total += level * math.exp(min(stop - age, 0.0) / HELD)
    return total


def thunder_delay(distance: float) -> float:
    """s that the sound takes over so many metres."""
    return distance / SOUND


def channel_distance(origin: Vector, target: Vector, point: Vector) -> float:
    """m from a point to the straight line between the ends of a channel."""
    a, b, p = np.array(origin), np.array(target), np.array(point)
    way = b - a
    length2 = float(way @ way)
    share = min(max(float((p - a) @ way) / length2, 0.0), 1.0) if length2 > 0.0 else 0.0
    return round(float(np.linalg.norm(a + share * way - p)), 3)


def falloff(distance2: NDArray | float) -> NDArray | float:
    """Share of a flash's light at the square of a distance, m2: of a line, then of a point."""
    return 1.0 / (1.0 + distance2 / (CHANNEL * CHANNEL))


def on_surface(place: Vector, point: Vector, normal: Vector) -> float:
    """Share of a flash's light on a surface with a unit normal, at a point."""
    dx, dy, dz = (a - b for a, b in zip(place, point, strict=True))
    distance2 = dx * dx + dy * dy + dz * dz
    length = math.sqrt(distance2)
    facing = (dx * normal[0] + dy * normal[1] + dz * normal[2]) / length if length > 0.0 else 1.0
    return float(falloff(distance2)) * (ALL_ROUND + (1.0 - ALL_ROUND) * max(facing, 0.0))


def on_level(place: Vector, x: NDArray, y: NDArray, z: NDArray) -> NDArray:
    """`on_surface` of level surfaces that look up, at many points."""
    dx, dy, dz = place[0] - x, place[1] - y, place[2] - z
    distance2 = dx * dx + dy * dy + dz * dz
    length = np.sqrt(distance2)
    facing = np.divide(dy, length, out=np.ones_like(length), where=length > 0.0)
    return np.asarray(falloff(distance2) * (ALL_ROUND + (1.0 - ALL_ROUND) * np.maximum(facing, 0)))


def attached(x: float, z: float, ground: float, current: float, tips: NDArray) -> Vector:
    """Where a leader ends that comes down over (x, z): on the ground or on what stands near.

    tips: (n, 3) m, corners of what stands there, and the surface right below. The electro-geometric
    model: a tip takes the leader that first comes within the striking distance of it.
    """
    reach = striking_distance(current)
    best, meets = (x, ground, z), ground + reach
    if len(tips):
        aside2 = (tips[:, 0] - x) ** 2 + (tips[:, 2] - z) ** 2
        height = tips[:, 1] + np.sqrt(np.maximum(reach * reach - aside2, 0.0))
        height[aside2 > reach * reach] = -np.inf
        k = int(np.argmax(height))
        if height[k] > meets:
            best = (float(tips[k, 0]), float(tips[k, 1]), float(tips[k, 2]))
    return best


def _normal(*words: int) -> float:
    return _NORMAL.inv_cdf(min(max(uniform(*words), 1e-9), 1.0 - 1e-9))
