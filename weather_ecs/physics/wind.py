"""Strength of the wind over time, gust and steady, and its growth with height.

Liu and Tong (2015), section 2.3, give both winds in words and in formulas, times in units of tc:

    gust     a t + b   (0 to tc);   c - d (tc - t)/tc   (tc to t_max)
    steady   a t + b   (0 to tc);   c + d cos t         (tc to t_mid);
             e - f (tc - t)/tc   (t_mid to t_max)

The formulas do not do what the words say: both last branches grow instead of dying, the steady
wind jumps at its joints, and neither is zero at t_max. Here the words rule:

- the last branches fall: their sign is turned, and their time runs from 0 where they begin to 1
  at t_max, so that they end there. Where d (or f) is less than c (or e), it is raised to it: the
  wind dies wholly; where it is more, the wind is dead before t_max and stays so.
- b grows with t over the rise, so that the wind starts from zero.
- a joint where two branches differ is crossed smoothly: the later branch starts from where the
  earlier one ended and is itself after at most one tc (half the branch, if it is shorter). The
  cosine's share is blended in and out so. With the paper's coefficients nothing else is changed.

Strengths are never negative, and 0 before 0 and after t_max. They have no unit: multiply by m/s.
"""

from __future__ import annotations

import math
from itertools import pairwise
from typing import Protocol

import numpy as np
from numpy.typing import ArrayLike, NDArray

from weather_ecs.errors import InvalidValueError

from .checks import FloatArray, floats, number

# m above the ground between which the wind grows with height: from the roughness length of open
# land to the gradient height, where it no longer feels the ground (Davenport 1960).
LOWEST, HIGHEST = 0.03, 300.0


def gust(
    t: ArrayLike,
    tc: float,
    t_max: float,
    *,
    a: float = 1.0,
    b: float = 0.0,
    c: float = 1.0,
    d: float = 1.0,
) -> FloatArray:
    """Rises from zero to its peak at tc and falls back to zero at t_max, 0 < tc < t_max (s).

    (a + b) t/tc, then c - d (t - tc)/(t_max - tc). Departs from the printed formulas as the
    module says: those grow after tc.
    """
    time, (rise, fall) = _times(t, tc=tc, t_max=t_max)
    a, b, c, d = _coefficients(a=a, b=b, c=c, d=d)
    peak = a + b
    meet = min(tc, 0.5 * (t_max - tc))
    level = c + (peak - c) * (1.0 - _ease((time - tc) / meet))
    dying = level - max(c, d) * fall
    return _alive(time, t_max, np.where(time < tc, peak * rise, dying))


def steady(
    t: ArrayLike,
    tc: float,
    t_mid: float,
    t_max: float,
    *,
    a: float = 1.0,
    b: float = 0.0,
    c: float = 1.0,
    d: float = 0.3,
    e: float = 1.0,
    f: float = 1.0,
) -> FloatArray:
    """Rises until tc, holds with a slight variation until t_mid, dies down to zero at t_max (s).

    (a + b) t/tc, then c + d cos(t/tc), then e - f (t - t_mid)/(t_max - t_mid), for
    0 < tc < t_mid < t_max. Departs from the printed formulas as the module says: those jump at tc
    and t_mid and grow after it.
    """
    time, (rise, _, fall) = _times(t, tc=tc, t_mid=t_mid, t_max=t_max)
    a, b, c, d, e, f = _coefficients(a=a, b=b, c=c, d=d, e=e, f=f)
    peak = a + b
    meet = min(tc, 0.5 * (t_mid - tc))
    begun, ending = _ease((time - tc) / meet), _ease((t_mid - time) / meet)
    level = c + (peak - c) * (1.0 - begun) + (e - c) * (1.0 - ending)
    held = level + d * np.cos(time / tc) * begun * ending
    dying = e - max(e, f) * fall
    blowing = np.where(time < tc, peak * rise, np.where(time < t_mid, held, dying))
    return _alive(time, t_max, blowing)


def power_law(height: ArrayLike, reference: float = 10.0, exponent: float = 0.14) -> FloatArray:
    """Wind speed at `height` over that at `reference` metres: (height/reference)^exponent.

    0 on the ground and below. 1/7, about 0.14, holds over open land (Hellmann; Touma 1977).
    """
    up = np.maximum(floats("height", height), 0.0)
    power = number("exponent", exponent, 0.0)
    with np.errstate(over="ignore"):
        rise = (up / number("reference", reference, 0.0, above=True)) ** power
    return np.where(up > 0.0, rise, 0.0)


def height_share(height: float, reference: float, exponent: float) -> float:
    """`power_law` at one height within LOWEST and HIGHEST, as the weather uses it."""
    if exponent == 0.0:
        return 1.0
    return float((min(max(height, LOWEST), HIGHEST) / reference) ** exponent)


class Profile(Protocol):
    """How a wind grows with height; see `frame.WindProfile`."""

    @property
    def reference(self) -> float: ...
    @property
    def exponent(self) -> float: ...
    @property
    def ground(self) -> float: ...


def wind_at(
    wind: tuple[float, float, float], profile: Profile, y: float
) -> tuple[float, float, float]:
    """The mean wind at a world height y, m/s; `wind` is that at the reference height."""
    if profile.exponent == 0.0:
        return wind
    height = min(max(y - profile.ground, LOWEST), HIGHEST)
    share = (height / profile.reference) ** profile.exponent
    return wind[0] * share, wind[1] * share, wind[2] * share


def winds_at(
    wind: tuple[float, float, float], profile: Profile, y: FloatArray
) -> NDArray[np.float64]:
    """`wind_at` at many heights (n,): (n, 3)."""
    if profile.exponent == 0.0:
        return np.tile(np.array(wind), (len(y), 1))
    height = np.clip(y - profile.ground, LOWEST, HIGHEST)
    return np.asarray((height / profile.reference)[:, None] ** profile.exponent * np.array(wind))


def _times(t: ArrayLike, **joints: float) -> tuple[FloatArray, list[FloatArray]]:
    """Checked times, those outside put at 0 or t_max; how far each phase has run, 0 to 1."""
    ends = [0.0]
    for name, joint in joints.items():
        ends.append(number(name, joint))
        if not ends[-1] > ends[-2]:
            raise InvalidValueError(name, joint, f"above {ends[-2]:g} s, joints in order")
    time = np.clip(floats("t", t, -math.inf, math.inf), 0.0, ends[-1])
    return time, [np.clip((time - i) / (j - i), 0.0, 1.0) for i, j in pairwise(ends)]


def _coefficients(**named: float) -> list[float]:
    return [number(name, value) for name, value in named.items()]


def _ease(x: FloatArray) -> FloatArray:
    """Smoothstep from 0 at x = 0 to 1 at x = 1."""
    share = np.clip(x, 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)


def _alive(time: FloatArray, t_max: float, strength: FloatArray) -> FloatArray:
    return np.where((time > 0.0) & (time < t_max), np.maximum(strength, 0.0), 0.0)
