"""Where a cloud's billboards are, how much of each is there, and how it faces the camera.

The same as shaders/cloud_row.glsl and shaders/cloud.vert. Places in m, world axes.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from weather_ecs.physics.vectors import cross

Array = NDArray[np.float64]

FADE = 0.3  # of the growth, over which one billboard comes or goes
NEAR = (0.20, 0.75)  # widths from the camera, between which a billboard fades
SQUARE = ((-1.0, -1.0), (1.0, -1.0), (-1.0, 1.0), (1.0, 1.0))  # corners of the whole image


def smoothstep(low: float, high: float, value: ArrayLike) -> Array:
    t = np.clip((np.asarray(value, np.float64) - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)


def presence(growth: ArrayLike, mode: ArrayLike, order: ArrayLike) -> Array:
    """0 to 1: how much of a billboard is there; growth 0: nothing, 1: all.

    mode 0: the highest orders go first when it dissolves, from the rim; 1: the lowest, the core.
    """
    mode, order = np.asarray(mode), np.asarray(order)
    turn = order * (1.0 - mode) + (1.0 - order) * mode
    return smoothstep(0.0, 1.0, (np.asarray(growth) * (1.0 + FADE) - turn) / FADE)


def place(
    p: Array, scale: float, mirror: float, heading: float, shear: tuple[float, float]
) -> Array:
    """A place of the shape in the cloud, m from its centre: scaled, mirrored, turned, leant."""
    c, s = np.cos(heading), np.sin(heading)
    x, y, z = (p[..., 0] * scale * mirror, p[..., 1] * scale, p[..., 2] * scale)
    return np.stack([x * c + z * s + shear[0] * y, y, z * c - x * s + shear[1] * y], axis=-1)


def shown_size(size: Array, scale: float, present: ArrayLike) -> Array:
    """(n, 2) width and height, m: smaller while it comes and goes."""
    shown: Array = size * scale * (0.55 + 0.45 * np.asarray(present))[..., None]
    return shown


def corners(
    at: Array,
    size: Array,
    turn: Array,
    mirror: ArrayLike,
    heading: ArrayLike,
    outline: ArrayLike = SQUARE,
) -> Array:
    """(n, k, 3) offsets of the corners of billboards at (n, 3) from the camera.

    Each stands for an ellipsoid as deep as it is wide: the image lies level for a viewer below and
    turns up towards one at its own height. size (n, 2); turn (n,) rad in the image's plane.
    outline: (k, 2), or (n, k, 2), of the image, -1 to 1.
    """
    c, s = np.cos(turn)[:, None], np.sin(turn)[:, None]
    flip = np.asarray(mirror, np.float64).reshape(-1, 1)
    heading = np.asarray(heading, np.float64).reshape(-1, 1)
    way = at / np.maximum(np.linalg.norm(at, axis=1, keepdims=True), 1e-3)
    level = np.hypot(way[:, 0], way[:, 2])
    flat = level > 1e-4
    ahead = np.where(
        flat[:, None], way[:, (0, 2)] / np.where(flat, level, 1.0)[:, None], (1.0, 0.0)
    )
    right = np.stack([-ahead[:, 1], np.zeros(len(at)), ahead[:, 0]], axis=1)
    up = cross(right, way)
    height = np.hypot(size[:, 1] * level, size[:, 0] * way[:, 1])
    outline = np.asarray(outline, np.float64)
    cx, cy = outline[..., 0], outline[..., 1]
    x, z = (cx * c - cy * s) * flip, cx * s + cy * c
    wx = x * np.cos(heading) + z * np.sin(heading)
    wz = z * np.cos(heading) - x * np.sin(heading)
    across = (wx * right[:, :1] + wz * right[:, 2:]) * (0.5 * size[:, :1])
    along = (wx * ahead[:, :1] + wz * ahead[:, 1:]) * (-0.5 * height[:, None])
    found: Array = right[:, None] * across[..., None] + up[:, None] * along[..., None]
    return found


def near_share(away: ArrayLike, width: ArrayLike) -> Array:
    """0 to 1: what is left of a billboard of a width at a distance from the camera."""
    return smoothstep(*NEAR, np.asarray(away) / np.maximum(np.asarray(width), 1e-3))
