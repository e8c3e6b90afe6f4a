"""A wind at one moment, one number at a time: its law, its gusts that come by chance, its veering.

Everything is a function of the time and of a key; the chance is in a hash of the key and the number
of the interval, so that nothing has to be remembered and any moment can be asked for.
"""

from __future__ import annotations

import math
from functools import lru_cache

from .chance import scramble
from .chance import uniform as chance

# The wind is asked for twenty times a second, and has other gusts every twenty seconds.
uniform = lru_cache(128)(chance)

# Of a gust of a train, shares of its interval: shortest duration, and how much longer it may be;
# weakest peak and how much stronger; earliest rise, as a share of its duration, and how much later.
DURATION, PEAK, RISE = (0.4, 0.55), (0.4, 0.6), (0.15, 0.25)
# Mean of a train over time: half its peak over its duration.
TRAIN_MEAN = 0.5 * (DURATION[0] + 0.5 * DURATION[1]) * (PEAK[0] + 0.5 * PEAK[1])


def gust_now(t: float, tc: float, t_max: float, a: float, b: float, c: float, d: float) -> float:
    """`wind.gust` at one moment; its times are taken as checked."""
    if not 0.0 < t < t_max:
        return 0.0
    peak = a + b
    if t < tc:
        return max(peak * (t / tc), 0.0)
    level = c + (peak - c) * (1.0 - _ease((t - tc) / min(tc, 0.5 * (t_max - tc))))
    return max(level - max(c, d) * ((t - tc) / (t_max - tc)), 0.0)


def steady_now(
    t: float,
    times: tuple[float, float, float],
    coefficients: tuple[float, float, float, float, float, float],
) -> float:
    """`wind.steady` at one moment; its times tc, t_mid and t_max are taken as checked."""
    tc, t_mid, t_max = times
    a, b, c, d, e, f = coefficients
    if not 0.0 < t < t_max:
        return 0.0
    peak = a + b
    if t < tc:
        return max(peak * (t / tc), 0.0)
    meet = min(tc, 0.5 * (t_mid - tc))
    begun, ending = _ease((t - tc) / meet), _ease((t_mid - t) / meet)
    if t < t_mid:
        level = c + (peak - c) * (1.0 - begun) + (e - c) * (1.0 - ending)
        return max(level + d * math.cos(t / tc) * begun * ending, 0.0)
    return max(e - max(e, f) * ((t - t_mid) / (t_max - t_mid)), 0.0)


def train(t: float, interval: float, key: int) -> float:
    """A train of gusts, 0 to 1: one in every interval, of any peak and length, at any moment in it.

    Over a long time its mean is TRAIN_MEAN.
    """
    t += uniform(key) * interval  # so that two winds' gusts do not keep step
    begins, tc, duration, peak = _gust(key, math.floor(t / interval), interval)
    return peak * gust_now(t - begins, tc, duration, 1.0, 0.0, 1.0, 1.0)


@lru_cache(128)
def _gust(key: int, number: int, interval: float) -> tuple[float, float, float, float]:
    """When a gust of a train begins, how long it rises and lasts, all in s, and its peak."""
    length, peak, rise, place = [chance(key, number, k) for k in range(4)]
    duration = (DURATION[0] + DURATION[1] * length) * interval
    begins = number * interval + place * (interval - duration)
    tc = (RISE[0] + RISE[1] * rise) * duration
    return begins, tc, duration, PEAK[0] + PEAK[1] * peak


def gust_factor(t: float, gustiness: float, interval: float, key: int) -> float:
    """Speed over mean speed in a train of gusts: 1 on average, 1 + gustiness at the most."""
    return 1.0 + gustiness * (train(t, interval, key) - TRAIN_MEAN) / (1.0 - TRAIN_MEAN)


def veer_now(t: float, period: float, key: int) -> float:
    """How far the direction is off, -1 to 1: smoothly from one chance value to the next, two of
    them in a period."""
    half = t / (0.5 * period)
    number = math.floor(half)
    here, change = _veers(key, number)
    return here + change * _ease(half - number)


@lru_cache(128)
def _veers(key: int, number: int) -> tuple[float, float]:
    """Where the direction is at the beginning of a half period, and how far it goes in it."""
    here, there = (2.0 * chance(key, number + k, 4) - 1.0 for k in (0, 1))
    return here, there - here


@lru_cache(32)
def key_of(seed: int, uid: int) -> int:
    """The key of the wind of an entity."""
    return scramble(seed, uid)


def _ease(x: float) -> float:
    share = min(max(x, 0.0), 1.0)
    return share * share * (3.0 - 2.0 * share)
