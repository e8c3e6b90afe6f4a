"""Value noise on a seeded lattice, for ground, paint and foliage."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

SIZE = 256  # lattice period, cells


class Noise:
    """Smooth noise in [-1, 1], period 256 cells on both axes."""

    def __init__(self, seed: int) -> None:
        self.table = np.random.default_rng(seed).uniform(-1.0, 1.0, (SIZE, SIZE))

    def __call__(self, x: ArrayLike, y: ArrayLike) -> NDArray:
        """Noise at (x, y), one lattice cell a unit."""
        x, y = np.broadcast_arrays(np.asarray(x, "f8"), np.asarray(y, "f8"))
        fx, fy = np.floor(x), np.floor(y)
        i, j = fx.astype("i8") % SIZE, fy.astype("i8") % SIZE
        i1, j1 = (i + 1) % SIZE, (j + 1) % SIZE
        u, v = x - fx, y - fy
        u = u * u * u * (u * (u * 6.0 - 15.0) + 10.0)
        v = v * v * v * (v * (v * 6.0 - 15.0) + 10.0)
        t = self.table
        low = t[j, i] + (t[j, i1] - t[j, i]) * u
        high = t[j1, i] + (t[j1, i1] - t[j1, i]) * u
        return low + (high - low) * v

    def fbm(self, x: ArrayLike, y: ArrayLike, octaves: int = 4, gain: float = 0.5) -> NDArray:
        """Octaves of noise, each twice as fine and `gain` as strong; about [-1, 1]."""
        x, y = np.asarray(x, "f8"), np.asarray(y, "f8")
        total = np.zeros(np.broadcast(x, y).shape)
        weight, norm, scale = 1.0, 0.0, 1.0
        for octave in range(octaves):
            total = total + weight * self(x * scale + 17.3 * octave, y * scale + 9.1 * octave)
            norm += weight
            weight *= gain
            scale *= 2.0
        return total / norm


def smoothstep(low: float, high: float, value: ArrayLike) -> NDArray:
    """Hermite step from 0 at `low` to 1 at `high` (either order)."""
    t = np.clip((np.asarray(value, "f8") - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)
