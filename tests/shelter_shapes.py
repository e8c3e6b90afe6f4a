"""Ground that keeps the rain off."""

from __future__ import annotations

import numpy as np


def hills(n: int, size: float, seed: int = 0) -> tuple[np.ndarray, np.ndarray]:
    """An uneven ground of n by n quads."""
    rng = np.random.default_rng(seed)
    at = np.linspace(-size / 2, size / 2, n + 1)
    x, z = np.meshgrid(at, at)
    vertices = np.stack([x, rng.uniform(0.0, 0.3 * size / n, x.shape), z], -1).reshape(-1, 3)
    i, j = np.meshgrid(np.arange(n), np.arange(n))
    a = (j * (n + 1) + i).ravel()
    quads = np.stack([a, a + n + 1, a + 1, a + 1, a + n + 1, a + n + 2], 1)
    return vertices.astype(np.float32), quads.reshape(-1).astype(np.uint32)
