"""`Climate`: the weather's way from one state to another."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from weather_ecs.components._base import Check, Component, flag, number

LONGEST = 1.0e9  # s


@dataclass(eq=False, slots=True)
class Climate(Component):
    """A variation of the state of the skies, linear in time (Torchelsen 2005, 3.4).

    After T = `elapsed` seconds of `duration` D the state is initial + (final - initial) T / D.
    While it is running, `elapsed` grows by `speed` seconds a second and stays within 0 and the
    duration; a game may set it to be at any point of the run. On a `SkyLayer`'s entity it is that
    layer's own, elsewhere the oldest entity's one is everybody's.
    """

    initial: float = 0.0  # 0 clear to 1 storm
    final: float = 1.0  # 0 clear to 1 storm
    duration: float = 600.0  # s, above 0, at most 1e9
    running: bool = True
    speed: float = 1.0  # -1e6 to 1e6; 2 is twice as fast, negative runs back
    elapsed: float = 0.0  # s, 0 to 1e9; beyond the duration it counts as the duration

    checks: ClassVar[dict[str, Check]] = {
        "initial": number(0.0, 1.0),
        "final": number(0.0, 1.0),
        "duration": number(0.0, LONGEST, above=True),
        "running": flag(),
        "speed": number(-1.0e6, 1.0e6),
        "elapsed": number(0.0, LONGEST),
    }
