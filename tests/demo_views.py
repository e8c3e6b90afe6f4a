"""Where the pictures of the demo's scene are taken from."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray


def look(eye: tuple[float, float, float], at: tuple[float, float, float]) -> NDArray:
    """(4, 4) view matrix."""
    forward = np.subtract(at, eye) / np.linalg.norm(np.subtract(at, eye))
    right = np.cross(forward, (0.0, 1.0, 0.0))
    right /= np.linalg.norm(right)
    view = np.eye(4)
    view[:3, :3] = np.stack([right, np.cross(right, forward), -forward])
    view[:3, 3] = -view[:3, :3] @ eye
    return view


def perspective(fov: float = 62.0, aspect: float = 16.0 / 9.0) -> NDArray:
    """(4, 4) projection matrix, near 0.1 m, far 6 km."""
    f = 1.0 / np.tan(np.radians(fov) / 2.0)
    near, far = 0.1, 6000.0
    m = np.zeros((4, 4))
    m[0, 0], m[1, 1], m[3, 2] = f / aspect, f, -1.0
    m[2, 2], m[2, 3] = (far + near) / (near - far), 2.0 * far * near / (near - far)
    return m
