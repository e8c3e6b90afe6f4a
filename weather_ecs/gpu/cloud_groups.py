"""Which clouds are painted on a canvas together, how small, and where in depth that lies.

A cloud so near that its images are enlarged loses nothing when it is painted with fewer pixels.
All of one canvas lies beyond one plane, its guard: what of the scene is before it hides the canvas
sharply, and what is beyond it meets the billboards themselves.
"""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import ViewData
from weather_ecs.gpu.cloud_images import SIZE
from weather_ecs.gpu.cloud_scene import CloudScene
from weather_ecs.gpu.cloud_seen import Seen
from weather_ecs.gpu.cloud_sequence import BILLBOARDS, SOFT, Items
from weather_ecs.gpu.cloud_store import CloudStore

FACTORS = (5, 4, 3, 2)  # pixels of the picture on a side of one of the canvas
SHARP = 2.2  # pixels of the picture that a texel may take before it counts as enlarged
HEAVY = 0.8  # of the picture's pixels: a cloud that covers more, one over the other, is
LENIENT = 2.6  # times as blurred as others
MINOR, CROWDED = 0.1, 1.3  # of a canvas' clouds, that covers so little of it: as much more blurred
OPEN = 0.5  # of the picture, that the scene may be taken to leave free
WORTH = 0.5  # of the pixels of a canvas that are seen, that it must save to be worth it
MOST = 4  # canvases in a draw
NEAREST = 4.0  # m, of a guard
SPARE = 1.02  # of a cloud's box
MIDST = 0.6  # of a cloud's reach: as near it counts at least

Floats = NDArray[np.float64]
Rectangle = tuple[float, float, float, float]  # left, low, right, high, -1 to 1


class Group(NamedTuple):
    """Items from `first` to before `last`, in the order of drawing."""

    first: int
    last: int
    factor: int
    depth: tuple[float, float, float]  # of the guard: by x, by y, and in the middle; -1 to 1
    rectangle: Rectangle
    beyond: bool  # what stands among the clouds


def find_groups(
    view: ViewData, scene: CloudScene, store: CloudStore, drawn: NDArray, items: Items,
    tiles: NDArray, seen: Seen, parted: float,
) -> list[Group]:  # fmt: skip
    """The groups among `items`, which show the clouds `drawn`.

    tiles: heights of their pictures; seen: of those with billboards; parted: m from the camera,
    where something stands that no group has clouds on both sides of.
    """
    found: list[Group] = []
    some = items.ends > items.begins
    bills = np.isin(items.kinds, (BILLBOARDS, SOFT))
    if scene.parallel or not (bills & some).any():
        return found
    enlarged = _enlarged(scene, store, drawn, bills, tiles)
    area, low, high = np.zeros(len(drawn)), -np.ones((len(drawn), 2)), np.ones((len(drawn), 2))
    area[bills], low[bills], high[bills] = seen.area, seen.low, seen.high
    enlarged[area > HEAVY * seen.whole] *= LENIENT
    # What draws nothing is in nobody's way.
    good = np.append((enlarged >= FACTORS[-1]) | ~some, False)
    center, half = scene.center[drawn], SPARE * scene.half[drawn]
    beyond = scene.away[drawn] > parted
    first = 0
    while first < len(drawn) and len(found) < MOST:
        if not (good[first] and bills[first] and some[first]):
            first += 1
            continue
        inside = first + np.flatnonzero(some[first : first + int(np.argmin(good[first:]))])
        others = beyond[inside] != beyond[first]
        inside = inside[: int(np.argmax(np.append(others, True)))]
        held, guard = _guard(center[inside], half[inside])
        inside = inside[:held]
        inside = inside[: int(np.max(np.flatnonzero(bills[inside]), initial=-1)) + 1]
        if len(inside):
            small = area[inside] < MINOR * area[inside].sum()
            least = (enlarged[inside] * np.where(small, CROWDED, 1.0)).min()
            factor = next(each for each in FACTORS if each <= least)
            (left, bottom), (right, top) = low[inside].min(axis=0), high[inside].max(axis=0)
            shown = 0.25 * (right - left) * (top - bottom) * seen.whole
            if area[inside].sum() * (OPEN - factor**-2) > WORTH * OPEN * shown:
                rectangle = float(left), float(bottom), float(right), float(top)
                depth = _depth(view, *guard)
                last = int(inside[-1]) + 1
                found.append(Group(first, last, factor, depth, rectangle, bool(beyond[first])))
            first = int(inside[-1])
        first += 1
    return found


def _enlarged(
    scene: CloudScene, store: CloudStore, drawn: NDArray, bills: NDArray, tiles: NDArray
) -> Floats:
    """(n,) pixels on a side of a texel that counts."""
    away = np.maximum(scene.away[drawn], MIDST * scene.reach[drawn])
    wide = _widths(scene, store, drawn) * scene.clouds["scale"][drawn] * (scene.unit / away)
    detail = np.maximum(store.detail[scene.shapes[drawn]], 0.05)
    pictured = scene.pixels[drawn] / (detail * np.maximum(tiles, 1))
    return SHARP * np.where(bills, wide / (SIZE * detail), pictured)


def _widths(scene: CloudScene, store: CloudStore, which: NDArray) -> Floats:
    """(n,) m, of a billboard, at a scale of 1; from above those of a sheet's top count as well."""
    shapes, above = scene.shapes[which], scene.center[which, 1] < -scene.half[which, 1]
    widths: Floats = np.where(above, store.wide_top[shapes], store.wide[shapes])
    return widths


def _guard(center: Floats, half: Floats) -> tuple[int, tuple[Floats, float]]:
    """How many of the clouds one plane keeps from the camera, and the farthest such plane.

    The plane is normal . p = distance; it lies below them all, above, or across the way to them.
    """
    way = center.mean(axis=0)
    way = way / max(float(np.linalg.norm(way)), 1e-6)
    normals = np.array([(0.0, 1.0, 0.0), (0.0, -1.0, 0.0), way])
    distances = np.minimum.accumulate(center @ normals.T - half @ np.abs(normals).T)
    held = int((distances >= NEAREST).any(axis=1).sum())
    if not held:
        return 0, (way, 0.0)
    last = distances[held - 1]
    along = np.where(last >= NEAREST, last / np.maximum(normals @ way, 0.02), -1.0)
    best = int(np.argmax(along))
    return held, (normals[best], float(last[best]))


def _depth(view: ViewData, normal: Floats, distance: float) -> tuple[float, float, float]:
    """Depth of a plane in the picture, -1 to 1, which changes evenly across it."""
    p = view.projection
    x, y, z = view.view[:3, :3] @ normal
    share = p[2, 3] / distance
    across = share * x / p[0, 0], share * y / p[1, 1]
    middle = share * (x * p[0, 2] / p[0, 0] + y * p[1, 2] / p[1, 1] - z) - p[2, 2]
    return float(across[0]), float(across[1]), float(middle)
