"""The painted leaves that clumps and sprays are cut from: shade and shape, with their mipmaps."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

SIZE = 128  # texels, of each of the two pictures side by side
SOLID = (0.5, 0.996)  # (u, v) of a texel without holes, for bark and what lies inside a crown


def _ellipses(marks: NDArray, size: int) -> tuple[NDArray, NDArray]:
    """Shade and coverage of (x, y, along, across, turn, shade) marks, later ones on top."""
    v, u = (np.mgrid[0:size, 0:size] + 0.5) / size
    shade, cover = np.full((size, size), 0.5), np.zeros((size, size))
    for x, y, along, across, turn, tone in marks:
        c, s = np.cos(turn), np.sin(turn)
        du, dv = u - x, v - y
        p, q = (du * c + dv * s) / along, (dv * c - du * s) / across
        inside = p * p + q * q * (1.0 + 0.8 * np.clip(p, -1.0, 1.0))  # pointed at the far end
        edge = np.clip((1.0 - inside) * across * size * 0.5 + 0.5, 0.0, 1.0)
        rib = 1.0 - 0.25 * np.exp(-((q * 5.0) ** 2))
        shade = np.where(edge > 0.5, tone * rib * (0.85 + 0.2 * np.clip(p, -1.0, 1.0)), shade)
        cover = np.maximum(cover, edge)
    return shade, cover


def _clump() -> tuple[NDArray, NDArray]:
    """Leaves of a broadleaved tree, thick in the middle."""
    rng = np.random.default_rng(31)
    marks = []
    for k in range(74):
        share = 1.0 - k / 74.0
        turn = rng.uniform(0.0, 2.0 * np.pi)
        reach = 0.36 * np.sqrt(share) * rng.uniform(0.75, 1.0)
        way = turn + rng.normal(0.0, 0.5)
        marks.append((0.5 + reach * np.cos(turn), 0.5 + reach * np.sin(turn),
                      rng.uniform(0.075, 0.115), rng.uniform(0.034, 0.052), way,
                      rng.uniform(0.32, 0.74)))  # fmt: skip
    return _ellipses(np.array(marks), SIZE)


def _spray() -> tuple[NDArray, NDArray]:
    """A spruce's branch from its root (v = 0) to its tip (v = 1)."""
    rng = np.random.default_rng(32)
    marks = [(0.5, 0.45, 0.47, 0.030, np.pi / 2.0, 0.38)]
    for k in range(34):
        v = 0.03 + 0.90 * k / 34.0
        for side in (-1.0, 1.0):
            length = 0.50 * (1.0 - 0.78 * v) * rng.uniform(0.72, 1.05) * min(1.0, 0.45 + 3.0 * v)
            turn = np.pi / 2.0 - side * rng.uniform(0.75, 1.05)
            x = 0.5 + 0.42 * length * np.cos(turn)
            y = v + 0.42 * length * np.sin(turn)
            marks.append((x, y, length * 0.5, rng.uniform(0.020, 0.030), turn,
                          rng.uniform(0.36, 0.68)))  # fmt: skip
    return _ellipses(np.array(marks), SIZE)


def leaf_levels() -> list[NDArray]:
    """Mip levels (h, 2 h, 2) u1: shade and coverage; left a clump of leaves, right a spray.

    Coverage is stretched in the coarser levels, so that trees do not thin out far away.
    """
    pairs = [np.stack(_clump(), -1), np.stack(_spray(), -1)]
    level = np.concatenate(pairs, axis=1)
    goal = [float((pair[..., 1] > 0.5).mean()) for pair in pairs]
    found = []
    while True:
        painted = level.copy()
        half = level.shape[0]
        for k, share in enumerate(goal):
            part = painted[:, k * half : (k + 1) * half, 1]
            edge = float(np.quantile(part, 1.0 - share))
            part[...] = np.clip(part - max(edge, 1e-3) + 0.5, 0.0, 1.0)
        painted[-1:, max(half - 1, 0) : half + 1] = (0.5, 1.0)  # SOLID
        found.append(np.round(painted * 255.0).astype("u1"))
        if half <= 8:
            return found
        level = level.reshape(half // 2, 2, half, 2, 2).mean((1, 3))
