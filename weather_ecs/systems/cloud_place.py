"""Places of clouds in a layer: scattered at random, without the clumps and holes of pure chance."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from weather_ecs.physics.chance import uniforms

QUANTUM = 0.5  # m, of a place in the drifting frame


def scattered(count: int, width: float, depth: float, chance: int) -> NDArray:
    """(count, 2) places within half the width and depth of 0, m; each in a cell of its own."""
    if not count:
        return np.zeros((0, 2))
    columns = max(round(math.sqrt(count * width / depth)), 1)
    columns = min(columns, count)
    lines = math.ceil(count / columns)
    cells = np.argsort(uniforms(np.arange(columns * lines), chance, 1), kind="stable")[:count]
    numbers = np.arange(count)
    x = (cells % columns + uniforms(numbers, chance, 2)) / columns - 0.5
    z = (cells // columns + uniforms(numbers, chance, 3)) / lines - 0.5
    return np.column_stack((x * width, z * depth))


def apart(place: tuple[int, int], x: NDArray, z: NDArray) -> int:
    """Squared distance of a place from the nearest of others, quanta; exact."""
    if not len(x):
        return 0
    dx, dz = x - place[0], z - place[1]
    return int((dx * dx + dz * dz).min())
