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
