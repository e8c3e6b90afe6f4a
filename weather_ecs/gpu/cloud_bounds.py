"""What part of the view a cloud's picture has to show: as tight as its billboards are."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from weather_ecs.gpu.cloud_images import hulls
from weather_ecs.gpu.cloud_scene import CloudScene
from weather_ecs.gpu.cloud_store import StoredShape
from weather_ecs.physics.cloud_billboard import half_axes, place, presence, shown_size
from weather_ecs.physics.cloud_view import picture_axes
from weather_ecs.physics.vectors import cross

Vector = NDArray[np.float64]


MARGIN = 1.01  # of what is shown
WIDEST = 4.0  # times a picture's size, that is drawn for its predecessor's sake
FAINT = 0.004  # opacity of a billboard that does not show
# (1, 8, 2) of a rectangle's corners, each twice; which of their numbers the cuts are factors on.
_CORNERS = np.array([(1, 1), (-1, 1), (-1, -1), (1, -1)], np.float64).repeat(2, axis=0)[None]
_QUARTER, _CUT = np.arange(8) // 2, (np.arange(8), np.array([1, 0] * 4))
_DIAGONALS = np.array([(1.0, -1.0, -1.0, 1.0), (1.0, 1.0, -1.0, -1.0)])


class PictureBounds(NamedTuple):
    """An octagon on the plane at depth 1 before the camera: a rectangle with its corners cut."""

    axes: tuple[Vector, Vector, Vector]  # way to the cloud's centre, right, up; unit
    middle: tuple[float, float]
    half: tuple[float, float]
    # How far x + y, y - x, -x - y and x - y go, in halves of the rectangle; 2: nothing is cut.
    cuts: tuple[float, float, float, float]


def picture_bounds(scene: CloudScene, shape: StoredShape, index: int) -> PictureBounds:
    """The bounds of what shows of the cloud `index`, all of which is in front of the camera."""
    cloud, bills = scene.clouds[index], shape.data.billboards
    way = scene.center[index] / scene.away[index]
    right, up = picture_axes(way)
    scale, mirror, heading = (float(cloud[name]) for name in ("scale", "mirror", "heading"))
    shear = (float(cloud["shear"][0]), float(cloud["shear"][1]))
    there = presence(cloud["growth"], cloud["mode"], bills["order"])
    shown = np.flatnonzero(there * bills["opacity"] > FAINT)
    if not len(shown):
        shown = np.array([int(np.argmax(there))])
    bills, there = bills[shown], there[shown]
    at = place(shape.position[shown].astype(np.float64), scale, mirror, heading, shear).T
    at += scene.center[index][:, None]
    size = shown_size(bills["size"].astype(np.float64), scale, there).T
    across, along = half_axes(at, size, bills["turn"].astype(np.float64), mirror, heading)
    axes = np.stack([right, up, way])
    # Of the corners of all octagons, (3, 8, n): to the right, up, and ahead.
    outline = hulls()[bills["image"].astype(np.intp)].T
    rim = outline[0] * (axes @ across)[:, None] + outline[1] * (axes @ along)[:, None]
    rim += (axes @ at)[:, None]
    seen = rim[:2].reshape(2, -1) / np.maximum(rim[2], 1e-3).reshape(-1)
    low, high = seen.min(axis=1), seen.max(axis=1)
    middle, half = 0.5 * (low + high), 0.5 * MARGIN * np.maximum(high - low, 1e-6)
    u, v = (seen - middle[:, None]) / half[:, None]
    both, other = u + v, u - v
    spare = 2.0 * (MARGIN - 1.0)
    ends = (both.max(), -other.min(), -both.min(), other.max())
    a, b, c, d = (min(float(end) + spare, 2.0) for end in ends)
    (x, y), (wide, high) = middle.tolist(), half.tolist()
    return PictureBounds((way, right, up), (x, y), (wide, high), (a, b, c, d))


def shared_octagon(
    quads: Vector, cuts: NDArray, old_quads: Vector, old_cuts: NDArray
) -> tuple[Vector, Vector]:
    """What to draw pictures in while they replace others, so that those are not cut off.

    quads: (m, 3, 3) middle from the camera, half width, half height; cuts: (m, 4). Returned: how
    many times the picture's size, (m,), infinite where it is too much or they cannot be drawn in
    one plane, and the cuts of that, (m, 4).
    """
    middle, axes = quads[:, :1], quads[:, 1:]
    rim = old_quads[:, :1] + _octagon(old_cuts) @ old_quads[:, 1:]
    normal = cross(axes[:, 0], axes[:, 1])[..., None]
    depth, there = rim @ normal, middle @ normal
    before = depth * np.sign(there) > np.abs(there) / WIDEST
    fits: NDArray[np.bool_] = np.logical_and.reduce(before, axis=(1, 2))
    on = rim * (there / np.where(fits[:, None, None], depth, 1.0)) - middle
    dual = axes / np.maximum((axes * axes).sum(axis=2, keepdims=True), 1e-12)
    at = np.concatenate([on @ dual.transpose(0, 2, 1), _octagon(cuts)], axis=1)
    size = np.abs(at).max(axis=(1, 2))
    cut = (at @ _DIAGONALS).max(axis=1) / size[:, None]
    return np.where(fits & (size <= WIDEST), size, np.inf), cut


def _octagon(cuts: NDArray) -> Vector:
    """(m, 8, 2) corners, in halves of the rectangle."""
    found = _CORNERS.repeat(len(cuts), axis=0)
    found[:, _CUT[0], _CUT[1]] *= (cuts - 1.0)[:, _QUARTER]
    return found
