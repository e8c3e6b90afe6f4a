"""Which clouds are painted on a canvas together, and how small.

A cloud that is seen enlarged loses nothing when it is painted with fewer pixels: a near one whose
billboards' images are, a far one whose picture is. All of one canvas lies beyond one plane, its
guard. What follows on each other in the order of drawing shares a canvas; in it, what is worth a
smaller one is painted on that first.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import ViewData
from weather_ecs.gpu.cloud_guard import depth_of, guard_of
from weather_ecs.gpu.cloud_images import SIZE
from weather_ecs.gpu.cloud_scene import CloudScene
from weather_ecs.gpu.cloud_seen import Seen
from weather_ecs.gpu.cloud_sequence import BILLBOARDS, SOFT, Items
from weather_ecs.gpu.cloud_shown import (
    FACTORS,
    LEAST,
    OPEN,
    SHOWN,
    Floats,
    Rectangle,
    Shown,
    Stretch,
    size_of,
)
from weather_ecs.gpu.cloud_store import CloudStore

SHARP = 2.2  # pixels of the picture that a texel of an image may take before it is enlarged
CRISP = 1.6  # and one of a cloud's picture, which shows finer things
HEAVY = 0.8  # of the picture's pixels: a cloud with billboards over more, one over the other, is
LENIENT = 2.6  # times as blurred as others
DEAR = 2.5  # what a pixel of billboards costs over one of pictures
MOST = 6  # canvases in a draw
SPARE = 1.02  # of a cloud's box
MIDST = 0.6  # of a cloud's reach: as near it counts at least


class Group(NamedTuple):
    """Items from `first` to before `last`, in the order of drawing."""

    first: int
    last: int
    factor: int
    depth: tuple[float, float, float]  # of the guard: by x, by y, and in the middle; -1 to 1
    rectangle: Rectangle
    beyond: bool  # what stands among the clouds
    inner: tuple[Group, ...] = ()  # of the same guard, which are shown on this one's canvas


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
    which, kinds = drawn[some], items.kinds[some]
    bills = (kinds == BILLBOARDS) | (kinds == SOFT)
    enlarged = _enlarged(scene, store, which, bills, tiles[some])
    enlarged[bills & (seen.area[some] > HEAVY * seen.whole)] *= LENIENT
    area = seen.area[some] / seen.whole
    cost = area * np.where(bills, DEAR, 1.0)
    shown = Shown(enlarged, area, cost, seen.low[some], seen.high[some])
    center, half = scene.center[which], SPARE * scene.half[which]
    # Billboards that lie level hang lower than what they stand for.
    lowest = np.where(bills, -np.inf, scene.lowest[which])
    beyond = scene.away[which] > parted
    for side in (True, False):
        for begin, end in _true(beyond == side):
            for first, last in shown.stretches(begin, end, FACTORS[-1], LEAST / OPEN):
                while first < last and OPEN * shown.cost(first, last) > LEAST:
                    held, plane = guard_of(*(part[first:last] for part in (center, half, lowest)))
                    if held:
                        groups = _groups_of(shown, first, first + held)
                        depth = depth_of(view, plane)
                        found += [_put(each, some, depth, side) for each in groups]
                    first += max(held, 1)
    return sorted(found)[:MOST]


def _groups_of(shown: Shown, first: int, last: int) -> list[Group]:
    """One for all, with others in it, or some, as it is worth; their guard is left open."""
    factor = shown.factor(first, last)
    apart, parts = shown.worth(first, last, 1)
    if factor > 1:
        cost, rectangle = shown.cost(first, last), shown.rectangle(first, last)
        inside, inner = shown.worth(first, last, factor)
        together = cost * (OPEN - factor**-2) + inside - SHOWN * OPEN * size_of(rectangle)
        if together > max(apart, LEAST):
            return [_group(shown, first, last, factor, inner)]
    return [_group(shown, *part) for part in parts]


def _group(
    shown: Shown, first: int, last: int, factor: int, inner: list[Stretch] | None = None
) -> Group:
    parts = tuple(_group(shown, *part) for part in (inner or ())[:MOST])
    rectangle = shown.rectangle(first, last)
    return Group(first, last, factor, (0.0, 0.0, 0.0), rectangle, True, parts)


def _put(
    group: Group, some: NDArray[np.intp], depth: tuple[float, float, float], beyond: bool
) -> Group:
    """Among all items, where `some` are those that show; behind its guard, and with all in it."""
    inner = tuple(_put(each, some, depth, beyond) for each in group.inner)
    first, last = int(some[group.first]), int(some[group.last - 1]) + 1
    return Group(first, last, group.factor, depth, group.rectangle, beyond, inner)


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
