"""What a camera sees of the clouds that are drawn: how much, and where."""

from __future__ import annotations

from operator import is_not
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import ViewData
from weather_ecs.gpu.cloud_scene import CloudScene
from weather_ecs.gpu.cloud_store import CloudStore, StoredShape
from weather_ecs.physics.cloud_billboard import half_axes, place

Floats = NDArray[np.float64]

PICTURED = 0.8  # of the rectangle round a picture, that its octagon covers
COVERED = 0.6  # of the rectangle round a billboard that it covers
LEAST_DEPTH = 0.02  # of its width, that a corner beside the camera counts as far ahead


class Seen(NamedTuple):
    """Of each cloud, (m,): pixels drawn for it, and in which part of the picture."""

    area: Floats
    low: Floats  # (m, 2) x and y, -1 to 1
    high: Floats
    whole: float  # pixels of the picture


class _Billboards(NamedTuple):
    """Those of clouds one after the other, n in all; from the middle of each shape, m."""

    shapes: list[StoredShape]  # (m,) of the clouds
    counts: NDArray[np.intp]  # (m,)
    places: Floats  # (n, 3)
    size: Floats  # (2, n)
    turn: Floats  # (n,)


class SeenClouds:
    """Keeps the billboards of the clouds that are measured, until they are other ones."""

    def __init__(self) -> None:
        self._kept = _billboards([])

    def measure(
        self, view: ViewData, scene: CloudScene, store: CloudStore, which: NDArray[np.intp]
    ) -> Seen:
        """What of the clouds `which` is in the picture; 0 pixels for what is not."""
        shapes = [store.shapes[shape] for shape in scene.shapes[which].tolist()]
        kept = self._kept
        if len(shapes) != len(kept.shapes) or any(map(is_not, shapes, kept.shapes)):
            kept = self._kept = _billboards(shapes)
        pixels = _whole(view, scene)
        low, high = np.ones((len(shapes), 2)), -np.ones((len(shapes), 2))
        seen = Seen(np.zeros(len(shapes)), low, high, pixels)
        if not len(kept.turn):
            return seen
        clouds = scene.clouds[which]
        names = ("scale", "mirror", "heading")
        numbers = *(clouds[name] for name in names), *clouds["shear"].T, *scene.center[which].T
        each = np.array(numbers).repeat(kept.counts, axis=1)
        scale, mirror, heading = each[:3]
        at = place(kept.places, scale, mirror, heading, each[3:5]).T
        at += each[5:]
        size = kept.size * scale
        x, y = half_axes(at, size, kept.turn, mirror, heading)
        share, low, high = _rectangles(view, at, x, y, LEAST_DEPTH * size[0])
        some = np.flatnonzero(kept.counts)
        starts = (np.cumsum(kept.counts) - kept.counts)[some]
        seen.area[some] = np.add.reduceat(share, starts) * (COVERED * pixels)
        seen.low[some] = np.minimum.reduceat(low, starts, axis=1).T
        seen.high[some] = np.maximum.reduceat(high, starts, axis=1).T
        return seen


def _billboards(shapes: list[StoredShape]) -> _Billboards:
    places, size, turn = np.zeros((3, 0)), np.zeros((2, 0)), np.zeros(0)
    if shapes:
        places = np.concatenate([shape.position.T for shape in shapes], axis=1, dtype=np.float64)
        rows = [shape.data.billboards for shape in shapes]
        size = np.concatenate([row["size"].T for row in rows], axis=1, dtype=np.float64)
        turn = np.concatenate([row["turn"] for row in rows], dtype=np.float64)
    counts = np.array([len(shape.position) for shape in shapes], np.intp)
    return _Billboards(shapes, counts, places.T, size, turn)


def pictures_seen(view: ViewData, scene: CloudScene, quads: NDArray[np.float32]) -> Seen:
    """Of pictures; quads: as shaders/cloud_quad.vert reads them."""
    middle, right, up = (quads[:, k, :3].T.astype(np.float64) for k in range(3))
    # What gives way to a smaller one may reach out beyond it.
    right, up = right * quads[:, 3, 3], up * quads[:, 3, 3]
    least = LEAST_DEPTH * np.sqrt((right * right).sum(axis=0))
    share, low, high = _rectangles(view, middle, right, up, least)
    pixels = _whole(view, scene)
    return Seen(PICTURED * pixels * share, low.T, high.T, pixels)


def together(*parts: tuple[NDArray[np.bool_], Seen]) -> Seen:
    """One of those that each fill in where they are true; 0 pixels elsewhere."""
    count = len(parts[0][0])
    found = Seen(np.zeros(count), np.ones((count, 2)), -np.ones((count, 2)), parts[0][1].whole)
    for where, seen in parts:
        found.area[where], found.low[where], found.high[where] = seen[:3]
    return found


def _whole(view: ViewData, scene: CloudScene) -> float:
    """Pixels of the picture."""
    p = view.projection
    return float((2.0 * scene.unit / p[1, 1]) ** 2 * p[1, 1] / p[0, 0])


def _rectangles(
    view: ViewData, middle: Floats, x: Floats, y: Floats, least: Floats
) -> tuple[Floats, Floats, Floats]:
    """Of parallelograms, what share of the picture is round them, (n,), and where, (2, n) each.

    middle, x, y: (3, n) m from the camera, and half of their sides; least: (n,) m, that a corner
    beside the camera counts as far ahead.
    """
    p = view.projection
    to_picture = np.array(((p[0, 0], 0.0, p[0, 2]), (0.0, p[1, 1], p[1, 2]), (0.0, 0.0, -1.0)))
    to_picture = to_picture @ view.view[:3, :3]
    middle, x, y = to_picture @ middle, to_picture @ x, to_picture @ y
    one, other = x + y, x - y
    rim = np.stack([middle + one, middle - one, middle + other, middle - other])
    across, ahead = rim[:, :2], rim[:, 2]
    # All four corners on the outer side of one of the frustum's sides: nothing is seen.
    inside = (across < ahead[:, None]).any(axis=0) & (across > -ahead[:, None]).any(axis=0)
    shown = inside.all(axis=0) & (ahead > 0.0).any(axis=0)
    # A corner behind the camera is somewhere far out on its side.
    across /= np.maximum(ahead, least)[:, None]
    low = np.clip(across.min(axis=0), -1.0, 1.0)
    high = np.clip(across.max(axis=0), -1.0, 1.0)
    share = 0.25 * (high[0] - low[0]) * (high[1] - low[1]) * shown
    out = share <= 0.0
    low[:, out], high[:, out] = 1.0, -1.0
    return share, low, high
