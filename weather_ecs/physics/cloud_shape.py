"""Clouds as wholes: the cloud that a model and a number give, its sphere, and which are in view.

After Torchelsen (2005), section 3.2: a cloud's radius reaches the farthest corner of its seeds, and
the sphere is tested against the frustum's own sphere before its planes.
"""

from __future__ import annotations

import zlib
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.checks import FloatArray, count, floats
from weather_ecs.physics.reproduction import billboards, reproduce


class CloudShape(NamedTuple):
    """One cloud about its centre: the middle of the box round all of its seeds."""

    centers: NDArray[np.float32]  # (s, 3), m, of the seeds' boxes
    sizes: NDArray[np.float32]  # (s, 3), m, whole sides
    billboards: NDArray  # reproduction.BILLBOARDS, (n,)
    radius: float  # m, of the sphere round the centre that holds every seed
    half: tuple[float, float, float]  # m, half of the box round all seeds; its bottom is the base


def shape(model: Any, number: int) -> CloudShape:
    """The cloud of this number that the model gives: always the same one, and read-only.

    A cloud whose base is to be at height y has its centre at y + half[1].
    """
    # The name's checksum keeps two models of the same seeds apart.
    entropy = [zlib.crc32(str(model.name).encode()), count("number", number)]
    rng = np.random.Generator(np.random.PCG64(np.random.SeedSequence(entropy)))
    boxes, sides = reproduce(model, rng)
    low, high = (boxes - 0.5 * sides).min(axis=0), (boxes + 0.5 * sides).max(axis=0)
    centers = (boxes - 0.5 * (low + high)).astype(np.float32)
    sizes = sides.astype(np.float32)
    shown = billboards(model, centers, sizes, rng)
    for array in (centers, sizes, shown):
        array.setflags(write=False)
    half = 0.5 * (high - low)
    extent = (float(half[0]), float(half[1]), float(half[2]))
    return CloudShape(centers, sizes, shown, bounding_radius(centers, sizes), extent)


def bounding_radius(centers: ArrayLike, sizes: ArrayLike) -> float:
    """Radius of the smallest sphere round the origin that holds every box, m."""
    boxes, sides = floats("centers", centers), floats("sizes", sizes, 0.0)
    if boxes.ndim != 2 or boxes.shape[1] != 3 or sides.shape != boxes.shape or not len(boxes):
        raise InvalidValueError("centers", boxes.shape, "shape (n, 3), as the sizes', n >= 1")
    corner = np.abs(boxes) + 0.5 * sides
    return float(np.sqrt((corner * corner).sum(axis=1).max()))


class Frustum(NamedTuple):
    """What a camera sees, world axes."""

    planes: FloatArray  # (6, 4): unit normal inwards and offset; a.p + d >= 0 inside
    center: FloatArray  # (3,), m, of its own sphere
    radius: float  # m; infinite where the view has no far end


def frustum(view_projection: ArrayLike) -> Frustum:
    """The frustum of a (4, 4) matrix for column vectors, world to clip space of OpenGL."""
    matrix = floats("view_projection", view_projection)
    if matrix.shape != (4, 4):
        raise InvalidValueError("view_projection", matrix.shape, "shape (4, 4)")
    try:
        inverse = np.linalg.inv(matrix)
    except np.linalg.LinAlgError:
        raise InvalidValueError("view_projection", matrix, "a matrix with an inverse") from None
    rows = np.concatenate((matrix[3] + matrix[:3], matrix[3] - matrix[:3]))
    length = np.linalg.norm(rows[:, :3], axis=1)
    # A projection without a far end has no far plane: everything is in front of it.
    flat = length < 1e-12 * length.max(initial=0.0)
    rows[flat] = (0.0, 0.0, 0.0, np.inf)
    planes = rows / np.where(flat, 1.0, length)[:, None]
    signs = np.array([[x, y, z, 1.0] for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)])
    corners = signs @ inverse.T
    if flat.any() or not np.all(corners[:, 3] > 1e-12 * corners[:, 3].max()):
        return Frustum(planes, np.zeros(3), np.inf)
    corners = corners[:, :3] / corners[:, 3:]
    center = corners.mean(axis=0)
    return Frustum(planes, center, float(np.linalg.norm(corners - center, axis=1).max()))


def visible(centers: ArrayLike, radii: ArrayLike, view: Frustum) -> NDArray[np.bool_]:
    """Which clouds, spheres of these centres (n, 3) and radii (n,), may be in view, (n,)."""
    middles, reach = floats("centers", centers), floats("radii", radii, 0.0)
    result = np.zeros(len(middles), bool)
    offset = middles - view.center
    near = (offset * offset).sum(axis=1) <= (view.radius + reach) ** 2
    depth = middles[near] @ view.planes[:, :3].T + view.planes[:, 3]
    result[near] = np.all(depth >= -reach[near, None], axis=1)
    return result
