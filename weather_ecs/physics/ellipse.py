"""Ellipses on the ground: inside or not, nearest perimeter point, lines and rays through them.

Points are (x, z) in metres. `radii` are (a, b) with a >= b > 0; `heading` (rad, counter-clockwise
seen from above) turns the major axis to (x, z) = (cos h, -sin h). Every function takes one point,
shape (2,), or many, shape (n, 2), and raises InvalidValueError on radii that are not an ellipse's
and on NaN or infinity anywhere.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from weather_ecs.errors import InvalidValueError

from .checks import FloatArray, floats, number

THINNEST = 1e12  # a / b beyond this has no meaning in float64 metres
NEGLIGIBLE = 1e-150  # shares of a radius below this count as 0; their squares are still floats


def semi_axes(radii: ArrayLike) -> tuple[float, float]:
    """`radii` as two floats, checked: a >= b > 0, both finite."""
    array = floats("radii", radii)
    if array.shape != (2,) or not array[0] >= array[1] > 0.0:
        raise InvalidValueError("radii", radii, "(a, b), a >= b > 0, metres")
    a, b = float(array[0]), float(array[1])
    if a / b > THINNEST:
        raise InvalidValueError("radii", radii, f"a / b at most {THINNEST:g}")
    return a, b


def pairs(field: str, value: ArrayLike) -> FloatArray:
    """`value` as float64 of shape (2,) or (n, 2)."""
    array = floats(field, value)
    if array.ndim not in (1, 2) or array.shape[-1] != 2:
        raise InvalidValueError(field, value, "(x, z) or an array of them, shape (n, 2)")
    return array


def local(points: ArrayLike, center: ArrayLike, heading: float = 0.0) -> FloatArray:
    """World points in the ellipse's own axes: (u, w), u along the major axis."""
    c, s = _turn(heading)
    delta = pairs("points", points) - pairs("center", center)
    x, z = delta[..., 0], delta[..., 1]
    return np.stack((x * c - z * s, x * s + z * c), axis=-1)


def world(points: ArrayLike, center: ArrayLike, heading: float = 0.0) -> FloatArray:
    """The inverse of `local`."""
    c, s = _turn(heading)
    own = pairs("points", points)
    u, w = own[..., 0], own[..., 1]
    return np.stack((u * c + w * s, w * c - u * s), axis=-1) + pairs("center", center)


def implicit(
    points: ArrayLike, center: ArrayLike, radii: ArrayLike, heading: float = 0.0
) -> FloatArray:
    """Equation 1, f = (u/a)^2 + (w/b)^2: below 1 inside, 1 on the perimeter. Shape (n,) or ()."""
    scaled = local(points, center, heading) / semi_axes(radii)
    with np.errstate(over="ignore"):  # infinitely far outside is outside
        return np.square(scaled).sum(axis=-1)


def edge_distance(
    points: ArrayLike, center: ArrayLike, radii: ArrayLike, heading: float = 0.0
) -> FloatArray:
    """Metres inside the perimeter, to first order; negative outside.

    (1 - rho) rho / sqrt(u^2/a^4 + w^2/b^4) with rho = sqrt(f), which is (1 - rho) rho over half
    the length of f's gradient: exact for circles and along both axes, exact to first order at
    every perimeter point. At the centre, where the quotient is 0/0, it is b. The shaders use the
    same formula.
    """
    a, b = semi_axes(radii)
    scaled = local(points, center, heading) / (a, b)
    rho = np.hypot(scaled[..., 0], scaled[..., 1])
    slope = np.hypot(scaled[..., 0] / a, scaled[..., 1] / b)
    with np.errstate(divide="ignore", invalid="ignore"):
        span = np.where(rho > NEGLIGIBLE, rho / slope, b)
    return (1.0 - rho) * span


def edge_factor(
    points: ArrayLike,
    center: ArrayLike,
    radii: ArrayLike,
    heading: float = 0.0,
    soft_edge: float = 0.0,
) -> FloatArray:
    """Share of the rain rate that falls here: smoothstep(0, soft_edge, edge_distance), 0 outside.

    `soft_edge` in metres is clipped to b, so that the full rate is reached; 0 is a hard edge.
    """
    soft = min(number("soft_edge", soft_edge, 0.0, math.inf), semi_axes(radii)[1])
    distance = edge_distance(points, center, radii, heading)
    if soft == 0.0:
        return np.where(distance > 0.0, 1.0, 0.0)
    share = np.clip(distance / soft, 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)


