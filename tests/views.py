"""View and projection matrices for tests, (4, 4) for column vectors."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray


def perspective(
    vertical: float = 60.0, aspect: float = 16 / 9, near: float = 0.1, far: float = 2000.0
) -> NDArray:
    """Vertical field of view in degrees."""
    t = 1.0 / math.tan(math.radians(vertical) / 2.0)
    return np.array(
        [
            [t / aspect, 0, 0, 0],
            [0, t, 0, 0],
            [0, 0, -(far + near) / (far - near), -2 * far * near / (far - near)],
            [0, 0, -1, 0],
        ]
    )


def look_from(position: tuple[float, float, float], heading: float, pitch: float = 0.0) -> NDArray:
    """From a place along a heading (counter-clockwise from above, 0 along +x), pitched up."""
    ch, sh, cp, sp = math.cos(heading), math.sin(heading), math.cos(pitch), math.sin(pitch)
    forward = np.array([ch * cp, sp, -sh * cp])
    right = np.array([sh, 0.0, ch])
    up = np.cross(right, forward)
    view = np.eye(4)
    view[:3, :3] = [right, up, -forward]
    view[:3, 3] = -view[:3, :3] @ np.array(position, float)
    return view
