"""What stands near a place, for lightning that looks for its end."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from weather_ecs.components import Occluder
from weather_ecs.systems.queries import living

_NONE = np.zeros((0, 3))


def tips_near(x: float, z: float, reach: float) -> NDArray[np.float64]:
    """(n, 3) m: corners of the occluders' meshes near (x, z), and surfaces right below it.

    Occluders that draw themselves are not seen.
    """
    found: list[NDArray] = []
    radii: dict[int, float] = {}  # of the meshes, by identity: things share them
    for _, thing in living(Occluder):
        if thing.vertices is None or thing.indices is None or thing.transform is None:
            continue
        matrix = thing.transform
        size = radii.get(id(thing.vertices))
        if size is None:
            size = float(np.sqrt((thing.vertices.astype(np.float64) ** 2).sum(1).max(initial=0.0)))
            radii[id(thing.vertices)] = size
        wide = reach + size * float(np.linalg.norm(matrix[:3, :3]))
        if math.hypot(matrix[0, 3] - x, matrix[2, 3] - z) > wide:
            continue
        corners = thing.vertices @ matrix[:3, :3].T + matrix[:3, 3]
        near = np.hypot(corners[:, 0] - x, corners[:, 2] - z) <= reach
        found += [corners[near], surfaces_below(corners[thing.indices.reshape(-1, 3)], x, z)]
    return np.concatenate(found) if found else _NONE


def surfaces_below(triangles: NDArray, x: float, z: float) -> NDArray[np.float64]:
    """(n, 3): where the vertical through (x, z) meets triangles (t, 3, 3)."""
    a, b, c = triangles[:, 0], triangles[:, 1], triangles[:, 2]
    u, v = b - a, c - a
    twice = u[:, 0] * v[:, 2] - u[:, 2] * v[:, 0]
    px, pz = x - a[:, 0], z - a[:, 2]
    with np.errstate(divide="ignore", invalid="ignore"):
        s = (px * v[:, 2] - pz * v[:, 0]) / twice
        t = (u[:, 0] * pz - u[:, 2] * px) / twice
        hit = (s >= 0.0) & (t >= 0.0) & (s + t <= 1.0) & (twice != 0.0)
    height = a[hit, 1] + s[hit] * u[hit, 1] + t[hit] * v[hit, 1]
    return np.stack([np.full(len(height), x), height, np.full(len(height), z)], axis=1)
