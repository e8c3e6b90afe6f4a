"""Which clouds are painted on a canvas together, and how small.

A cloud that is seen enlarged loses nothing when it is painted with fewer pixels: a near one whose
billboards' images are, a far one whose picture is. All of one canvas lies beyond one plane, its
guard. What follows on each other in the order of drawing shares a canvas; in it, what is worth a
smaller one is painted on that first.
"""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import ViewData
from weather_ecs.gpu.cloud_guard import depth_of, guard_of
from weather_ecs.gpu.cloud_images import SIZE
from weather_ecs.gpu.cloud_scene import CloudScene
from weather_ecs.gpu.cloud_seen import Seen
from weather_ecs.gpu.cloud_sequence import BILLBOARDS, SOFT, Items
from weather_ecs.gpu.cloud_store import CloudStore

FACTORS = (5, 4, 3, 2)  # pixels of the picture on a side of one of the canvas
SHARP = 2.2  # pixels of the picture that a texel of an image may take before it is enlarged
CRISP = 1.6  # and one of a cloud's picture, which shows finer things
HEAVY = 0.8  # of the picture's pixels: a cloud with billboards over more, one over the other, is
LENIENT = 2.6  # times as blurred as others
MINOR, CROWDED = 0.1, 2.0  # of what is seen of a canvas, that may be twice as blurred; at most so
SLIGHT = 0.2  # of such, that counts however little it is
DEAR = 2.5  # what a pixel of billboards costs over one of pictures
OPEN = 0.5  # of the picture, that the scene may be taken to leave free
SHOWN = 0.5  # what a pixel of a canvas costs when it is shown, over one of a cloud
LEAST = 0.08  # of the picture's pixels, that a canvas must save
MOST = 6  # canvases in a draw
SPARE = 1.02  # of a cloud's box
MIDST = 0.6  # of a cloud's reach: as near it counts at least

Floats = NDArray[np.float64]
Rectangle = tuple[float, float, float, float]  # left, low, right, high, -1 to 1
Stretch = tuple[int, int, int]  # from one to before the other, and a factor


class Group(NamedTuple):
    """Items from `first` to before `last`, in the order of drawing."""

    first: int
    last: int
    factor: int
    depth: tuple[float, float, float]  # of the guard: by x, by y, and in the middle; -1 to 1
    rectangle: Rectangle
    beyond: bool  # what stands among the clouds
    inner: tuple[Group, ...] = ()  # of the same guard, which are shown on this one's canvas


@dataclass(slots=True)
class _Shown:
    """What there is to draw, (n,) each in its order, areas in pictures."""

    item: NDArray[np.intp]
    enlarged: Floats
    area: Floats
    cost: Floats  # of it
    low: Floats  # (n, 2)
    high: Floats

    def factor(self, first: int, last: int) -> int:
        """The largest factor that all from `first` to before `last` bear; 1: none."""
        for factor in FACTORS:
            lost = self._lost(first, last, factor)
            if not np.isinf(lost).any() and lost.sum() <= MINOR * self._seen(first, last):
                return factor
        return 1

    def _lost(self, first: int, last: int, factor: int) -> Floats:
        """Of each that is too sharp for a factor, the area, the more the sharper it is."""
        over = factor / self.enlarged[first:last] - 1.0
        lost: Floats = self.area[first:last] * np.where(over > 0.0, over + SLIGHT, 0.0)
        lost[over > CROWDED - 1.0] = np.inf
        return lost

    def rectangle(self, first: int, last: int) -> Rectangle:
        low, high = self.low[first:last].min(axis=0), self.high[first:last].max(axis=0)
        return float(low[0]), float(low[1]), float(high[0]), float(high[1])

    def _seen(self, first: int, last: int) -> float:
        """How much of the picture shows them."""
        return min(float(self.area[first:last].sum()), _size(self.rectangle(first, last)))

    def stretches(
        self, first: int, last: int, factor: int, least: float
    ) -> Iterator[tuple[int, int]]:
        """Long ones that bear a factor and cost so much; what is too sharp for it is at no end."""
        if self.cost[first:last].sum() <= least:
            return
        lost = self._lost(first, last, factor)
        order = np.argsort(lost)
        within = np.empty(len(lost), bool)
        within[order] = np.cumsum(lost[order]) <= MINOR * self._seen(first, last)
        for begin, end in _true(within):
            good = np.flatnonzero(lost[begin:end] == 0.0)
            if not len(good) or self.cost[first + begin : first + end].sum() <= least:
                continue
            begin, end = begin + int(good[0]), begin + int(good[-1]) + 1
            if lost[begin:end].sum() <= MINOR * self._seen(first + begin, first + end):
                yield first + begin, first + end
                continue
            for one, other in _true(lost[begin:end] == 0.0):
                if self.cost[first + begin + one : first + begin + other].sum() > least:
                    yield first + begin + one, first + begin + other

    def worth(self, first: int, last: int, base: int) -> tuple[float, list[Stretch]]:
        """What canvases save at a base of so many pixels, in pictures, and which they are."""
        rate = OPEN if base == 1 else base**-2
        saved, found = 0.0, list[Stretch]()
        free = np.ones(last - first, bool)
        for factor in FACTORS[: -1 if base == 1 else FACTORS.index(base)]:
            for begin, end in self.stretches(first, last, factor, LEAST / rate):
                cost = float(self.cost[begin:end].sum())
                if not free[begin - first : end - first].all():
                    continue
                shown = SHOWN * _size(self.rectangle(begin, end))
                won = cost * (rate - factor**-2) - shown * rate
                if won > LEAST:
                    saved += won
                    found.append((begin, end, factor))
                    free[begin - first : end - first] = False
        return saved, sorted(found)


