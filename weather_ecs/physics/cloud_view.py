"""How clouds appear to a camera: which it sees, how large, and in which order they are drawn.

Everything is relative to the camera, world axes, metres.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from weather_ecs.physics.vectors import cross

# What of the columns x, y, z, w of the clip space makes the six sides; the last is put in apart.
_SIDES = np.array(
    [(1, 0, 0, 1), (-1, 0, 0, 1), (0, 1, 0, 1), (0, -1, 0, 1), (0, 0, 1, 1), (0, 0, 0, 1)],
    np.float64,
)


@dataclass(frozen=True, slots=True)
class Frustum:
    """What a camera sees as far as its reach."""

    planes: NDArray[np.float64]  # (6, 4): unit normal inwards and offset; a . p + d >= 0 inside
    center: NDArray[np.float64]  # (3,), of the sphere round it
    radius: float  # m


def frustum(view: NDArray, projection: NDArray, reach: float) -> Frustum:
    """The frustum of a camera, its far plane at `reach` m along the view axis.

    Hosts put their far plane behind their scene, which clouds are well beyond.
    """
    rotation = view[:3, :3]
    m = np.empty((4, 4))
    m[:, :3], m[:, 3] = projection[:, :3] @ rotation, projection[:, 3]
    forward = -rotation[2] / math.sqrt(rotation[2] @ rotation[2])
    planes = _SIDES @ m
    planes[5, :3], planes[5, 3] = -forward, reach
    planes /= np.sqrt((planes[:, :3] ** 2).sum(axis=1))[:, None]
    ahead, radius = _sphere(np.asarray(projection, np.float64).tobytes(), reach)
    return Frustum(planes, ahead * forward, radius)


@lru_cache(maxsize=16)
def _sphere(projection: bytes, reach: float) -> tuple[float, float]:
    """How far ahead of the camera the middle of the sphere round its frustum is, and its radius."""
    inverse = np.linalg.inv(np.frombuffer(projection).reshape(4, 4))
    signs = np.array([(x, y) for x in (-1.0, 1.0) for y in (-1.0, 1.0)])
    ends = []
    for depth in (-1.0, 0.0):
        clip = np.column_stack([signs, np.full(4, depth), np.ones(4)]) @ inverse.T
        ends.append(clip[:, :3] / clip[:, 3:])
    near, ray = ends[0], ends[1] - ends[0]
    far = near + ray * ((reach + near[:, 2]) / np.maximum(-ray[:, 2], 1e-12))[:, None]
    # Of the spheres about a point of the axis, the smallest through near and far corners.
    tn, tf = float(-near[:, 2].min()), reach
    rn, rf = float((near**2).sum(axis=1).max()), float((far**2).sum(axis=1).max())
    ahead = min(max((rf - rn) / max(2.0 * (tf - tn), 1e-9), 0.0), reach)
    corners = np.concatenate([near, far]) + (0.0, 0.0, ahead)
    return ahead, float(np.linalg.norm(corners, axis=1).max())


def visible(seen: Frustum, centers: NDArray, radii: NDArray) -> NDArray[np.bool_]:
    """Which spheres, centres (n, 3) and radii (n,), reach into the frustum, (n,).

    Torchelsen 2005, 3.2: against the frustum's own sphere first, then against the six planes.
    """
    away = centers - seen.center
    inside: NDArray[np.bool_] = np.einsum("ij,ij->i", away, away) <= (radii + seen.radius) ** 2
    found = np.flatnonzero(inside)
    distances = centers[found] @ seen.planes[:, :3].T + seen.planes[:, 3]
    inside[found] = (distances >= -radii[found, None]).all(axis=1)
    return inside


def draw_order(centers: NDArray, half_heights: NDArray) -> NDArray[np.intp]:
    """Back to front: layers of air that hold whole clouds first, then by distance.

    A wide sheet may be nearer by its centre than what floats under it, so clouds are put into
    layers, no cloud in two of them. From below the highest layer is farthest, from above the
    lowest; the camera's own comes last.
    """
    low, high = centers[:, 1] - half_heights, centers[:, 1] + half_heights
    by_low = np.argsort(low, kind="stable")
    tops = np.maximum.accumulate(high[by_low]) if len(low) else high
    begins = np.ones(len(low), bool)
    begins[1:] = low[by_low][1:] > tops[:-1]
    layer_sorted = np.cumsum(begins) - 1
    firsts = np.flatnonzero(begins)
    floor = low[by_low][firsts]
    ceiling = np.append(tops[firsts[1:] - 1], tops[-1:]) if len(firsts) else floor
    # How far the layer is from the camera's height; 0 where the camera is in it.
    apart = np.maximum(np.maximum(floor, -ceiling), 0.0)
    layer = np.empty(len(low))
    layer[by_low] = apart[layer_sorted]
    away = np.linalg.norm(centers, axis=1)
    return np.lexsort((-away, -layer))


def pixels_per_radian(projection: NDArray, height: int) -> float:
    """Pixels that a unit of width at unit depth takes, in a picture `height` pixels high."""
    return 0.5 * height * float(projection[1, 1])


def silhouette(center: NDArray, half: NDArray) -> tuple[NDArray, NDArray]:
    """Half width and half height, (n,), of boxes as they are seen from the camera.

    half: (n, 3) half sizes, of which the greater level one counts all round.
    """
    away = np.maximum(np.linalg.norm(center, axis=1), 1e-6)
    sine = center[:, 1] / away
    wide = np.maximum(half[:, 0], half[:, 2])
    high = np.sqrt((half[:, 1] ** 2) * (1.0 - sine**2) + (wide * sine) ** 2)
    return wide, high


def picture_axes(way: NDArray) -> tuple[NDArray, NDArray]:
    """Unit axes, right and up, of a picture taken along `way`, (3,); level where it can be."""
    level = math.hypot(float(way[0]), float(way[2]))
    right = np.array([-way[2], 0.0, way[0]]) / level if level > 1e-6 else np.array([0.0, 0.0, 1.0])
    return right, cross(right, way / np.linalg.norm(way))
