"""Chance without a state: the same words always give the same number, in any order.

The mixing function is the finaliser of SplitMix64 (Steele, Lea and Flood 2014).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_MASK = (1 << 64) - 1
_GOLDEN = 0x9E3779B97F4A7C15
_FIRST = 0xBF58476D1CE4E5B9
_SECOND = 0x94D049BB133111EB
_UNIT = 2.0**-53


def scramble(*words: int) -> int:
    """64 bits that look random, of any number of whole numbers."""
    value = 0
    for word in words:
        value = (value + _GOLDEN + (word & _MASK)) & _MASK
        value = ((value ^ (value >> 30)) * _FIRST) & _MASK
        value = ((value ^ (value >> 27)) * _SECOND) & _MASK
        value ^= value >> 31
    return value


def uniform(*words: int) -> float:
    """In [0, 1), of any number of whole numbers."""
    return (scramble(*words) >> 11) * _UNIT


def uniforms(numbers: NDArray, *words: int) -> NDArray:
    """`uniform(*words, n)` of each n in an array (n,) of whole numbers >= 0; (n,) float64."""
    value = np.full(len(numbers), scramble(*words), np.uint64)
    value += np.uint64(_GOLDEN) + numbers.astype(np.uint64)
    value = (value ^ (value >> np.uint64(30))) * np.uint64(_FIRST)
    value = (value ^ (value >> np.uint64(27))) * np.uint64(_SECOND)
    value ^= value >> np.uint64(31)
    return (value >> np.uint64(11)).astype(np.float64) * _UNIT
