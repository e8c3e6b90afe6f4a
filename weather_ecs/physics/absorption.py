"""Absorption of light in clouds: what a ray from each seed to the light crosses of all seeds.

After Torchelsen (2005), section 3.3: lengths inside all boxes are added, those of boxes that
overlap too. Rays and boxes meet by the slabs of T. L. Kay and J. T. Kajiya, "Ray tracing complex
scenes" (SIGGRAPH 1986).
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.checks import FloatArray, floats

_AT_ONCE = 1 << 20  # pairs of a ray and a box; bounds the memory


def path_lengths(
    centers: ArrayLike,
    sizes: ArrayLike,
    light_direction: ArrayLike,
    rows: slice | None = None,
) -> FloatArray:
    """Metres inside all boxes from each centre towards a light that is far away, (n,).

    `centers` and `sizes` (whole sides) are (n, 3); `light_direction` is any vector but zero. With
    `rows` only those seeds' rays are followed, through all boxes: a large cloud in several parts.
    """
    boxes, halves = _boxes(centers, sizes)
    direction = floats("light_direction", light_direction)
    if direction.shape != (3,) or not direction.any():
        raise InvalidValueError("light_direction", light_direction, "3 numbers, not all zero")
    origins = boxes if rows is None else boxes[rows]
    directions = np.broadcast_to(_unit(direction[None, :]), origins.shape)
    return _lengths(boxes, halves, origins, directions, np.full(len(origins), np.inf))


def path_lengths_to(
    centers: ArrayLike, sizes: ArrayLike, light_position: ArrayLike, rows: slice | None = None
) -> FloatArray:
    """Metres inside all boxes from each centre to a light near by, also inside the cloud, (n,)."""
    boxes, halves = _boxes(centers, sizes)
    light = floats("light_position", light_position)
    if light.shape != (3,):
        raise InvalidValueError("light_position", light_position, "3 numbers, metres")
    origins = boxes if rows is None else boxes[rows]
    way = light - origins
    greatest = np.abs(way).max(axis=1, initial=0.0)
    scaled = way / np.where(greatest > 0.0, greatest, 1.0)[:, None]  # squares cannot overflow
    distance = greatest * np.sqrt((scaled * scaled).sum(axis=1))
    # A ray of no length may point anywhere: it ends where it begins.
    way = np.where(distance[:, None] > 0.0, way, (0.0, 1.0, 0.0))
    return _lengths(boxes, halves, origins, _unit(way), distance)


def absorbed(path_lengths: ArrayLike, light_penetration: float) -> FloatArray:
    """Share of the light that is lost on its way, min(1, length / penetration), in [0, 1].

    An infinite `light_penetration` (m) loses nothing.
    """
    lengths = floats("path_lengths", path_lengths, 0.0)
    penetration = floats("light_penetration", light_penetration, 0.0, np.inf)
    if penetration.ndim or penetration == 0.0:
        raise InvalidValueError("light_penetration", light_penetration, "above 0, or infinite")
    with np.errstate(over="ignore"):
        return np.minimum(1.0, lengths / penetration)


def _boxes(centers: ArrayLike, sizes: ArrayLike) -> tuple[FloatArray, FloatArray]:
    middles, sides = floats("centers", centers), floats("sizes", sizes, 0.0)
    if not middles.size and not sides.size:  # no seeds, in whatever shape
        return np.zeros((0, 3)), np.zeros((0, 3))
    if middles.ndim != 2 or middles.shape[1] != 3:
        raise InvalidValueError("centers", middles.shape, "shape (n, 3), metres")
    if sides.shape != middles.shape:
        raise InvalidValueError("sizes", sides.shape, f"shape {middles.shape}, metres")
    return middles, 0.5 * sides


def _unit(vectors: FloatArray) -> FloatArray:
    scaled = vectors / np.abs(vectors).max(axis=1, keepdims=True)
    return scaled / np.sqrt((scaled * scaled).sum(axis=1, keepdims=True))


def _lengths(
    boxes: FloatArray,
    halves: FloatArray,
    origins: FloatArray,
    directions: FloatArray,
    ends: FloatArray,
) -> FloatArray:
    """Lengths inside all boxes of rays from `origins`, each followed as far as its end."""
    result = np.zeros(len(origins))
    step = max(1, _AT_ONCE // max(1, len(boxes)))
    for first in range(0, len(origins), step):
        part = slice(first, first + step)
        enter = np.zeros((len(result[part]), len(boxes)))
        leave = np.broadcast_to(ends[part, None], enter.shape)
        for axis in range(3):
            along = directions[part, axis, None]
            offset = boxes[None, :, axis] - origins[part, axis, None]
            half = halves[None, :, axis]
            # A ray in the plane of a face that two boxes share counts in one of them only.
            inside = (along == 0.0) & (-half < offset) & (offset <= half)
            with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
                one, other = (offset - half) / along, (offset + half) / along
            near = np.where(along == 0.0, np.where(inside, -np.inf, np.inf), np.fmin(one, other))
            far = np.where(along == 0.0, np.where(inside, np.inf, -np.inf), np.fmax(one, other))
            enter, leave = np.maximum(enter, near), np.minimum(leave, far)
        # At least one axis is far from parallel, so `leave` is finite or below every `enter`.
        result[part] = np.maximum(leave - enter, 0.0).sum(axis=1)
    return result
