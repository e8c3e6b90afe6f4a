"""A camera read from a view and a projection matrix, as plain numbers.

Notation: forward f, right r, up u (world axes, unit); azimuth of a direction is its heading, so
that (x, z) = (cos h, -sin h), counter-clockwise seen from above.
"""

from __future__ import annotations

import math
from collections.abc import Sequence
from dataclasses import dataclass
from functools import lru_cache
from typing import Any

import numpy as np
from numpy.typing import NDArray

from weather_ecs.errors import InvalidValueError

VIEW = "a view for column vectors, last row 0, 0, 0, 1: neither transposed nor the projection"
LARGEST = 1e15  # so that a product of two matrices fits into the shaders' 32 bits


@dataclass(frozen=True, slots=True)
class Camera:
    """View and projection with what the rain needs of them; world axes, metres, radians."""

    view: NDArray  # (4, 4) float64, M @ column vector
    projection: NDArray  # (4, 4) float64
    position: tuple[float, float, float]
    heading: float  # of the view direction, counter-clockwise seen from above
    half_width: float  # rad, greatest azimuth between the view direction and what is in view


def matrix(value: Any, name: str) -> NDArray:
    """(4, 4) float64 from 16 column-major floats (a pyglet `Mat4`) or a (4, 4) array.

    Raises InvalidValueError where the shape is another one.
    """
    try:
        array = np.asarray(tuple(value) if isinstance(value, Sequence) else value, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise InvalidValueError(name, value, "16 column-major floats or a (4, 4) array") from error
    if array.shape == (16,):
        array = array.reshape(4, 4).T
    if array.shape != (4, 4):
        raise InvalidValueError(name, value, "16 column-major floats or a (4, 4) array")
    return array


def wrap_angle(angle: float) -> float:
    """The same angle in [-pi, pi)."""
    return (angle + math.pi) % (2.0 * math.pi) - math.pi


def camera_from(view: Any, projection: Any) -> Camera:
    """Camera of a view matrix (world to eye) and a projection matrix.

    Raises InvalidValueError for a wrong shape, numbers that are not finite, a singular matrix, or a
    view that is a projection or transposed.
    """
    given = {"view": view, "projection": projection}
    v, p = [matrix(value, name).tobytes() for name, value in given.items()]
    try:
        return _camera(v, p)
    except _UnusableError as error:
        raise InvalidValueError(error.name, given[error.name], error.allowed) from error


class _UnusableError(Exception):
    """A matrix that no camera has: its name and what is allowed."""

    def __init__(self, name: str, allowed: str) -> None:
        super().__init__(name)
        self.name, self.allowed = name, allowed


# A frame is often asked about with the same matrices again: prepared and drawn, or paused.
@lru_cache(maxsize=8)
def _camera(view: bytes, projection: bytes) -> Camera:
    """Of two (4, 4) float64 matrices row by row. Raises _UnusableError."""
    v, p = [np.frombuffer(data).reshape(4, 4) for data in (view, projection)]
    for name, array in (("view", v), ("projection", p)):
        # Of so few numbers numpy's sum takes longer. Of NaN the comparison is false.
        if not sum(map(abs, array.ravel().tolist())) <= LARGEST:
            raise _UnusableError(name, f"finite numbers, together at most {LARGEST:g}")
    *across, own = v[3].tolist()
    if max(map(abs, across)) > 1e-6 * abs(own):  # a projection's, or a transposed view's
        raise _UnusableError("view", VIEW)
    try:
        i = _inverse(v)
        singular = _singular(projection)
    except np.linalg.LinAlgError as error:
        raise _UnusableError("view", "an invertible matrix") from error
    if singular:
        raise _UnusableError("projection", "an invertible matrix")
    numbers = [abs(number) for row in i for number in row]
    if not math.isfinite(sum(numbers)) or max(numbers) > 1e12:
        raise _UnusableError("view", "an invertible matrix")
    position = (i[0][3], i[1][3], i[2][3])
    forward = (-i[0][2], -i[2][2])
    if math.hypot(*forward) < 1e-6:  # straight up or down: the top of the picture is ahead
        sign = 1.0 if i[1][2] > 0.0 else -1.0
        forward = (sign * i[0][1], sign * i[2][1])
    heading = math.atan2(-forward[1], forward[0])
    return Camera(v, p, position, heading, _half_width(i, p.tolist(), heading))


def _inverse(matrix: NDArray) -> list[list[float]]:
    """Of a (4, 4) matrix, row by row. A view's is affine, which is quicker without numpy.

    Raises LinAlgError where there is none.
    """
    (a, b, c, x), (d, e, f, y), (g, h, i, z), last = matrix.tolist()
    if last != [0.0, 0.0, 0.0, 1.0]:
        inverse: list[list[float]] = np.linalg.inv(matrix).tolist()
        return inverse
    p, q, r = e * i - f * h, f * g - d * i, d * h - e * g
    determinant = a * p + b * q + c * r
    if determinant == 0.0:
        raise np.linalg.LinAlgError("Singular matrix")
    k = 1.0 / determinant
    first = k * p, k * (c * h - b * i), k * (b * f - c * e)
    second = k * q, k * (a * i - c * g), k * (c * d - a * f)
    third = k * r, k * (b * g - a * h), k * (a * e - b * d)
    rows = [[u, v, w, -(u * x + v * y + w * z)] for u, v, w in (first, second, third)]
    return [*rows, last]


@lru_cache(maxsize=16)
def _singular(matrix: bytes) -> bool:
    """Of a (4, 4) float64 matrix row by row; projections seldom change."""
    return abs(float(np.linalg.det(np.frombuffer(matrix).reshape(4, 4)))) < 1e-30


def _half_width(inverse: list[list[float]], p: list[list[float]], heading: float) -> float:
    """Greatest azimuth offset of the frustum's corner rays from the heading, pi if unbounded."""
    if p[3][3] == 1.0:  # parallel rays: the frustum has no apex, so nothing bounds its azimuth
        return math.pi
    corners = []
    for sx in (-1.0, 1.0):
        for sy in (-1.0, 1.0):
            ex = (sx + p[0][2]) / p[0][0]
            ey = (sy + p[1][2]) / p[1][1]
            dx = inverse[0][0] * ex + inverse[0][1] * ey - inverse[0][2]
            dy = inverse[1][0] * ex + inverse[1][1] * ey - inverse[1][2]
            dz = inverse[2][0] * ex + inverse[2][1] * ey - inverse[2][2]
            corners.append((dx, dy, dz))
    c, s = math.cos(heading), math.sin(heading)
    widest = 0.0
    for dx, _, dz in corners:
        along, across = dx * c - dz * s, dx * s + dz * c
        widest = max(widest, abs(math.atan2(across, along)))
    return widest
