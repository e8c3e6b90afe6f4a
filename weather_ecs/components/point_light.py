"""`PointLight`: a lamp that lights the drops near it."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from weather_ecs.components._base import FAR, Check, Component, number, vector


@dataclass(eq=False, slots=True)
class PointLight(Component):
    """A lamp; its light fades to nothing at `reach`."""

    position: tuple[float, float, float] = (0.0, 0.0, 0.0)  # m, world axes; each within 1e7
    color: tuple[float, float, float] = (1.0, 1.0, 1.0)  # linear RGB times strength, 0 to 1e6
    reach: float = 12.0  # m, above 0, to 1e4

    checks: ClassVar[dict[str, Check]] = {
        "position": vector(3, -FAR, FAR),
        "color": vector(3, 0.0, 1.0e6),
        "reach": number(0.0, 1.0e4, above=True),
    }
