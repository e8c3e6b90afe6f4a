"""Billboards that a thick sheet of cloud hides from whoever is on its other side."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import CloudShapeData

WIDE = 2.5  # times as wide as high, from which a cloud is a sheet
Mask = NDArray[np.bool_]


def hidden_sides(data: CloudShapeData) -> tuple[Mask, Mask] | None:
    """(n,) which billboards nobody sees from under the cloud, and which from over it.

    Those of seeds wholly in its upper or lower half, where light is lost on the way through it;
    None where it hides nothing.
    """
    if not len(data.billboards):
        return None
    low, high = data.centers - 0.5 * data.sizes, data.centers + 0.5 * data.sizes
    size = high.max(axis=0) - low.min(axis=0)
    if size[1] < data.penetration or min(size[0], size[2]) < WIDE * size[1]:
        return None
    middle = 0.5 * float(high[:, 1].max() + low[:, 1].min())
    seeds = data.billboards["seed"]
    upper, lower = (low[:, 1] > middle)[seeds], (high[:, 1] < middle)[seeds]
    hides = (upper.any() or lower.any()) and not (upper | lower).all()
    return (upper, lower) if hides else None
