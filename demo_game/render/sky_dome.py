"""The dome that the sky is shown on: fine where it changes fast, along the horizon."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

SECTORS = 36
# Degrees of elevation.
RINGS = (-90.0, -6.0, -1.5, 0.0, 1.0, 2.2, 4.0, 6.5, 10.0, 15.0, 22.0, 32.0, 46.0, 65.0, 90.0)
HIDDEN = 2  # of the lowest rings' bands, behind the ground
HIDDEN_FROM = 40.0  # m, below which an eye sees only ground there, as far as the hills reach
GLARE = 20.0  # degrees from the sun within which the sky is no ramp between a dome's corners


def _rim() -> NDArray:
    """(n, 3) a circle at GLARE from the sun: shares of the sun's direction and of two across it."""
    turn = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)
    # A little wider, for the sides of the polygon.
    reach = np.radians(GLARE) * 1.02
    along = np.full(len(turn), np.cos(reach))
    return np.stack([along, np.sin(reach) * np.cos(turn), np.sin(reach) * np.sin(turn)], 1)


_RIM = _rim()


def dome() -> tuple[NDArray, NDArray]:
    """(n, 3) f4 unit directions, and (m, 3) u4 triangles, from the lowest band up."""
    up = np.radians(RINGS)[:, None]
    around = np.linspace(0.0, 2.0 * np.pi, SECTORS + 1)[None]
    level = np.cos(up)
    directions = np.stack(
        [level * np.cos(around), np.sin(up) + 0.0 * around, level * np.sin(around)], -1
    )
    i, j = np.meshgrid(np.arange(SECTORS), np.arange(len(RINGS) - 1))
    a = (j * (SECTORS + 1) + i).ravel()
    b = a + SECTORS + 1
    triangles = np.stack([a, a + 1, b, b, a + 1, b + 1], 1).reshape(-1, 3)
    return directions.reshape(-1, 3).astype("f4"), triangles.astype("u4")


def first_index(height: float) -> int:
    """Where the indices begin of what an eye at a height, m, may see of the dome."""
    return 6 * SECTORS * HIDDEN if height < HIDDEN_FROM else 0


def glare_frame(to_clip: NDArray, sun: NDArray) -> tuple[float, float, float, float] | None:
    """Left, bottom, right, top, -1 to 1, of what of the picture is near the sun; None: nothing.

    to_clip: (4, 4), directions from the camera to clip space. sun: (3,), unit.
    """
    sx, sy, sz = sun.tolist()
    # Two directions across the sun's and each other's.
    x, y, z = (-sz, 0.0, sx) if abs(sy) < 0.9 else (0.0, sz, -sy)
    length = math.hypot(x, y, z)
    x, y, z = x / length, y / length, z / length
    other = (sy * z - sz * y, sz * x - sx * z, sx * y - sy * x)
    axes = np.array([(sx, sy, sz), (x, y, z), other])
    x, y, _, w = to_clip[:, :3] @ (_RIM @ axes).T + to_clip[:, 3:]
    if w.max() <= 1e-3:
        return None
    if w.min() <= 1e-3:
        return (-1.0, -1.0, 1.0, 1.0)
    x, y = x / w, y / w
    left, right = max(float(x.min()), -1.0), min(float(x.max()), 1.0)
    bottom, top = max(float(y.min()), -1.0), min(float(y.max()), 1.0)
    if left >= right or bottom >= top:
        return None
    return left, bottom, right, top
