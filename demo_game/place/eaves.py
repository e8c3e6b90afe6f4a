"""Where water runs off the cabin's roof: points along the lower edges, and what lies below them."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from . import cabin, cabin_porch

BETWEEN = 0.07  # m, of the points along an edge, on the average
INTO = 0.05  # m, from an edge's ends
BELOW = 0.04  # m below the shingles that drops let go


def points(origin: NDArray, floor: Callable[[float, float, float], float]) -> NDArray:
    """(n, 4) world x, y, z, m, of drips along the eaves, and the height below that stops them.

    `origin` is the cabin's; `floor(x, z, y)` the highest ground or step at a place, below y.
    """
    start, end = cabin.DEPTH / 2.0 - 0.02, cabin.DEPTH / 2.0 + cabin_porch.PORCH + 0.32
    steep = (cabin_porch.ROOF_HIGH - cabin_porch.ROOF_LOW) / (cabin_porch.POST_Z - start)
    porch = (cabin.WIDTH + 0.7, cabin_porch.ROOF_HIGH - steep * (end - start), end + 0.03)
    slope = (cabin.DEPTH / 2.0 + cabin.EAVES) / np.cos(cabin.PITCH)
    low = cabin.RIDGE + 0.04 - slope * np.sin(cabin.PITCH)
    back = (cabin.WIDTH + 2.0 * cabin.GABLE, low, -slope * np.cos(cabin.PITCH) - 0.03)
    random = np.random.default_rng(11)
    found = []
    for length, height, z in (porch, back):
        count = round((length - 2.0 * INTO) / BETWEEN)
        along = (np.arange(count) + random.uniform(0.1, 0.9, count)) / count - 0.5
        x = along * (length - 2.0 * INTO)
        at = np.stack([x, np.full(count, height - BELOW), np.full(count, z)], 1) + origin
        stops = [floor(float(p[0]), float(p[2]), float(p[1])) for p in at]
        found.append(np.column_stack([at, stops]))
    return np.concatenate(found)
