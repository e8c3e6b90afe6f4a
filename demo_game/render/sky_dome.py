"""The dome that the sky is shown on: fine where it changes fast, along the horizon."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

SECTORS = 36
# Degrees of elevation.
RINGS = (-90.0, -6.0, -1.5, 0.0, 1.0, 2.2, 4.0, 6.5, 10.0, 15.0, 22.0, 32.0, 46.0, 65.0, 90.0)
GLARE = 20.0  # degrees from the sun within which the sky is no ramp between a dome's corners


def dome() -> tuple[NDArray, NDArray]:
    """(n, 3) f4 unit directions, and (m, 3) u4 triangles."""
    up = np.radians(RINGS)[:, None]
    around = np.linspace(0.0, 2.0 * np.pi, SECTORS + 1)[None]
    level = np.cos(up)
    directions = np.stack(
        [level * np.cos(around), np.sin(up) + 0.0 * around, level * np.sin(around)], -1
    )
    i, j = np.meshgrid(np.arange(SECTORS), np.arange(len(RINGS) - 1))
    a = (j * (SECTORS + 1) + i).ravel()
    b = a + SECTORS + 1
    triangles = np.concatenate([np.stack([a, a + 1, b], 1), np.stack([b, a + 1, b + 1], 1)])
    return directions.reshape(-1, 3).astype("f4"), triangles.astype("u4")


def glare_frame(to_clip: NDArray, sun: NDArray) -> tuple[float, float, float, float] | None:
    """Left, bottom, right, top, -1 to 1, of what of the picture is near the sun; None: nothing.

    to_clip: (4, 4), directions from the camera to clip space. sun: (3,), unit.
    """
    aside = np.cross(sun, (0.0, 1.0, 0.0) if abs(sun[1]) < 0.9 else (1.0, 0.0, 0.0))
    aside /= np.linalg.norm(aside)
    other = np.cross(sun, aside)
    turn = np.linspace(0.0, 2.0 * np.pi, 24, endpoint=False)[:, None]
    # A little wider, for the sides of the polygon.
    reach = np.radians(GLARE) * 1.02
    rim = np.cos(reach) * sun + np.sin(reach) * (np.cos(turn) * aside + np.sin(turn) * other)
    x, y, _, w = to_clip @ np.column_stack([rim, np.ones(len(rim))]).T
    ahead = w > 1e-3
    if not ahead.any():
        return None
    if not ahead.all():
        return (-1.0, -1.0, 1.0, 1.0)
    low_x, high_x = np.clip([np.min(x / w), np.max(x / w)], -1.0, 1.0)
    low_y, high_y = np.clip([np.min(y / w), np.max(y / w)], -1.0, 1.0)
    if low_x >= high_x or low_y >= high_y:
        return None
    return float(low_x), float(low_y), float(high_x), float(high_y)
