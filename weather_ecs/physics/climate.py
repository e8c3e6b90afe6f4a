"""Climate: the state of the skies in time, and the shares of the skies round it.

After R. P. Torchelsen, "Modelo para simulação em tempo-real de nuvens usando billboards" (UNISINOS,
2005), section 3.4. States are 0 for a clear sky to 1 for a storm.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.checks import FloatArray, floats, number


def state(initial: float, final: float, duration: float, t: float) -> float:
    """State t seconds into a run: initial + (final - initial) t / duration; held at both ends."""
    start = number("initial", initial, 0.0, 1.0)
    end = number("final", final, 0.0, 1.0)
    whole = number("duration", duration, 0.0, above=True)
    done = min(max(number("t", t) / whole, 0.0), 1.0)
    now = start * (1.0 - done) + end * done  # exact at both ends
    return min(max(now, min(start, end)), max(start, end))  # rounding may lead beyond them


def shares(states: ArrayLike, state: float) -> FloatArray:
    """What each sky gives to the clouds that come in while the weather is in `state`, shape (n,).

    Skies are given by their states, in any order and no two the same. Of the two that bracket the
    state, sky i gives 1 - |state - S_i| / (S_next - S_previous); beyond the outermost sky, that one
    gives all. The sum is 1.
    """
    skies = floats("states", states, 0.0, 1.0)
    if skies.ndim != 1 or not len(skies):
        raise InvalidValueError("states", states, "one number or more, shape (n,)")
    now = number("state", state, 0.0, 1.0)
    order = np.argsort(skies)
    ordered = skies[order]
    if np.any(ordered[1:] == ordered[:-1]):
        raise InvalidValueError("states", states, "numbers that all differ")
    result = np.zeros(len(skies))
    after = int(np.searchsorted(ordered, now))  # the first sky at the state or above it
    if after == 0 or after == len(skies):
        result[order[min(after, len(skies) - 1)]] = 1.0
        return result
    low, high = float(ordered[after - 1]), float(ordered[after])
    upper = (now - low) / (high - low)  # 1 - |now - high| / (high - low)
    result[order[after - 1]], result[order[after]] = 1.0 - upper, upper
    return result
