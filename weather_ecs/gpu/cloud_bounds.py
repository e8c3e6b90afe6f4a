"""What part of the view a cloud's picture has to show: as tight as its billboards are."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from weather_ecs.gpu.cloud_scene import CloudScene
from weather_ecs.gpu.cloud_store import StoredShape
from weather_ecs.physics.cloud_billboard import place
from weather_ecs.physics.cloud_view import picture_axes

Vector = NDArray[np.float64]


class PictureBounds(NamedTuple):
    """A rectangle on the plane at depth 1 before the camera."""

    axes: tuple[Vector, Vector, Vector]  # way to the cloud's centre, right, up; unit
    middle: tuple[float, float]
    half: tuple[float, float]


def picture_bounds(scene: CloudScene, shape: StoredShape, index: int) -> PictureBounds:
    """The bounds of the cloud `index`, all of which is in front of the camera."""
    cloud = scene.clouds[index]
    way = scene.center[index] / scene.away[index]
    right, up = picture_axes(way)
    scale = float(cloud["scale"])
    shear = (float(cloud["shear"][0]), float(cloud["shear"][1]))
    at = place(
        shape.position.astype(np.float64),
        scale,
        float(cloud["mirror"]),
        float(cloud["heading"]),
        shear,
    )
    at = at + scene.center[index]
    size = shape.data.billboards["size"].astype(np.float64) * (0.5 * scale)
    sine2 = (at[:, 1] ** 2) / np.maximum((at * at).sum(axis=1), 1e-9)
    high = np.sqrt(size[:, 1] ** 2 * (1.0 - sine2) + size[:, 0] ** 2 * sine2)
    depth = np.maximum(at @ way, 1e-3)
    x, y, w, h = at @ right / depth, at @ up / depth, size[:, 0] / depth, high / depth
    left, low = float((x - w).min()), float((y - h).min())
    width, height = float((x + w).max()) - left, float((y + h).max()) - low
    # A billboard beside the centre is not quite square to the way there.
    margin = 1.02
    return PictureBounds(
        (way, right, up),
        (left + 0.5 * width, low + 0.5 * height),
        (0.5 * margin * max(width, 1e-6), 0.5 * margin * max(height, 1e-6)),
    )
