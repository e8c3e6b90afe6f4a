"""`BoxGrid`: boxes on the ground with a top, found by place for one point or for many at once."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

FINEST = 4.0  # m, cell of the finest grid; every coarser one is twice as wide
_OVER_FINEST = 1.0 / FINEST
_KEPT = 16384  # cells of the finest grid whose boxes are remembered
_OFFSET = 1 << 28  # makes cell numbers positive

Place = tuple[int, int]
Near = tuple[float, float, float, float, float, int]  # top, u, u, w, w, number of the box


class BoxGrid:
    """Boxes in grids of several cell sizes, each where it lies in four cells at most.

    `low`, `high`: their corners (n, 2) on the ground in m; `top` (n,): how high they reach.
    """

    def __init__(self, low: NDArray, high: NDArray, top: NDArray) -> None:
        self._columns = (top, low[:, 0], high[:, 0], low[:, 1], high[:, 1])
        self._boxes = np.stack(self._columns, axis=1).tolist()
        size = np.maximum((high - low).max(axis=1, initial=0.0), FINEST)
        level = np.ceil(np.log2(size / FINEST)).astype(np.int64)
        over_cell = _OVER_FINEST * 0.5**level
        first = np.floor(low * over_cell[:, None]).astype(np.int64) + _OFFSET
        last = np.floor(high * over_cell[:, None]).astype(np.int64) + _OFFSET
        keys, members = [], []
        for i, also_i in ((first[:, 0], None), (last[:, 0], first[:, 0] < last[:, 0])):
            for j, also_j in ((first[:, 1], None), (last[:, 1], first[:, 1] < last[:, 1])):
                entered = np.ones(len(low), bool)
                for also in (also_i, also_j):
                    if also is not None:
                        entered &= also
                keys.append(((level << 58) | (i << 29) | j)[entered])
                members.append(np.flatnonzero(entered))
        key, member = np.concatenate(keys), np.concatenate(members)
        order = np.argsort(key, kind="stable")
        key, self._members = key[order], member[order]
        self._starts = np.flatnonzero(np.diff(key, prepend=-1))
        self._ends = np.append(self._starts[1:], len(key))
        self._keys = key[self._starts]
        self._cells = dict(zip(self._keys.tolist(), range(len(self._keys)), strict=True))
        self._levels: list[int] = np.flatnonzero(np.bincount(level)).tolist()
        self.known: dict[Place, list[Near]] = {}  # what `near` has found, by `place`

    def near(self, place: Place) -> list[Near]:
        """The boxes that reach into a cell of the finest grid, the highest first."""
        found = self.known.get(place)
        if found is not None:
            return found
        if len(self.known) > _KEPT:
            self.known.clear()
        (i, j), found = place, []
        for e in self._levels:
            cell = self._cells.get((e << 58) | (((i >> e) + _OFFSET) << 29) | ((j >> e) + _OFFSET))
            if cell is None:
                continue
            for k in self._members[self._starts[cell] : self._ends[cell]].tolist():
                top, u0, u1, w0, w1 = self._boxes[k]
                across = u1 >= i * FINEST and u0 <= (i + 1) * FINEST
                if across and w1 >= j * FINEST and w0 <= (j + 1) * FINEST:
                    found.append((top, u0, u1, w0, w1, k))
        found.sort(key=lambda box: (-box[0], box[5]))
        self.known[place] = found
        return found

    def pairs(self, u: NDArray, w: NDArray, level: NDArray) -> list[tuple[int, NDArray[np.int64]]]:
        """Every box that lies over any of the places (n,) above its level, and those places."""
        places, boxes = [], []
        first_i = np.floor(u * _OVER_FINEST).astype(np.int64)
        first_j = np.floor(w * _OVER_FINEST).astype(np.int64)
        tops, u0, u1, w0, w1 = self._columns
        for e in self._levels if len(u) else ():
            i, j = (first_i >> e) + _OFFSET, (first_j >> e) + _OFFSET
            key = (e << 58) | (i << 29) | j
            cell = np.minimum(np.searchsorted(self._keys, key), len(self._keys) - 1)
            there = np.flatnonzero(self._keys[cell] == key)
            cell = cell[there]
            counts = self._ends[cell] - self._starts[cell]
            place = np.repeat(there, counts)
            nth = np.arange(len(place)) - np.repeat(np.cumsum(counts) - counts, counts)
            box = self._members[np.repeat(self._starts[cell], counts) + nth]
            at = u[place]
            over = np.flatnonzero((u0[box] <= at) & (at <= u1[box]))
            place, box = place[over], box[over]
            at = w[place]
            over = np.flatnonzero((w0[box] <= at) & (at <= w1[box]) & (tops[box] > level[place]))
            places.append(place[over])
            boxes.append(box[over])
        if not any(map(len, boxes)):
            return []
        place, box = np.concatenate(places), np.concatenate(boxes)
        order = np.argsort(box, kind="stable")
        place, box = place[order], box[order]
        first = np.flatnonzero(np.diff(box, prepend=-1))
        return list(zip(box[first].tolist(), np.split(place, first[1:]), strict=True))
