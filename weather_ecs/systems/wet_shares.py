"""How much of an area's rain falls on which cells while it passes over them.

The area's pattern on cells of its own is made once. Where the area moves, the moments of its way
are laid on the grid, each shared among the four cells round its centre, and the pattern is added
up over that trace: the swept rain of any way costs a few additions of the pattern.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from weather_ecs.physics.rain_field import area_shares

SIDE = 8  # cells on a side of a tile
MOST_MOMENTS = 256
SPACING = 0.35  # of the soft edge between two moments, or a cell

Place = tuple[int, int]


class Shape(NamedTuple):
    """An area but for its place and rate."""

    radii: tuple[float, float]
    heading: float
    edge: float


class Fallen(NamedTuple):
    """Rain on tiles: (i, j) of each, and (n, 8, 8) of amounts, rows along z."""

    places: list[Place]
    amounts: NDArray[np.float64]


class Patterns:
    """Patterns of the areas of a level, kept as long as they are in use."""

    def __init__(self, cell: float) -> None:
        self._cell = cell
        self._known: dict[tuple, NDArray[np.float64]] = {}
        self._used: dict[tuple, NDArray[np.float64]] = {}
        self._still: dict[tuple, Fallen] = {}
        self._still_used: dict[tuple, Fallen] = {}

    def next_round(self) -> None:
        """Forget what was not used since the last call."""
        self._known, self._used = self._used, {}
        self._still, self._still_used = self._still_used, {}

    def standing(self, center: tuple[float, float], shape: Shape) -> Fallen:
        """Shares of the rain of an area that stands."""
        name = (center, shape)
        found = self._still_used.get(name) or self._still.get(name)
        if found is None:
            low, block = self._block(shape, center)
            found = _on_tiles(low, block)
        self._still_used[name] = found
        return found

    def swept(self, shape: Shape, points: NDArray, weights: NDArray) -> Fallen:
        """The weighted sum of the shares of an area at points (m, 2) of its way."""
        block = self._used.get(shape)
        if block is None:
            block = self._known.get(shape)
            if block is None:
                block = self._block(shape, (0.5 * self._cell, 0.5 * self._cell))[1]
            self._used[shape] = block
        low, trace = _trace(points / self._cell - 0.5, weights)
        deep, wide = block.shape
        total = np.zeros((deep + trace.shape[0] - 1, wide + trace.shape[1] - 1))
        term = np.empty_like(block)
        rows, across = np.nonzero(trace)
        values = trace[rows, across].tolist()
        for j, i, value in zip(rows.tolist(), across.tolist(), values, strict=True):
            np.multiply(block, value, out=term)
            total[j : j + deep, i : i + wide] += term
        return _on_tiles((low[0] - wide // 2, low[1] - deep // 2), total)

    def _block(
        self, shape: Shape, center: tuple[float, float]
    ) -> tuple[Place, NDArray[np.float64]]:
        """Shares on the cells round a centre, and the first of them; the middle one holds it."""
        cell, (a, b) = self._cell, shape.radii
        c, s = math.cos(shape.heading), math.sin(shape.heading)
        half = [math.ceil(math.hypot(*e) / cell) for e in ((a * c, b * s), (a * s, b * c))]
        middle = [math.floor(value / cell) for value in center]
        low = middle[0] - half[0], middle[1] - half[1]
        x = (np.arange(2 * half[0] + 1) + (low[0] + 0.5)) * cell
        z = (np.arange(2 * half[1] + 1) + (low[1] + 0.5)) * cell
        return low, area_shares(x, z[:, None], center, shape.radii, shape.heading, shape.edge)


def moments(way: float, cell: float, edge: float) -> int:
    """How many moments stand for a way of so many metres."""
    return min(max(math.ceil(way / max(cell, SPACING * edge)), 1), MOST_MOMENTS)


def _trace(at: NDArray, weights: NDArray) -> tuple[Place, NDArray[np.float64]]:
    """Weights at places (m, 2) in cells, shared among the cells round them; its first cell."""
    first = np.floor(at).astype(np.int64)
    part = at - first
    low = first.min(axis=0)
    wide, deep = (first.max(axis=0) - low + 2).tolist()
    index = (first[:, 1] - low[1]) * wide + first[:, 0] - low[0]
    u, w = part[:, 0], part[:, 1]
    places = np.concatenate([index, index + 1, index + wide, index + wide + 1])
    shares = [(1 - u) * (1 - w), u * (1 - w), (1 - u) * w, u * w]
    shared = np.concatenate(shares) * np.tile(weights, 4)
    total = np.bincount(places, shared, wide * deep).astype(np.float64)
    return (int(low[0]), int(low[1])), np.asarray(total).reshape(deep, wide)


def _on_tiles(low: Place, block: NDArray[np.float64]) -> Fallen:
    """A block of cells whose first one is `low`, cut into tiles; dry ones are left out."""
    deep, wide = block.shape
    first, left, top = (low[0] >> 3, low[1] >> 3), low[0] & 7, low[1] & 7
    across, along = (left + wide + 7) >> 3, (top + deep + 7) >> 3
    sheet = np.zeros((along * SIDE, across * SIDE))
    sheet[top : top + deep, left : left + wide] = block
    tiles = sheet.reshape(along, SIDE, across, SIDE).swapaxes(1, 2)
    wet = tiles.any(axis=(2, 3))
    rows, columns = np.nonzero(wet)
    places = zip((columns + first[0]).tolist(), (rows + first[1]).tolist(), strict=True)
    return Fallen(list(places), tiles[wet])
