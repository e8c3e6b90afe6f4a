"""Clouds as wholes: the cloud that a model and a number give, and the sphere that holds it.

After Torchelsen (2005), section 3.2: a cloud's radius reaches the farthest corner of its seeds.
`cloud_view` tests that sphere against what a camera sees.
"""

from __future__ import annotations

import zlib
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.checks import count, floats
from weather_ecs.physics.reproduction import Boxes, billboards, descend


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
    found, sides, seeds = descend(model, rng)
    low, high = (found - 0.5 * sides).min(axis=0), (found + 0.5 * sides).max(axis=0)
    middle = found - 0.5 * (low + high)
    shown = billboards(model, Boxes(middle, sides, seeds), rng)
    centers, sizes = middle.astype(np.float32), sides.astype(np.float32)
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
