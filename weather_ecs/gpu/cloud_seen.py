"""What a camera sees of the clouds that are drawn: how much, and where."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import ViewData
from weather_ecs.gpu.cloud_scene import CloudScene
from weather_ecs.gpu.cloud_store import CloudStore, StoredShape
from weather_ecs.physics.cloud_billboard import corners, place

Floats = NDArray[np.float64]

PICTURED = 0.8  # of the rectangle round a picture, that its octagon covers
COVERED = 0.6  # of the rectangle round a billboard that it covers
LEAST_DEPTH = 0.02  # of its width, that a corner beside the camera counts as far ahead
_PLACE = ["scale", "mirror", "heading", "shear"]  # what its billboards' places depend on


class Seen(NamedTuple):
    """Of each cloud, (m,): pixels drawn for it, and in which part of the picture."""

    area: Floats
    low: Floats  # (m, 2) x and y, -1 to 1
    high: Floats
    whole: float  # pixels of the picture


class SeenClouds:
    """Keeps where the billboards of clouds lie about their centres."""

    def __init__(self) -> None:
        self._known: dict[int, tuple[StoredShape, bytes, tuple[Floats, ...]]] = {}

    def measure(
        self, view: ViewData, scene: CloudScene, store: CloudStore, which: NDArray[np.intp]
    ) -> Seen:
        """What of the clouds `which` is in the picture; 0 pixels for what is not."""
        found = [self._about(scene, store, index) for index in which.tolist()]
        self._known = {int(key): self._known[int(key)] for key in scene.clouds["key"][which]}
        counts = np.array([len(parts[0]) for parts in found], np.intp)
        pixels = _whole(view, scene)
        low, high = np.ones((len(found), 2)), -np.ones((len(found), 2))
        seen = Seen(np.zeros(len(found)), low, high, pixels)
        if not counts.sum():
            return seen
        places, size, turn = (np.concatenate([parts[k] for parts in found]) for k in range(3))
        mirror, heading = (np.repeat(scene.clouds[name][which], counts) for name in _PLACE[1:3])
        at = places + np.repeat(scene.center[which], counts, axis=0)
        offsets = corners(at, size, turn, mirror, heading)
        share, low, high = _rectangles(view, at[:, None] + offsets, LEAST_DEPTH * size[:, :1])
        covered = COVERED * pixels * share
        some = np.flatnonzero(counts)
        starts = np.concatenate([[0], np.cumsum(counts)[:-1]])[some]
        seen.area[some] = np.add.reduceat(covered, starts)
        seen.low[some] = np.minimum.reduceat(low, starts)
        seen.high[some] = np.maximum.reduceat(high, starts)
        return seen

    def _about(self, scene: CloudScene, store: CloudStore, index: int) -> tuple[Floats, ...]:
        """Of a cloud's billboards: places from its centre, (n, 3) m, sizes (n, 2), turns (n,)."""
        cloud, shape = scene.clouds[index], store.shapes[int(scene.shapes[index])]
        key, state = int(cloud["key"]), cloud[_PLACE].tobytes()
        known = self._known.get(key)
        if known is None or known[0] is not shape or known[1] != state:
            scale, mirror, heading = (float(cloud[name]) for name in _PLACE[:3])
            shear = (float(cloud["shear"][0]), float(cloud["shear"][1]))
            at = place(shape.position.astype(np.float64), scale, mirror, heading, shear)
            size = scale * shape.data.billboards["size"].astype(np.float64)
            turn = shape.data.billboards["turn"].astype(np.float64)
            known = self._known[key] = (shape, state, (at, size, turn))
        return known[2]


def pictures_seen(view: ViewData, scene: CloudScene, quads: NDArray[np.float32]) -> Seen:
    """Of pictures; quads: as shaders/cloud_quad.vert reads them."""
    middle, right, up = (quads[:, k, :3].astype(np.float64) for k in range(3))
    # What gives way to a smaller one may reach out beyond it.
    right, up = right * quads[:, 3, 3:], up * quads[:, 3, 3:]
    rim = np.stack([middle + x * right + y * up for x in (-1, 1) for y in (-1, 1)], axis=1)
    share, low, high = _rectangles(view, rim, LEAST_DEPTH * np.linalg.norm(right, axis=1)[:, None])
    pixels = _whole(view, scene)
    return Seen(PICTURED * pixels * share, low, high, pixels)


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


def _rectangles(view: ViewData, rim: Floats, least: Floats) -> tuple[Floats, Floats, Floats]:
    """Of corners (n, 4, 3) from the camera: what share of the picture is round them, and where.

    least: (n, 1) m, that a corner beside the camera counts as far ahead.
    """
    p = view.projection
    eye = rim @ view.view[:3, :3].T
    ahead = -eye[..., 2]
    across = np.array((p[0, 0], p[1, 1])) * eye[..., :2]
    across -= np.array((p[0, 2], p[1, 2])) * ahead[..., None]
    # All four corners on the outer side of one of the frustum's sides: nothing is seen.
    inside = (across < ahead[..., None]).any(axis=1) & (across > -ahead[..., None]).any(axis=1)
    shown = inside.all(axis=1) & (ahead > 0.0).any(axis=1)
    # A corner behind the camera is somewhere far out on its side.
    middle = across / np.maximum(ahead, least)[..., None]
    low = np.clip(middle.min(axis=1), -1.0, 1.0)
    high = np.clip(middle.max(axis=1), -1.0, 1.0)
    share = 0.25 * (high - low).prod(axis=1) * shown
    out = share <= 0.0
    low[out], high[out] = 1.0, -1.0
    return share, low, high
