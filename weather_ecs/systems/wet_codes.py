"""What a tile's cells add to what their neighbours let one expect: little, which compresses."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

Place = tuple[int, int]


def surprises(places: Sequence[Place], codes: NDArray[Any], planes: int) -> bytes:
    """Of codes (n, 8, 8) of `planes` bytes, rows along z, of tiles (i, j); high bytes first.

    A cell is expected to add to the one before it in x what the one before in z adds to its own;
    across the tiles' borders, too.
    """
    beside = np.zeros((len(places), 9, 9), np.int64)
    beside[:, 1:, 1:] = codes
    rows = {place: k for k, place in enumerate(places)}
    for edge, place in zip(beside, places, strict=True):
        _fill(edge, place, rows, codes)
    values = beside[:, 1:, 1:] - beside[:, 1:, :-1] - beside[:, :-1, 1:] + beside[:, :-1, :-1]
    values = _signed(values, planes)
    # The sign at the low end: small ones have empty high bytes.
    values = np.where(values >= 0, 2 * values, -2 * values - 1)
    shifts = range(8 * (planes - 1), -1, -8)
    return b"".join([(values >> k).astype(np.uint8).tobytes() for k in shifts])


def expected(places: Sequence[Place], raw: NDArray[np.uint8], planes: int) -> NDArray[np.uint32]:
    """The inverse of `surprises`: codes (n, 8, 8). The tiles are in order, each once."""
    numbers = np.zeros(len(places) * 64, np.int64)
    for plane in raw.reshape(planes, -1):
        numbers = numbers << 8 | plane
    values = np.where(numbers & 1, -(numbers >> 1) - 1, numbers >> 1).reshape(-1, 8, 8)
    sums = np.cumsum(np.cumsum(values, axis=1), axis=2)
    codes = np.zeros((len(places), 8, 8), np.uint32)
    rows: dict[Place, int] = {}
    edge = np.zeros((9, 9), np.int64)
    for k, place in enumerate(places):
        edge[:] = 0
        _fill(edge, place, rows, codes)
        codes[k] = (sums[k] + edge[1:, :1] + edge[:1, 1:] - edge[0, 0]) & (1 << 8 * planes) - 1
        rows[place] = k
    return codes


def _fill(edge: NDArray, place: Place, rows: dict[Place, int], codes: NDArray) -> None:
    """Write the last cells of the tiles before one into its (9, 9) cells; dry where none are."""
    i, j = place
    before, above, corner = rows.get((i - 1, j)), rows.get((i, j - 1)), rows.get((i - 1, j - 1))
    if before is not None:
        edge[1:, 0] = codes[before, :, 7]
    if above is not None:
        edge[0, 1:] = codes[above, 7]
    if corner is not None:
        edge[0, 0] = codes[corner, 7, 7]


def _signed(values: NDArray[np.int64], planes: int) -> NDArray[np.int64]:
    """The same modulo 256**planes, about 0."""
    half = 1 << 8 * planes - 1
    return (values + half & 2 * half - 1) - half
