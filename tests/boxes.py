"""Boxes that rain falls on: their meshes, and where falling lines meet them."""

from __future__ import annotations

import itertools
import math

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import OccluderData

# Corner k has the sign bits of k: x, y, z.
CORNERS = np.array(list(itertools.product((-1.0, 1.0), repeat=3)), np.float32)
_FACES = [(0, 1, 3, 2), (4, 5, 7, 6), (0, 1, 5, 4), (2, 3, 7, 6), (0, 2, 6, 4), (1, 3, 7, 5)]
TRIANGLES = np.array([(a, b, c, a, c, d) for a, b, c, d in _FACES], np.uint32).ravel()


def placed(
    center: tuple[float, float, float],
    half: tuple[float, float, float],
    turn: float = 0.0,
    tilt: float = 0.0,
) -> NDArray[np.float64]:
    """Transform of the box from -1 to 1 to these half sizes, tilted about x, turned about y."""
    c, s, ct, st = math.cos(turn), math.sin(turn), math.cos(tilt), math.sin(tilt)
    about_y = np.array([[c, 0, s], [0, 1, 0], [-s, 0, c]])
    about_x = np.array([[1, 0, 0], [0, ct, -st], [0, st, ct]])
    result = np.eye(4)
    result[:3, :3] = about_y @ about_x @ np.diag(half)
    result[:3, 3] = center
    return result


def box(key: int, transform: NDArray[np.float64], dynamic: bool = False) -> OccluderData:
    return OccluderData(key, transform, dynamic, CORNERS, TRIANGLES)


def highest(
    at: NDArray,
    slope: tuple[float, float],
    transforms: list[NDArray[np.float64]],
    raised: float = 0.0,
) -> NDArray[np.float64]:
    """Height at which lines of fall first meet a box, (n,); -inf where they meet none.

    at: (n, 2), where each line passes height 0; slope: horizontal metres per metre of fall;
    raised: m by which faces of more than 60 degrees count as higher than they are.
    """
    found = np.full(len(at), -np.inf)
    start = np.column_stack([at[:, 0], np.zeros(len(at)), at[:, 1], np.ones(len(at))])
    way = np.array([-slope[0], 1.0, -slope[1], 0.0])  # for a metre up
    for transform in transforms:
        inverse = np.linalg.inv(transform)
        o, d = (start @ inverse.T)[:, :3], (inverse @ way)[:3]
        low, high = np.full(len(at), -np.inf), np.full(len(at), np.inf)
        more = np.zeros((2, len(at)))  # of the faces at `low` and at `high`
        for axis in range(3):
            if abs(d[axis]) < 1e-12:
                outside = np.abs(o[:, axis]) > 1.0
                low = np.where(outside, np.inf, low)
                continue
            ends = np.sort(np.stack([(-1.0 - o[:, axis]), (1.0 - o[:, axis])]) / d[axis], axis=0)
            normal = inverse[axis, :3] / np.linalg.norm(inverse[axis, :3])
            own = raised if abs(normal[1]) < 0.5 else 0.0
            more = np.where([ends[0] > low, ends[1] < high], own, more)
            low, high = np.maximum(low, ends[0]), np.minimum(high, ends[1])
        top = np.maximum(low + more[0], high + more[1])
        found = np.where(low < high, np.maximum(found, top), found)
    return found
