"""Vectors, (..., 3), where numpy's own functions take longest over few of them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

_NEXT, _LAST = np.array([1, 2, 0]), np.array([2, 0, 1])


def cross(a: NDArray, b: NDArray) -> NDArray[np.float64]:
    """The same numbers as np.cross, (..., 3), in a fraction of its time."""
    found: NDArray[np.float64] = a.take(_NEXT, -1) * b.take(_LAST, -1)
    found -= a.take(_LAST, -1) * b.take(_NEXT, -1)
    return found
