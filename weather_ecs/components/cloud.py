"""`Cloud`: one cloud that stands in the world."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from weather_ecs.components._agreeing import NAME, a_name, part
from weather_ecs.components._base import (
    FAR,
    Check,
    Component,
    finite,
    integer,
    vector,
)
from weather_ecs.components._base import (
    number as one_number,
)
from weather_ecs.components.cloud_model import CloudModel
from weather_ecs.components.rain_area import FASTEST

_ALLOWED = f"a CloudModel, or {NAME}"
_name = a_name()


def a_model(field: str, value: Any) -> CloudModel | str:
    """A check for a model or the name of one."""
    if isinstance(value, str):
        return _name(field, value)
    return part(CloudModel, field, value, _ALLOWED)


@dataclass(eq=False, slots=True)
class Cloud(Component):
    """One cloud, made by the game; those of a `SkyLayer` need no component.

    `model` may be the name of a `CloudModel` of the world, or of one of the package's. The same
    model and number always give the same cloud.
    """

    model: CloudModel | str
    position: tuple[float, float, float]  # m, the middle of the cloud's base; each within 1e7
    number: int = 0  # which of the clouds that the model gives, 0 to 2**31 - 1
    scale: float = 1.0  # factor on all lengths, 0.001 to 1000
    heading: float = 0.0  # rad, counter-clockwise seen from above
    velocity: tuple[float, float] = (0.0, 0.0)  # (x, z), m/s, each within 150
    drift: float = 1.0  # 0 to 1: share of the wind at its height that carries the cloud
    shear: tuple[float, float] = (0.0, 0.0)  # (x, z), m of lean per m of height, each within 10
    growth: float = 1.0  # 0 gone to 1 whole
    hollow: float = 0.0  # how it comes and goes: 0 from the rim inwards, 1 from the inside out
    opacity: float = 1.0  # 0 to 1

    checks: ClassVar[dict[str, Check]] = {
        "model": a_model,
        "position": vector(3, -FAR, FAR),
        "number": integer(0, 2**31 - 1),
        "scale": one_number(1.0e-3, 1.0e3),
        "heading": finite(),
        "velocity": vector(2, -FASTEST, FASTEST),
        "drift": one_number(0.0, 1.0),
        "shear": vector(2, -10.0, 10.0),
        "growth": one_number(0.0, 1.0),
        "hollow": one_number(0.0, 1.0),
        "opacity": one_number(0.0, 1.0),
    }
