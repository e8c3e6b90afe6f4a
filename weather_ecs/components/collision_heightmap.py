"""`CollisionHeightmap`: what the rain can hit, and how finely."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from weather_ecs.components._base import Check, Component, integer, number

ALL_LAYERS = 2**32 - 1


@dataclass(eq=False, slots=True)
class CollisionHeightmap(Component):
    """How the map of what rain hits is made; how large it is, is the quality's affair.

    The oldest entity's one counts; without any the defaults hold.
    """

    resolution: float = 1.0  # 0.125 to 4, factor on the texels a side that the quality gives
    extent: float = 1.25  # 1.05 to 8, half of its side over the rain container's reach
    layers: int = ALL_LAYERS  # bit mask, 0 to 2**32 - 1; rain passes occluders on none of these

    checks: ClassVar[dict[str, Check]] = {
        "resolution": number(0.125, 4.0),
        "extent": number(1.05, 8.0),
        "layers": integer(0, ALL_LAYERS),
    }
