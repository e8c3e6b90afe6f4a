"""Meshes as rain meets them, on the CPU: their highest surface along the mean fall.

Points and surfaces are carried along the fall to the height 0 (see `physics.footprint`): there a
surface keeps the rain off whatever lies at the same place (u, w) and lower. A mesh is cut into
pieces; few triangles are kept as they are, many are drawn into a raster that names, for every
cell, the highest triangle at its middle.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

FEW = 12  # triangles that are quicker tested one by one than drawn into a raster
LONGEST = 24.0  # m, of a piece that is drawn into a raster
CELLS = 96  # of a raster along its longer side
FINEST = 0.05  # m
STEEP = 0.5  # rise of the normal below which a triangle is a wall and no ground
THINNEST = 1e-4  # share of a triangle's area that it must show to the rain
_PAIRS = 400_000  # of triangle and cell that are looked at together


@dataclass(frozen=True, slots=True, eq=False)
class Piece:
    """Some triangles of a mesh, in the mesh's own axes."""

    corners: NDArray[np.float64]  # (t, 3, 3)
    middle: NDArray[np.float64]  # (3,) of the bounding box
    half: NDArray[np.float64]  # (3,)


def pieces(vertices: NDArray, indices: NDArray, scale: float = 1.0) -> list[Piece]:
    """A mesh, cut so that no piece of many triangles is longer than LONGEST / `scale`."""
    corners = vertices[indices.reshape(-1, 3)].astype(np.float64)
    found: list[Piece] = []
    open_parts = [corners]
    while open_parts:
        part = open_parts.pop()
        low, high = part.min(axis=(0, 1)), part.max(axis=(0, 1))
        if len(part) > FEW and float((high - low).max()) * scale > LONGEST:
            middles = part.mean(axis=1)
            axis = int(np.argmax(np.ptp(middles, axis=0)))
            order = np.argsort(middles[:, axis], kind="stable")
            cut = len(part) // 2
            open_parts += [part[order[cut:]], part[order[:cut]]]
        else:
            found.append(Piece(part, (low + high) * 0.5, (high - low) * 0.5))
    return found


class Facets:
    """A piece under one turn and one fall, ready to be asked; its place is the asker's affair.

    Walls count as `raised` m higher than they are: who asks above so much of a margin, because
    ground may be coarse, is told of walls from the point on.
    """

    __slots__ = ("_arrays", "_cell", "_columns", "_inside", "_low", "_planes", "_rows", "_top")

    def __init__(
        self, piece: Piece, turn: NDArray, slope: tuple[float, float], raised: float = 0.0
    ) -> None:
        corners = piece.corners @ turn.T
        heights = corners[:, :, 1]
        places = corners[:, :, [0, 2]] + heights[:, :, None] * np.asarray(slope)
        one, two = places[:, 1] - places[:, 0], places[:, 2] - places[:, 0]
        shown = one[:, 0] * two[:, 1] - one[:, 1] * two[:, 0]
        normals = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
        size = np.linalg.norm(normals, axis=1)
        steep = np.abs(normals[:, 1]) < STEEP * size
        heights = heights + np.where(steep, raised, 0.0)[:, None]
        seen = np.abs(shown) > THINNEST * size
        seen &= size > 0.0
        places, heights = places[seen], heights[seen]
        planes = _planes(places, heights, one[seen], two[seen], shown[seen])
        limits = np.stack([heights.min(axis=1), heights.max(axis=1)], axis=1)
        self._planes: list[list[float]] = np.hstack([planes, limits]).tolist()
        self._inside: list[list[float]] | None = None
        self._arrays: tuple[NDArray, NDArray] | None = None  # as `many` has them
        if len(places) <= FEW:
            edges = _edges(places, shown[seen])
            self._inside = np.hstack([edges, planes, limits]).tolist()
            return
        low, high = places.min(axis=(0, 1)), places.max(axis=(0, 1))
        self._cell = max(float((high - low).max()) / CELLS, FINEST)
        self._low = (float(low[0]), float(low[1]))
        self._columns, self._rows = (int(n) + 1 for n in (high - low) / self._cell)
        table = _raster(places, planes, shown[seen], low, self._cell, self._columns, self._rows)
        small = table.astype(np.int16 if len(places) < 2**15 else np.int32)
        self._top = memoryview(small.data)

    def cover(self, u: float, w: float, level: float) -> bool:
        """Whether a surface stands above `level` at a place; both relative to the piece's own."""
        if self._inside is not None:
            for a, b, c, d, e, f, g, h, i, p, q, r, low, high in self._inside:
                if (
                    high > level
                    and a * u + b * w + c >= 0.0
                    and d * u + e * w + f >= 0.0
                    and g * u + h * w + i >= 0.0
                    and (low > level or p * u + q * w + r > level)
                ):
                    return True
            return False
        du, dw = u - self._low[0], w - self._low[1]
        column, row = int(du / self._cell), int(dw / self._cell)
        if du < 0.0 or dw < 0.0 or column >= self._columns or row >= self._rows:
            return False
        top = self._top[row * self._columns + column]
        if top < 0:
            return False
        p, q, r, low, high = self._planes[top]
        # Beyond its edge, by half a cell at most, a steep triangle is not carried on.
        return low > level or (high > level and p * u + q * w + r > level)

    def many(self, u: NDArray, w: NDArray, level: NDArray) -> NDArray[np.bool_]:
        """`cover` for many places (n,)."""
        if self._inside is not None:
            found = np.zeros(len(u), bool)
            for a, b, c, d, e, f, g, h, i, p, q, r, low, high in self._inside:
                inside = (high > level) & (a * u + b * w + c >= 0.0) & (d * u + e * w + f >= 0.0)
                inside &= g * u + h * w + i >= 0.0
                found |= inside & ((low > level) | (p * u + q * w + r > level))
            return found
        if self._arrays is None:
            self._arrays = np.asarray(self._top), np.array(self._planes)
        table, planes = self._arrays
        column = ((u - self._low[0]) / self._cell).astype(np.int64)
        row = ((w - self._low[1]) / self._cell).astype(np.int64)
        here = (u >= self._low[0]) & (w >= self._low[1])
        here &= (column < self._columns) & (row < self._rows)
        top = table[np.where(here, row * self._columns + column, 0)]
        p, q, r, low, high = planes[top].T
        above = (low > level) | ((high > level) & (p * u + q * w + r > level))
        return np.asarray(here & (top >= 0) & above)


