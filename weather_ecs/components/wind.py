"""`Wind`: a steady horizontal wind."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from weather_ecs.components._base import Check, Component, number, unit_vector


@dataclass(eq=False, slots=True)
class Wind(Component):
    """A wind over the whole world; several add up."""

    direction: tuple[float, float] = (1.0, 0.0)  # (x, z), where it blows to; kept at length 1
    speed: float = 0.0  # m/s, 0 to 150

    checks: ClassVar[dict[str, Check]] = {
        "direction": unit_vector(2),
        "speed": number(0.0, 150.0),
    }
