"""Camera matrices: OpenGL's right-handed axes, (4, 4) float64, matrix @ column vector."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

NEAR = 0.10  # m
FAR = 4000.0  # m, beyond the hills on the horizon
VFOV_MAXIMUM = math.radians(110.0)  # a tall, narrow window widens no further


@dataclass(frozen=True)
class Pose:
    """Where an eye is and where it looks."""

    eye: tuple[float, float, float]  # m, world axes
    yaw: float  # rad, 0 looks along -z, counter-clockwise seen from above
    pitch: float  # rad, positive looks up
    roll: float = 0.0  # rad, positive leans the head to the left


def look_direction(yaw: float, pitch: float) -> NDArray[np.float64]:
    """Unit vector a camera of that yaw and pitch looks along, shape (3,)."""
    flat = math.cos(pitch)
    return np.array((-math.sin(yaw) * flat, math.sin(pitch), -math.cos(yaw) * flat))


def yaw_pitch(direction: NDArray[np.float64]) -> tuple[float, float]:
    """Yaw and pitch that look along a direction (any length but 0)."""
    x, y, z = (float(value) for value in direction)
    return math.atan2(-x, -z), math.atan2(y, math.hypot(x, z))


def view_matrix(pose: Pose) -> NDArray[np.float64]:
    """World to eye."""
    fx, fy, fz = look_direction(pose.yaw, pose.pitch).tolist()
    rx, rz = math.cos(pose.yaw), -math.sin(pose.yaw)  # to the right, level
    ux, uy, uz = -rz * fy, rz * fx - rx * fz, rx * fy
    c, s = math.cos(pose.roll), math.sin(pose.roll)
    view = np.array(
        (
            (c * rx + s * ux, s * uy, c * rz + s * uz, 0.0),
            (c * ux - s * rx, c * uy, c * uz - s * rz, 0.0),
            (-fx, -fy, -fz, 0.0),
            (0.0, 0.0, 0.0, 1.0),
        )
    )
    view[:3, 3] = -view[:3, :3] @ np.asarray(pose.eye, np.float64)
    return view


def projection_matrix(
    hfov: float, aspect: float, near: float = NEAR, far: float = FAR
) -> NDArray[np.float64]:
    """Perspective of a horizontal field of view (rad) on a picture of width / height `aspect`."""
    tangent = math.tan(hfov / 2) / aspect
    tangent = min(tangent, math.tan(VFOV_MAXIMUM / 2))
    projection = np.zeros((4, 4))
    projection[0, 0] = 1.0 / (tangent * aspect)
    projection[1, 1] = 1.0 / tangent
    projection[2, 2] = (far + near) / (near - far)
    projection[2, 3] = 2.0 * far * near / (near - far)
    projection[3, 2] = -1.0
    return projection
