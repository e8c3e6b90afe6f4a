"""Where drops make rings on puddles: places on bare earth along the trails."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from . import paint
from .terrain import Terrain

BETWEEN = 0.2  # m, of the places, on the average


def sites(terrain: Terrain, meadow: NDArray, seed: int = 17) -> NDArray:
    """(n, 3) m on the ground, falling z; `meadow` is the painted map."""
    random = np.random.default_rng(seed)
    size = meadow.shape[0]
    step = (paint.HIGH - paint.LOW) / size
    shown = (meadow[..., :3].astype("f4") / 255.0) ** 2
    # As ground.frag tells earth from grass.
    row, column = np.nonzero((shown[..., 0] - shown[..., 1]) * 20.0 - 0.3 > 0.5)
    count = round(len(row) * float(step[0] * step[1]) / BETWEEN**2)
    chosen = random.integers(0, len(row), count)
    place = np.stack([column[chosen], row[chosen]], 1) + random.random((count, 2))
    x, z = (paint.LOW + place * step).T
    order = np.argsort(-z, kind="stable")
    return np.stack([x, terrain.height(x, z), z], 1)[order]