def nearest_perimeter_point(
    point: ArrayLike, center: ArrayLike, radii: ArrayLike, heading: float = 0.0
) -> FloatArray:
    """The perimeter point nearest to each point, same shape; either one where two are as near.

    The foot (x, y) of the point (u, w) is x = u r / (t + r - 1), y = w / t with r = (a/b)^2 and t
    the root of (x/a)^2 + (y/b)^2 = 1 in a known bracket, as in Eberly, "Distance from a Point to
    an Ellipse, an Ellipsoid, or a Hyperellipsoid" (2013). The root is found by Newton's method on
    1/sqrt(F) - 1, which is concave and nearly straight (Moré and Sorensen 1983), so that the
    steps never leave the bracket's left part and a few of them suffice.
    """
    a, b = semi_axes(radii)
    own = local(point, center, heading)
    u, w = np.abs(own[..., 0]), np.abs(own[..., 1])
    excess = (a - b) * (a + b) / (b * b)  # r - 1, without cancellation
    ratio = 1.0 + excess
    along, across = u / a, w / b
    on_axis = across < NEGLIGIBLE
    # On the major axis, between the centres of curvature of its ends, the foot lies off the axis.
    if excess > 0.0:
        cosine = np.minimum(along * (ratio / excess), 1.0)
    else:
        cosine = np.ones_like(along)
    sine = np.sqrt((1.0 - cosine) * (1.0 + cosine))
    t = _root(along * ratio, np.where(on_axis, 1.0, across), excess)
    x = np.where(on_axis, cosine, along * ratio / (t + excess))
    y = np.where(on_axis, sine, across / t)
    length = np.hypot(x, y)  # 1 but for rounding: put the foot on the perimeter
    foot = np.stack(
        (np.copysign(a * x / length, own[..., 0]), np.copysign(b * y / length, own[..., 1])),
        axis=-1,
    )
    return world(foot, center, heading)


def line_intersections(
    origin: ArrayLike,
    direction: ArrayLike,
    center: ArrayLike,
    radii: ArrayLike,
    heading: float = 0.0,
) -> FloatArray:
    """Points (not parameters) where the infinite line meets the perimeter, shape (k, 2).

    k is 0 (the line misses), 1 (it touches, within rounding) or 2, sorted along the direction.
    `origin` and `direction` have shape (2,). Raises InvalidValueError on a direction of length 0.
    """
    start, way = pairs("origin", origin), pairs("direction", direction)
    if start.ndim != 1:
        raise InvalidValueError("origin", origin, "one point, shape (2,)")
    if way.ndim != 1 or not way.any():
        raise InvalidValueError("direction", direction, "one vector, shape (2,), not zero")
    way = way / np.abs(way).max()
    far = np.hypot(*(start - pairs("center", center))) / semi_axes(radii)[1]
    middle, half, square = _crossing(start, way, center, radii, heading)
    rounding = 8.0 * float(np.finfo(np.float64).eps) * (1.0 + float(far))
    if square < -rounding:
        return np.empty((0, 2))
    if square <= rounding:
        return (start + middle * way)[np.newaxis]
    return start + np.stack((middle - half, middle + half))[:, np.newaxis] * way


def chord(
    origin: ArrayLike,
    direction: ArrayLike,
    center: ArrayLike,
    radii: ArrayLike,
    heading: float = 0.0,
) -> tuple[FloatArray, FloatArray]:
    """Parameters (enter, leave) of rays from `origin`, in units of `direction`.

    A ray that starts inside enters at 0; one that misses, or has the ellipse behind it, gives
    (0, 0). Shapes broadcast: (2,) or (n, 2) each. A direction of length 0, the ground track of a
    vertical view ray, gives (0, inf) inside and (0, 0) outside.
    """
    start, way = np.broadcast_arrays(pairs("origin", origin), pairs("direction", direction))
    longest = np.abs(way).max(axis=-1)
    still = longest == 0.0
    unit = np.where(still[..., np.newaxis], 1.0, way) / np.where(still, 1.0, longest)[..., None]
    middle, half, square = _crossing(start, unit, center, radii, heading)
    inside = np.where(implicit(start, center, radii, heading) < 1.0, np.inf, 0.0)
    scale = np.where(still, 1.0, longest)
    enter = np.maximum(middle - half, 0.0) / scale
    leave = np.maximum(middle + half, 0.0) / scale
    hit = (square > 0.0) & (leave > 0.0) & ~still
    return np.where(hit, enter, 0.0), np.where(still, inside, np.where(hit, leave, 0.0))


def _turn(heading: float) -> tuple[float, float]:
    angle = number("heading", heading)
    return math.cos(angle), math.sin(angle)


def _crossing(
    start: FloatArray, way: FloatArray, center: ArrayLike, radii: ArrayLike, heading: float
) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Where lines cross the unit circle of the scaled axes: middle, half chord, 1 - distance^2."""
    axes = semi_axes(radii)
    o = local(start, center, heading) / axes
    d = local(way, (0.0, 0.0), heading) / axes
    length = np.hypot(d[..., 0], d[..., 1])
    offset = (o[..., 0] * d[..., 1] - o[..., 1] * d[..., 0]) / length
    square = (1.0 - np.abs(offset)) * (1.0 + np.abs(offset))
    middle = -(o[..., 0] * d[..., 0] + o[..., 1] * d[..., 1]) / length / length
    return middle, np.sqrt(np.maximum(square, 0.0)) / length, square


def _root(p: FloatArray, q: FloatArray, excess: float) -> FloatArray:
    """The t > 0 with (p / (t + excess))^2 + (q / t)^2 = 1, for p >= 0, q > 0, excess >= 0."""
    t = low = np.maximum(q, p - excess)  # one term alone reaches 1 here: the root is not below
    high = np.hypot(p, q)  # without `excess` the sum would reach 1 here: it is not above
    for _ in range(60):
        far, near = p / (t + excess), q / t
        norm = np.hypot(far, near)
        slope = (far / norm) ** 2 / (t + excess) + (near / norm) ** 2 / t
        step = np.clip(t + (norm - 1.0) / slope, low, high)
        settled = np.abs(step - t) <= 4e-16 * t
        t = step
        if np.all(settled):
            break
    return t
