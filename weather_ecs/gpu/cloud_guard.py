"""The plane before the clouds of a canvas: what of the scene is nearer hides them sharply."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import ViewData

NEAREST = 4.0  # m, of a guard

Floats = NDArray[np.float64]
Plane = tuple[Floats, float]  # normal . p = distance


def guard_of(center: Floats, half: Floats, lowest: Floats) -> tuple[int, Plane]:
    """How many of the clouds one plane keeps from the camera, and the farthest such plane.

    It lies below them all, above, or across the way to them. lowest: m over the camera, which
    nothing of them is below; -inf where their boxes tell.
    """
    way = center.mean(axis=0)
    way = way / max(float(np.linalg.norm(way)), 1e-6)
    normals = np.array([(0.0, 1.0, 0.0), (0.0, -1.0, 0.0), way])
    distances = center @ normals.T - half @ np.abs(normals).T
    distances[:, 0] = np.maximum(distances[:, 0], lowest)
    np.minimum.accumulate(distances, out=distances)
    held = int((distances >= NEAREST).any(axis=1).sum())
    if not held:
        return 0, (way, 0.0)
    last = distances[held - 1]
    along = np.where(last >= NEAREST, last / np.maximum(normals @ way, 0.02), -1.0)
    best = int(np.argmax(along))
    return held, (normals[best], float(last[best]))


def depth_of(view: ViewData, plane: Plane) -> tuple[float, float, float]:
    """Depth of a plane in the picture, -1 to 1, which changes evenly: by x, by y, in the middle."""
    normal, distance = plane
    p = view.projection
    x, y, z = view.view[:3, :3] @ normal
    share = p[2, 3] / distance
    across = share * x / p[0, 0], share * y / p[1, 1]
    middle = share * (x * p[0, 2] / p[0, 0] + y * p[1, 2] / p[1, 1] - z) - p[2, 2]
    return float(across[0]), float(across[1]), float(middle)
