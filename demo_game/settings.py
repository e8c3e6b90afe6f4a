"""What a player may choose; costs and comfort only, the weather itself is no setting."""

from __future__ import annotations

import math
from dataclasses import dataclass

QUALITIES = ("low", "medium", "high", "ultra", "auto")
BACKENDS = ("auto", "compute", "feedback")

SENSITIVITIES = (0.25, 0.5, 0.75, 1.0, 1.5, 2.0, 3.0)  # factors on LOOK_SPEED
FIELDS_OF_VIEW = (60, 70, 80, 90, 100, 110)  # degrees, horizontal
VOLUMES = tuple(range(0, 101, 10))  # % of the sound

LOOK_SPEED = math.radians(0.11)  # radians of turn per mouse count at sensitivity 1


@dataclass
class Settings:
    """One player's choices, changed by the pause menu and the command line."""

    quality: str = "auto"
    backend: str = "auto"
    sensitivity: float = 1.0  # factor, one of SENSITIVITIES in the menu
    invert: bool = False  # mouse up looks down
    field_of_view: float = 80.0  # degrees, horizontal
    fullscreen: bool = False
    volume: int = 80  # % of the sound, one of VOLUMES
    muted: bool = False

    @property
    def hfov(self) -> float:
        """Horizontal field of view in radians."""
        return math.radians(self.field_of_view)

    @property
    def look_speed(self) -> float:
        """Radians of turn per mouse count."""
        return LOOK_SPEED * self.sensitivity


def step(choices: tuple, value: object, by: int) -> object:
    """The choice `by` places on from `value`, wrapping; the first where `value` is none of them."""
    if value not in choices:
        return choices[0]
    return choices[(choices.index(value) + by) % len(choices)]