def find_groups(
    view: ViewData, scene: CloudScene, store: CloudStore, drawn: NDArray, items: Items,
    tiles: NDArray, seen: Seen, parted: float,
) -> list[Group]:  # fmt: skip
    """The groups among `items`, which show the clouds `drawn`.

    tiles: heights of their pictures; parted: m from the camera, where something stands that no
    group has clouds on both sides of.
    """
    found: list[Group] = []
    some = np.flatnonzero(items.ends > items.begins)
    if scene.parallel or not len(some):
        return found
    which, bills = drawn[some], np.isin(items.kinds[some], (BILLBOARDS, SOFT))
    enlarged = _enlarged(scene, store, which, bills, tiles[some])
    enlarged[bills & (seen.area[some] > HEAVY * seen.whole)] *= LENIENT
    area = seen.area[some] / seen.whole
    cost = area * np.where(bills, DEAR, 1.0)
    shown = _Shown(some, enlarged, area, cost, seen.low[some], seen.high[some])
    center, half = scene.center[which], SPARE * scene.half[which]
    # Billboards that lie level hang lower than what they stand for.
    lowest = np.where(bills, -np.inf, scene.lowest[which])
    beyond = scene.away[which] > parted
    for side in (True, False):
        for begin, end in _true(beyond == side):
            for first, last in shown.stretches(begin, end, FACTORS[-1], LEAST / OPEN):
                while first < last and OPEN * shown.cost[first:last].sum() > LEAST:
                    held, plane = guard_of(*(part[first:last] for part in (center, half, lowest)))
                    if held:
                        groups = _groups_of(shown, first, first + held)
                        depth = depth_of(view, plane)
                        found += [_put(each, depth, side) for each in groups]
                    first += max(held, 1)
    return sorted(found)[:MOST]


def _groups_of(shown: _Shown, first: int, last: int) -> list[Group]:
    """One for all, with others in it, or some, as it is worth; their guard is left open."""
    factor = shown.factor(first, last)
    apart, parts = shown.worth(first, last, 1)
    if factor > 1:
        cost = float(shown.cost[first:last].sum())
        rectangle = shown.rectangle(first, last)
        inside, inner = shown.worth(first, last, factor)
        together = cost * (OPEN - factor**-2) + inside - SHOWN * OPEN * _size(rectangle)
        if together > max(apart, LEAST):
            return [_group(shown, first, last, factor, inner)]
    return [_group(shown, *part) for part in parts]


def _group(
    shown: _Shown, first: int, last: int, factor: int, inner: list[Stretch] | None = None
) -> Group:
    items, depth = shown.item, (0.0, 0.0, 0.0)
    parts = tuple(_group(shown, *part) for part in (inner or ())[:MOST])
    rectangle = shown.rectangle(first, last)
    return Group(int(items[first]), int(items[last - 1]) + 1, factor, depth, rectangle, True, parts)


def _put(group: Group, depth: tuple[float, float, float], beyond: bool) -> Group:
    """Behind its guard, and with all in it."""
    inner = tuple(_put(each, depth, beyond) for each in group.inner)
    return group._replace(depth=depth, beyond=beyond, inner=inner)


def _size(rectangle: Rectangle) -> float:
    """In pictures."""
    left, low, right, high = rectangle
    return 0.25 * (right - left) * (high - low)


def _true(mask: NDArray[np.bool_]) -> list[tuple[int, int]]:
    """From where to before where it is."""
    edges = np.flatnonzero(np.diff(np.concatenate([[False], mask, [False]]))).tolist()
    return list(zip(edges[::2], edges[1::2], strict=True))


def _enlarged(
    scene: CloudScene, store: CloudStore, which: NDArray, bills: NDArray, tiles: NDArray
) -> Floats:
    """(n,) pixels on a side of a texel that counts."""
    away = np.maximum(scene.away[which], MIDST * scene.reach[which])
    wide = _widths(scene, store, which) * scene.clouds["scale"][which] * (scene.unit / away)
    detail = np.maximum(store.detail[scene.shapes[which]], 0.05)
    pictured = scene.pixels[which] / (detail * np.maximum(tiles, 1))
    return np.where(bills, SHARP * wide / (SIZE * detail), CRISP * pictured)


def _widths(scene: CloudScene, store: CloudStore, which: NDArray) -> Floats:
    """(n,) m, of a billboard, at a scale of 1; from above those of a sheet's top count as well."""
    shapes, above = scene.shapes[which], scene.center[which, 1] < -scene.half[which, 1]
    widths: Floats = np.where(above, store.wide_top[shapes], store.wide[shapes])
    return widths
