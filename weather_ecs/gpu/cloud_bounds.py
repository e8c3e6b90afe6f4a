"""What part of the view a cloud's picture has to show: as tight as its billboards are."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from weather_ecs.gpu.cloud_images import hulls
from weather_ecs.gpu.cloud_scene import CloudScene
from weather_ecs.gpu.cloud_store import StoredShape
from weather_ecs.physics.cloud_billboard import corners, place, presence, shown_size
from weather_ecs.physics.cloud_view import picture_axes

Vector = NDArray[np.float64]


MARGIN = 1.01  # of what is shown
WIDEST = 4.0  # times a picture's size, that is drawn for its predecessor's sake
FAINT = 0.004  # opacity of a billboard that does not show


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
    at = place(shape.position[shown].astype(np.float64), scale, mirror, heading, shear)
    at = at + scene.center[index]
    size = shown_size(bills["size"].astype(np.float64), scale, there)
    outline = hulls()[bills["image"].astype(np.intp)]
    offsets = corners(at, size, bills["turn"].astype(np.float64), mirror, heading, outline)
    rim = (at[:, None] + offsets).reshape(-1, 3) @ np.stack([right, up, way], axis=1)
    x, y = (rim[:, :2] / np.maximum(rim[:, 2:], 1e-3)).T
    middle = 0.5 * float(x.min() + x.max()), 0.5 * float(y.min() + y.max())
    half = tuple(0.5 * MARGIN * max(float(np.ptp(part)), 1e-6) for part in (x, y))
    u, v = (x - middle[0]) / half[0], (y - middle[1]) / half[1]
    spare = 2.0 * (MARGIN - 1.0)
    a, b, c, d = (min(float(part.max()) + spare, 2.0) for part in (u + v, v - u, -u - v, u - v))
    return PictureBounds((way, right, up), middle, (half[0], half[1]), (a, b, c, d))


def shared_octagon(
    quads: Vector, cuts: NDArray, old_quads: Vector, old_cuts: NDArray
) -> tuple[Vector, Vector]:
    """What to draw pictures in while they replace others, so that those are not cut off.

    quads: (m, 3, 3) middle from the camera, half width, half height; cuts: (m, 4). Returned: how
    many times the picture's size, (m,), infinite where it is too much or they cannot be drawn in
    one plane, and the cuts of that, (m, 4).
    """
    middle, wide, high = quads[:, 0], quads[:, 1], quads[:, 2]
    rim = _octagon(old_cuts)
    rim = old_quads[:, :1] + rim[..., :1] * old_quads[:, 1:2] + rim[..., 1:] * old_quads[:, 2:]
    normal = np.cross(wide, high)
    depth = np.einsum("mki,mi->mk", rim, normal)
    there = np.einsum("mi,mi->m", middle, normal)[:, None]
    fits = (depth * np.sign(there) > np.abs(there) / WIDEST).all(axis=1)
    on = rim * (there / np.where(fits[:, None], depth, 1.0))[..., None] - middle[:, None]
    across = [
        np.einsum("mki,mi->mk", on, axis) / np.maximum((axis * axis).sum(axis=1), 1e-12)[:, None]
        for axis in (wide, high)
    ]
    at = np.concatenate([np.stack(across, axis=-1), _octagon(cuts)], axis=1)
    size = np.abs(at).max(axis=(1, 2))
    u, v = (at / size[:, None, None]).transpose(2, 0, 1)
    cut = np.stack([each.max(axis=1) for each in (u + v, v - u, -u - v, u - v)], axis=1)
    return np.where(fits & (size <= WIDEST), size, np.inf), cut


def _octagon(cuts: NDArray) -> Vector:
    """(m, 8, 2) corners, in halves of the rectangle."""
    ends = np.asarray(cuts, np.float64) - 1.0
    one = np.ones_like(ends)
    sides = np.array([(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)])
    both = np.stack([np.stack([one, ends], -1), np.stack([ends, one], -1)], axis=2)
    return (both * sides[:, None]).reshape(len(ends), 8, 2)
