"""The clouds of a view in their order, and which stretches of them bear being painted small."""

from __future__ import annotations

from bisect import bisect_left
from collections.abc import Iterator
from itertools import pairwise
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

FACTORS = (5, 4, 3, 2)  # pixels of the picture on a side of one of the canvas
MINOR, CROWDED = 0.1, 2.0  # of what is seen of a canvas, that may be twice as blurred; at most so
SLIGHT = 0.2  # of such, that counts however little it is
OPEN = 0.5  # of the picture, that the scene may be taken to leave free
SHOWN = 0.5  # what a pixel of a canvas costs when it is shown, over one of a cloud
LEAST = 0.08  # of the picture's pixels, that a canvas must save

Floats = NDArray[np.float64]
Rectangle = tuple[float, float, float, float]  # left, low, right, high, -1 to 1
Stretch = tuple[int, int, int]  # from one to before the other, and a factor


class _Bearing(NamedTuple):
    """How all bear one factor: what of each is lost by it; sums are of those before, (n + 1,)."""

    lost: Floats  # area, the more the sharper it is; infinite where it is too much
    some: NDArray[np.intp]  # where some is lost and not too much, the least first
    good: NDArray[np.bool_]  # where nothing is
    places: list[int]  # of these
    sums: list[float]  # of what is lost where that is not too much
    torn: list[int]  # number of those of which too much is


class Shown:
    """What there is to draw, (n,) each in its order, areas in pictures.

    enlarged: pixels on a side of a texel that counts; cost: of drawing it; low, high: (n, 2) of
    the rectangle it is seen in, -1 to 1.
    """

    def __init__(self, enlarged: Floats, area: Floats, cost: Floats, low: Floats, high: Floats):
        self._enlarged, self._area = enlarged, area
        self._areas, self._costs = _sums(area), _sums(cost)
        self._bounds = np.ascontiguousarray(np.concatenate([low.T, -high.T]))
        self._bearings: dict[int, _Bearing] = {}
        self._found: dict[Stretch, list[tuple[int, int]]] = {}

    def cost(self, first: int, last: int) -> float:
        """Of all from `first` to before `last`."""
        return self._costs[last] - self._costs[first]

    def rectangle(self, first: int, last: int) -> Rectangle:
        left, low, right, high = np.minimum.reduce(self._bounds[:, first:last], axis=1).tolist()
        return left, low, -right, -high

    def factor(self, first: int, last: int) -> int:
        """The largest factor that all from `first` to before `last` bear; 1: none."""
        most = MINOR * self._seen(first, last)
        for factor in FACTORS:
            bearing = self._bearing(factor)
            torn = bearing.torn[last] - bearing.torn[first]
            if not torn and bearing.sums[last] - bearing.sums[first] <= most:
                return factor
        return 1

    def stretches(
        self, first: int, last: int, factor: int, least: float
    ) -> Iterator[tuple[int, int]]:
        """Long ones that bear a factor and cost so much; what is too sharp for it is at no end."""
        if self.cost(first, last) <= least:
            return
        bearing = self._bearing(factor)
        for begin, end in self._within(first, last, factor):
            if self.cost(begin, end) <= least:
                continue
            # From the first to the last of which nothing is lost.
            one = bisect_left(bearing.places, begin)
            other = bisect_left(bearing.places, end)
            if one == other:
                continue
            places = bearing.places[one:other]
            begin, end = places[0], places[-1] + 1
            if bearing.sums[end] - bearing.sums[begin] <= MINOR * self._seen(begin, end):
                yield begin, end
                continue
            for begin, end in _neighbours(places):
                if self.cost(begin, end) > least:
                    yield begin, end

    def worth(self, first: int, last: int, base: int) -> tuple[float, list[Stretch]]:
        """What canvases save at a base of so many pixels, in pictures, and which they are."""
        rate = OPEN if base == 1 else base**-2
        saved, found = 0.0, list[Stretch]()
        for factor in FACTORS[: -1 if base == 1 else FACTORS.index(base)]:
            for begin, end in self.stretches(first, last, factor, LEAST / rate):
                if any(begin < other and one < end for one, other, _ in found):
                    continue
                shown = SHOWN * size_of(self.rectangle(begin, end))
                won = self.cost(begin, end) * (rate - factor**-2) - shown * rate
                if won > LEAST:
                    saved += won
                    found.append((begin, end, factor))
        return saved, sorted(found)

    def _seen(self, first: int, last: int) -> float:
        """How much of the picture shows them."""
        area = self._areas[last] - self._areas[first]
        return min(area, size_of(self.rectangle(first, last)))

    def _within(self, first: int, last: int, factor: int) -> list[tuple[int, int]]:
        """Where neighbours bear a factor, taking those of which most is lost away."""
        key = first, last, factor
        known = self._found.get(key)
        if known is not None:
            return known
        bearing = self._bearing(factor)
        mask = np.zeros(last - first + 2, bool)
        mask[1:-1] = bearing.good[first:last]
        some = bearing.some[(bearing.some >= first) & (bearing.some < last)]
        if len(some):
            most = MINOR * self._seen(first, last)
            count = np.searchsorted(np.cumsum(bearing.lost[some]), most, side="right")
            mask[some[:count] - (first - 1)] = True
        edges = (np.flatnonzero(mask[1:] != mask[:-1]) + first).tolist()
        found = self._found[key] = list(zip(edges[::2], edges[1::2], strict=True))
        return found

    def _bearing(self, factor: int) -> _Bearing:
        known = self._bearings.get(factor)
        if known is None:
            over = factor / self._enlarged - 1.0
            lost = self._area * np.where(over > 0.0, over + SLIGHT, 0.0)
            torn = over > CROWDED - 1.0
            lost[torn] = np.inf
            some = np.flatnonzero((lost > 0.0) & ~torn)
            some = some[np.argsort(lost[some], kind="stable")]
            good = lost == 0.0
            sums, numbers = _sums(np.where(torn, 0.0, lost)), [0, *np.cumsum(torn).tolist()]
            places = np.flatnonzero(good).tolist()
            known = self._bearings[factor] = _Bearing(lost, some, good, places, sums, numbers)
        return known


def size_of(rectangle: Rectangle) -> float:
    """In pictures."""
    left, low, right, high = rectangle
    return 0.25 * (right - left) * (high - low)


def _sums(values: Floats) -> list[float]:
    return [0.0, *np.cumsum(values).tolist()]


def _neighbours(places: list[int]) -> Iterator[tuple[int, int]]:
    """From where to before where numbers, which rise, follow on each other."""
    begin = places[0]
    for one, other in pairwise([*places, places[-1] + 2]):
        if other > one + 1:
            yield begin, one + 1
            begin = other
