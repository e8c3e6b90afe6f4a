"""`Sun`: the light of sun, sky and ground."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from weather_ecs.components._base import Check, Component, unit_vector, vector

Color = tuple[float, float, float]


@dataclass(eq=False, slots=True)
class Sun(Component):
    """Day light, linear RGB, each channel 0 to 1000. The oldest entity's one counts."""

    direction: tuple[float, float, float] = (0.35, 0.8, 0.48)  # towards the sun, kept at length 1
    color: Color = (1.0, 0.95, 0.86)  # of the sun on a surface that faces it
    zenith_color: Color = (0.36, 0.47, 0.62)  # of the sky overhead
    horizon_color: Color = (0.68, 0.73, 0.78)  # of the sky at the horizon
    ground_color: Color = (0.20, 0.20, 0.17)  # that the ground sends back

    checks: ClassVar[dict[str, Check]] = {
        "direction": unit_vector(3),
        "color": vector(3, 0.0, 1000.0),
        "zenith_color": vector(3, 0.0, 1000.0),
        "horizon_color": vector(3, 0.0, 1000.0),
        "ground_color": vector(3, 0.0, 1000.0),
    }
