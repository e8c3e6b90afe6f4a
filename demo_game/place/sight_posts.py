"""A row of dark posts over the open meadow, one every 50 m: by them one sees how far one sees."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from . import layout
from .mesh import PLAIN, Builder
from .props import Height

STEP = 50.0  # m, from one to the next, as seen from where one looks along them
COUNT = 8
TALL, WIDTH = 4.5, 0.5  # m
BLACK = np.full(3, 0.02)  # albedo: Koschmieder's law is of black things
SPREAD = 0.016  # rad between the bearings of neighbours, so that none hides another


def feet() -> NDArray:
    """(COUNT, 2) where they stand, nearest first."""
    distance = STEP * np.arange(1, COUNT + 1)
    bearing = layout.SIGHT_BEARING + SPREAD * (np.arange(COUNT) - 0.5 * (COUNT - 1))
    x, z = layout.SIGHT_FROM
    return np.stack([x + distance * np.sin(bearing), z - distance * np.cos(bearing)], axis=1)


def heading() -> float:
    """Yaw (rad) of an eye at `layout.SIGHT_FROM` that looks along them."""
    return -math.remainder(layout.SIGHT_BEARING, math.tau)


def posts(build: Builder, height: Height) -> None:
    """All of them, plain and upright."""
    for x, z in feet().tolist():
        middle = (x, height(x, z) + 0.5 * TALL - 0.3, z)
        build.box(middle, (WIDTH, TALL + 0.6, WIDTH), BLACK, material=PLAIN, vary=0.0)
