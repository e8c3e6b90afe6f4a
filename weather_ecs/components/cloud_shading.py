"""`CloudShading`: how clouds are lit and shown."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from weather_ecs.components._base import Check, Component, flag, number


@dataclass(eq=False, slots=True)
class CloudShading(Component):
    """Looks of all clouds. The oldest entity's one counts.

    The light always comes in by the absorption factor (Torchelsen 2005, 3.3); `plain` is his model
    and nothing else. The fields and their defaults are those of `weather_ecs.frame.CloudLook`.
    """

    plain: bool = False  # the dissertation's own light: no lining, bases, haze or relief
    rays: bool = False  # show the seeds and the rays along which absorption was computed
    silver: float = 1.0  # 0 to 10, strength of the lining towards the sun
    base: float = 1.0  # 0 to 1, darkness of the bases
    ambient: float = 1.0  # 0 to 10, factor on the light of sky and ground
    softness: float = 1.0  # 0 to 10, factor on the depth over which clouds fade at what they meet
    shadows: bool = True  # on the ground, for games whose shaders read them

    checks: ClassVar[dict[str, Check]] = {
        "plain": flag(),
        "rays": flag(),
        "silver": number(0.0, 10.0),
        "base": number(0.0, 1.0),
        "ambient": number(0.0, 10.0),
        "softness": number(0.0, 10.0),
        "shadows": flag(),
    }
