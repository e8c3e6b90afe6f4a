"""How much water lies on the ground: rain fills, what is too much runs off, the rest dries.

W is millimetres of water on a square metre of surface, S the millimetres a second that reach it, C
what the surface can hold before water runs off it:

    dW/dt = S - W / DRYING - max(W - C, 0) / DRAINING

With S and C constant this has a closed form on either side of C, and W passes C at most once, so
that a step may be as long as one likes. `shaders/wetness_law.glsl` has the same symbols. Rates are
those of a game's minute and not of nature's afternoon; the temperature is taken as constant.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

DRYING = 180.0  # s in which a film dries to 1/e, by soaking in and evaporation
DRAINING = 15.0  # s in which what a surface cannot hold runs off to 1/e
FILM, STEEP_FILM = 1.0, 0.3  # mm that level and steep surfaces hold
CATCHMENT = 8.0  # times its own rain that runs together in a hollow
DEEPEST = 60.0  # mm, of a hollow that counts

MM_PER_S = 1.0 / 3600.0  # mm/s in a mm/h
_FAST = 1.0 / DRYING + 1.0 / DRAINING  # 1/s


def film_capacity(up: ArrayLike) -> NDArray[np.float64]:
    """Water in mm that a surface holds: less where its normal's upward part `up` is small."""
    share = np.clip((np.asarray(up, np.float64) - 0.5) / 0.45, 0.0, 1.0)
    return STEEP_FILM + (FILM - STEEP_FILM) * share * share * (3.0 - 2.0 * share)


def settle(
    water: ArrayLike, inflow: ArrayLike, capacity: ArrayLike, seconds: float
) -> NDArray[np.float64]:
    """W in mm after some seconds; inflow S in mm/s, capacity C in mm. Arrays of one shape."""
    w, s, c = np.broadcast_arrays(
        np.asarray(water, np.float64), np.asarray(inflow, np.float64), capacity
    )
    low, high = s * DRYING, (s + c / DRAINING) / _FAST
    below = low + (w - low) * math.exp(-seconds / DRYING)
    above = high + (w - high) * math.exp(-seconds * _FAST)
    under = w <= c
    result = np.where(under, below, above)
    rises, sinks = under & (below > c), ~under & (above < c)
    if rises.any():
        w1, l1, h1, c1 = w[rises], low[rises], high[rises], c[rises]
        left = seconds - DRYING * np.log((l1 - w1) / (l1 - c1))
        result[rises] = h1 + (c1 - h1) * np.exp(-np.maximum(left, 0.0) * _FAST)
    if sinks.any():
        w1, l1, h1, c1 = w[sinks], low[sinks], high[sinks], c[sinks]
        left = seconds - np.log((w1 - h1) / (c1 - h1)) / _FAST
        result[sinks] = l1 + (c1 - l1) * np.exp(-np.maximum(left, 0.0) / DRYING)
    return result


def settle_one(w: float, s: float, c: float, seconds: float) -> float:
    """`settle` for one place, in plain numbers."""
    low, high = s * DRYING, (s + c / DRAINING) / _FAST
    if w <= c:
        below = low + (w - low) * math.exp(-seconds / DRYING)
        if below <= c:
            return below
        left = seconds - DRYING * math.log((low - w) / (low - c))
        return high + (c - high) * math.exp(-max(left, 0.0) * _FAST)
    above = high + (w - high) * math.exp(-seconds * _FAST)
    if above >= c:
        return above
    left = seconds - math.log((w - high) / (c - high)) / _FAST
    return low + (c - low) * math.exp(-max(left, 0.0) / DRYING)


def merge(one: ArrayLike, other: ArrayLike) -> NDArray[np.float64]:
    """W on level ground where two fields speak of different areas' rain over the same place.

    Films add up until the ground is full, as the law is linear up to there; so does what runs off.
    """
    a, b = np.asarray(one, np.float64), np.asarray(other, np.float64)
    return np.minimum(a + b, FILM) + np.maximum(a - FILM, 0.0) + np.maximum(b - FILM, 0.0)


def merge_one(a: float, b: float) -> float:
    """`merge` for one place, in plain numbers."""
    return min(a + b, FILM) + max(a - FILM, 0.0) + max(b - FILM, 0.0)
