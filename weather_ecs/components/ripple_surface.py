"""`RippleSurface`: still water on which the rain makes rings."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from weather_ecs.components._base import (
    FAR,
    Check,
    Component,
    finite,
    flag,
    integer,
    number,
    vector,
)
from weather_ecs.errors import InvalidValueError

SHAPES = ("rectangle", "ellipse")
_LARGEST = 1.0e5  # m
_sides = vector(2, 1.0e-2, _LARGEST)


def _shape(field: str, value: Any) -> str:
    if not isinstance(value, str) or value not in SHAPES:
        raise InvalidValueError(field, value, " or ".join(SHAPES))
    return str(value)


@dataclass(eq=False, slots=True)
class RippleSurface(Component):
    """Level water: a pond, a basin, a reach of a river. Every drop that lands on it makes a ring.

    Rings are computed on cells of `cell` metres; where the water has more of them than the quality
    allows, on a window of it that goes with the observer, and what lies beyond shows its pattern
    again. The water catches the rain by itself: no occluder is needed for it.
    """

    center: tuple[float, float, float]  # (x, y, z), m; y is the water's height; each within 1e7
    size: tuple[float, float]  # m, along and across the heading; each 0.01 to 1e5
    heading: float = 0.0  # rad, counter-clockwise seen from above; 0 has the first side along +x
    shape: str = "rectangle"  # or "ellipse", inside that rectangle
    cell: float = 0.015  # m, 0.001 to 10; rings are about five cells from crest to crest
    speed: float = 0.3  # m/s, 0.01 to 10, of the rings
    damping: int = 5  # 5 to 9; a step takes 1 / 2**damping off the waves
    amplitude: float = 1.0  # 0 to 100, factor on the height of the waves
    color: tuple[float, float, float] = (0.030, 0.042, 0.036)  # linear RGB, 0 to 1, of deep water
    clarity: float = 0.45  # m, 0.001 to 1000, of water through which a third of the bottom shows
    draw: bool = True  # False: the game draws the water itself, see `Weather.ripples`
    catches_rain: bool = True  # False where the game's own occluders have the water's surface

    checks: ClassVar[dict[str, Check]] = {
        "center": vector(3, -FAR, FAR),
        "size": _sides,
        "heading": finite(),
        "shape": _shape,
        "cell": number(1.0e-3, 10.0),
        "speed": number(1.0e-2, 10.0),
        "damping": integer(5, 9),
        "amplitude": number(0.0, 100.0),
        "color": vector(3, 0.0, 1.0),
        "clarity": number(1.0e-3, 1000.0),
        "draw": flag(),
        "catches_rain": flag(),
    }
