"""`RainArea`: an ellipse on the ground under which it rains."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from weather_ecs.components._base import (
    FAR,
    Check,
    Component,
    Limits,
    finite,
    limited,
    number,
    to_floats,
    vector,
)
from weather_ecs.errors import InvalidValueError

SMALLEST_RADIUS = 1.0e-3  # m
GREATEST_RADIUS = 1.0e6  # m
FASTEST = 150.0  # m/s, beyond the strongest wind ever measured at the ground


def _radii(field: str, value: Any) -> tuple[float, ...]:
    allowed = f"(a, b) with {GREATEST_RADIUS:g} >= a >= b >= {SMALLEST_RADIUS:g}"
    a, b = to_floats(field, value, 2, allowed)
    if not GREATEST_RADIUS >= a >= b >= SMALLEST_RADIUS:
        raise InvalidValueError(field, value, allowed)
    return a, b


@dataclass(eq=False, slots=True)
class RainArea(Component):
    """A horizontal ellipse of rain, from its ceiling down (Puig-Centelles et al. 2008, Eq. 1).

    Areas may overlap (their rates add), move, and come and go between any two frames. A new area
    has had its rain for ever; one whose rate rises from 0, or falls to 0, lives through the begin
    and the end of a shower: the drops take their time from the ceiling to the ground, large ones
    the least. `onset` is the share of that time: 1 is nature's, in which the first drops take 43 s
    from 400 m; 0 is none. Other changes of the rate count at once.
    """

    center: tuple[float, float]  # (x, z), m, world axes; each within 1e7
    radii: tuple[float, float]  # (a, b), m, along and across the heading; 1e6 >= a >= b >= 1e-3
    rain_rate: float = 5.0  # mm/h, 0 to 10000
    heading: float = 0.0  # rad, counter-clockwise seen from above; 0 has a along +x
    soft_edge: float = 10.0  # m, 0 to 1e6, inside the ellipse; counts up to b
    ceiling: float = 400.0  # m, world height the rain falls from; within 1e5
    velocity: tuple[float, float] = (0.0, 0.0)  # (x, z), m/s, each within 150
    drift: float = 0.0  # 0 to 1: share of the wind's speed that carries the area
    onset: float = 0.1  # 0 to 1: share of the drops' fall time that a shower's begin and end take

    checks: ClassVar[dict[str, Check]] = {
        "center": vector(2, -FAR, FAR),
        "radii": limited(_radii, Limits("vector", SMALLEST_RADIUS, GREATEST_RADIUS, size=2)),
        "rain_rate": number(0.0, 1.0e4),
        "heading": finite(),
        "soft_edge": number(0.0, 1.0e6),
        "ceiling": number(-1.0e5, 1.0e5),
        "velocity": vector(2, -FASTEST, FASTEST),
        "drift": number(0.0, 1.0),
        "onset": number(0.0, 1.0),
    }
