"""Input checks that the physics share: floats inside a range, or an error that says so."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from weather_ecs.errors import InvalidValueError

FloatArray = NDArray[np.float64]
LARGEST = float(np.finfo(np.float64).max)


def floats(
    field: str, value: ArrayLike, low: float = -LARGEST, high: float = LARGEST
) -> FloatArray:
    """`value` as float64, every element in [low, high]; infinity passes only where a bound is one.

    Raises InvalidValueError, also for NaN and for what is not a number.
    """
    try:
        array = np.asarray(value, dtype=np.float64)
    except (TypeError, ValueError):
        raise InvalidValueError(field, value, "numbers") from None
    if not np.all((array >= low) & (array <= high)):
        raise InvalidValueError(field, value, span(low, high))
    return array


def number(
    field: str, value: Any, low: float = -LARGEST, high: float = LARGEST, above: bool = False
) -> float:
    """`value` as one float in [low, high], or in (low, high] with `above`."""
    try:
        result = float(value)
    except (TypeError, ValueError):
        raise InvalidValueError(field, value, "a number") from None
    if not low <= result <= high or (above and result == low):
        raise InvalidValueError(field, value, span(low, high, above))
    return result


def count(field: str, value: Any) -> int:
    """`value` as a number of things: an integer, 0 or more."""
    if isinstance(value, bool) or not isinstance(value, (int, np.integer)) or value < 0:
        raise InvalidValueError(field, value, "an integer, 0 or more")
    return int(value)


def span(low: float, high: float, above: bool = False) -> str:
    """The range in words."""
    words = []
    if low > -LARGEST:
        words.append(f"above {low:g}" if above else f"at least {low:g}")
    if high < LARGEST:
        words.append(f"at most {high:g}")
    if np.isinf(low) or np.isinf(high):
        return ", ".join([*words, "not NaN"])
    return ", ".join(["finite", *words])
