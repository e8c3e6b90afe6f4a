"""`SplashEmitter`: what the rain's drops make where they hit something."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import ClassVar

from weather_ecs.components._base import Check, Component, number


@dataclass(eq=False, slots=True)
class SplashEmitter(Component):
    """Looks of the splashes; the oldest entity's one counts. Without any there are none.

    Every drop that hits something makes one. The fields and their defaults are those of
    `weather_ecs.frame.SplashLook`.
    """

    size: float = 26.0  # 0 to 200, factor on the radius to which the drop's water spreads
    largest: float = 0.12  # m, 0.001 to 10, radius that no crown exceeds
    duration: float = 0.3  # s, 0.02 to 5, from the hit until the crown has sunk
    opacity: float = 0.85  # 0 to 1, greatest of one splash
    share: float = 0.005  # 0 to 1, of the real drops whose splash is shown full-grown
    droplets: float = 4.0  # 0 to 5, mean number that one splash throws
    droplet_size: float = 4.5  # mm, 0.1 to 100, as they are drawn
    droplet_speed: float = 0.28  # 0 to 1, of the drop's own speed at the hit
    spread: float = 0.7  # rad, 0 to pi/2, greatest angle between a droplet's way and the normal
    drift: float = 0.3  # 0 to 1, share of the wind that there is so close to the surface
    detail: float = 9.0  # m, 0 to 100, distance up to which droplets and films are drawn

    checks: ClassVar[dict[str, Check]] = {
        "size": number(0.0, 200.0),
        "largest": number(0.001, 10.0),
        "duration": number(0.02, 5.0),
        "opacity": number(0.0, 1.0),
        "share": number(0.0, 1.0),
        "droplets": number(0.0, 5.0),
        "droplet_size": number(0.1, 100.0),
        "droplet_speed": number(0.0, 1.0),
        "spread": number(0.0, 0.5 * math.pi),
        "drift": number(0.0, 1.0),
        "detail": number(0.0, 100.0),
    }