def _planes(
    places: NDArray, heights: NDArray, one: NDArray, two: NDArray, shown: NDArray
) -> NDArray[np.float64]:
    """(t, 3): height = p u + q w + r over each triangle."""
    h1, h2 = heights[:, 1] - heights[:, 0], heights[:, 2] - heights[:, 0]
    p = (h1 * two[:, 1] - h2 * one[:, 1]) / shown
    q = (h2 * one[:, 0] - h1 * two[:, 0]) / shown
    r = heights[:, 0] - p * places[:, 0, 0] - q * places[:, 0, 1]
    return np.stack([p, q, r], axis=1)


def _edges(places: NDArray, shown: NDArray) -> NDArray[np.float64]:
    """(t, 9): three half planes a u + b w + c >= 0 whose common part is each triangle."""
    columns = []
    turn = np.where(shown > 0.0, 1.0, -1.0)
    for k in range(3):
        here, there = places[:, k], places[:, (k + 1) % 3]
        a = (here[:, 1] - there[:, 1]) * turn
        b = (there[:, 0] - here[:, 0]) * turn
        # A seam between two triangles belongs to both.
        slack = 1e-9 * (np.abs(a) + np.abs(b))
        columns += [a, b, -a * here[:, 0] - b * here[:, 1] + slack]
    return np.stack(columns, axis=1)


def _raster(
    places: NDArray,
    planes: NDArray,
    shown: NDArray,
    low: NDArray,
    cell: float,
    columns: int,
    rows: int,
) -> NDArray[np.int32]:
    """(rows columns,): number of the triangle that is highest at each cell's middle, or -1."""
    table = np.full(rows * columns, -1, np.int32)
    best = np.full(rows * columns, -np.inf)
    edges = _edges(places, shown)
    first = np.floor((places.min(axis=1) - low) / cell).astype(np.int64)
    last = np.floor((places.max(axis=1) - low) / cell).astype(np.int64)
    wide = last - first + 1
    counts = wide[:, 0] * wide[:, 1]
    ends = np.cumsum(counts)
    start = 0
    while start < len(places):
        done = int(ends[start - 1]) if start else 0
        stop = max(int(np.searchsorted(ends, done + _PAIRS, side="right")), start + 1)
        number = np.repeat(np.arange(start, stop), counts[start:stop])
        nth = np.arange(len(number)) - (ends[number] - counts[number] - done)
        i = first[number, 0] + nth % wide[number, 0]
        j = first[number, 1] + nth // wide[number, 0]
        u, w = low[0] + (i + 0.5) * cell, low[1] + (j + 0.5) * cell
        e = edges[number]
        inside = (
            (e[:, 0] * u + e[:, 1] * w + e[:, 2] >= 0.0)
            & (e[:, 3] * u + e[:, 4] * w + e[:, 5] >= 0.0)
            & (e[:, 6] * u + e[:, 7] * w + e[:, 8] >= 0.0)
        )
        number, u, w = number[inside], u[inside], w[inside]
        at = (j * columns + i)[inside]
        plane = planes[number]
        height = plane[:, 0] * u + plane[:, 1] * w + plane[:, 2]
        order = np.argsort(height, kind="stable")  # the last written, the highest, stays
        at, number, height = at[order], number[order], height[order]
        higher = height > best[at]
        table[at[higher]] = number[higher]
        best[at[higher]] = height[higher]
        start = stop
    return table
