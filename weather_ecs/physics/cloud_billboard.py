"""Where a cloud's billboards are, how much of each is there, and how it faces the camera.

The same as shaders/cloud_row.glsl and shaders/cloud.vert. Places in m, world axes.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

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
    p: Array, scale: ArrayLike, mirror: ArrayLike, heading: ArrayLike, shear: ArrayLike
) -> Array:
    """A place of the shape in the cloud, m from its centre: scaled, mirrored, turned, leant.

    p: (..., 3); scale, mirror and heading: of all, or (...,) each; shear: (2,) or (2, ...).
    """
    c, s = np.cos(heading), np.sin(heading)
    lean, scale = np.asarray(shear), np.asarray(scale)
    x, y, z = (p[..., 0] * (scale * mirror), p[..., 1] * scale, p[..., 2] * scale)
    found = np.stack([x * c + z * s + lean[0] * y, y, z * c - x * s + lean[1] * y])
    return np.moveaxis(found, 0, -1)


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
    outline = np.asarray(outline, np.float64)
    x, y = half_axes(at.T, size.T, turn, mirror, heading)
    found: Array = outline[..., :1] * x.T[:, None] + outline[..., 1:] * y.T[:, None]
    return found


def half_axes(
    at: Array, size: Array, turn: Array, mirror: ArrayLike, heading: ArrayLike
) -> tuple[Array, Array]:
    """Half of an image's x and half of its y as they stand in the world, (3, n) each.

    at: (3, n), size: (2, n), as `corners` has them; mirror: 1 or -1.
    """
    x, y, z = at
    width, high = 0.5 * size[0], 0.5 * size[1]
    over = 1.0 / np.maximum(np.sqrt(x * x + y * y + z * z), 1e-3)
    wx, wy, wz = x * over, y * over, z * over
    level = np.sqrt(wx * wx + wz * wz)
    flat = level > 1e-4
    over = 1.0 / np.where(flat, level, 1.0)
    # Ahead is (ax, 0, az), right is (-az, 0, ax), up across both.
    ax, az = np.where(flat, wx * over, 1.0), np.where(flat, wz * over, 0.0)
    up = np.stack([-ax * wy, az * wz + ax * wx, -az * wy])
    height = np.sqrt((high * level) ** 2 + (width * wy) ** 2)
    # Turned with the image and, against that where it is mirrored, with the cloud.
    angle = turn - np.asarray(mirror) * heading
    c, s = np.cos(angle), np.sin(angle)
    found = []
    for px, pz in ((c * mirror, s), (-s * mirror, c)):
        across, along = (pz * ax - px * az) * width, -(px * ax + pz * az) * height
        axis = up * along
        axis[0] -= az * across
        axis[2] += ax * across
        found.append(axis)
    return found[0], found[1]


def near_share(away: ArrayLike, width: ArrayLike) -> Array:
    """0 to 1: what is left of a billboard of a width at a distance from the camera."""
    return smoothstep(*NEAR, np.asarray(away) / np.maximum(np.asarray(width), 1e-3))
