"""What `ellipse` does for many points, for one in plain floats: an observer has one place a frame.

Points are (x, z) in metres, radii (a, b) with a >= b > 0; nothing is checked.
"""

from __future__ import annotations

import math

from weather_ecs.physics.ellipse import NEGLIGIBLE

Point = tuple[float, float]

_ROUNDING = 8.0 * 2.0**-52


def nearest_point(at: Point, center: Point, radii: Point, heading: float) -> Point:
    """The perimeter point nearest to `at`; see `ellipse.nearest_perimeter_point`."""
    a, b = radii
    c, s = math.cos(heading), math.sin(heading)
    dx, dz = at[0] - center[0], at[1] - center[1]
    u, w = dx * c - dz * s, dx * s + dz * c
    excess = (a - b) * (a + b) / (b * b)
    ratio = 1.0 + excess
    along, across = abs(u) / a, abs(w) / b
    if across < NEGLIGIBLE:
        x = min(along * (ratio / excess), 1.0) if excess > 0.0 else 1.0
        y = math.sqrt((1.0 - x) * (1.0 + x))
    else:
        t = _root(along * ratio, across, excess)
        x, y = along * ratio / (t + excess), across / t
    length = math.hypot(x, y)  # 1 but for rounding: put the foot on the perimeter
    u, w = math.copysign(a * x / length, u), math.copysign(b * y / length, w)
    return u * c + w * s + center[0], w * c - u * s + center[1]


def _root(p: float, q: float, excess: float) -> float:
    """As `ellipse._root`, of one point."""
    t = low = max(q, p - excess)
    high = math.hypot(p, q)
    for _ in range(60):
        far, near = p / (t + excess), q / t
        norm = math.hypot(far, near)
        slope = (far / norm) ** 2 / (t + excess) + (near / norm) ** 2 / t
        step = min(max(t + (norm - 1.0) / slope, low), high)
        if abs(step - t) <= 4e-16 * t:
            return step
        t = step
    return t


def line_crossings(
    origin: Point, direction: Point, center: Point, radii: Point, heading: float
) -> list[Point]:
    """Where the line meets the perimeter, none to two, sorted along the direction, not zero.

    See `ellipse.line_intersections`.
    """
    a, b = radii
    c, s = math.cos(heading), math.sin(heading)
    longest = max(abs(direction[0]), abs(direction[1]))
    wx, wz = direction[0] / longest, direction[1] / longest
    dx, dz = origin[0] - center[0], origin[1] - center[1]
    ou, ow = (dx * c - dz * s) / a, (dx * s + dz * c) / b
    du, dw = (wx * c - wz * s) / a, (wx * s + wz * c) / b
    length = math.hypot(du, dw)
    offset = abs(ou * dw - ow * du) / length
    square = (1.0 - offset) * (1.0 + offset)
    middle = -(ou * du + ow * dw) / length / length
    rounding = _ROUNDING * (1.0 + math.hypot(dx, dz) / b)
    if square < -rounding:
        return []
    if square <= rounding:
        return [(origin[0] + middle * wx, origin[1] + middle * wz)]
    half = math.sqrt(square) / length
    ends = middle - half, middle + half
    return [(origin[0] + end * wx, origin[1] + end * wz) for end in ends]
