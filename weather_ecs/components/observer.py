"""`Observer`: a place the weather is seen from."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from weather_ecs.components._base import FAR, Check, Component, vector


@dataclass(eq=False, slots=True)
class Observer(Component):
    """One viewer; `Weather.draw(..., observer=it)` draws the rain that belongs to it.

    Several make a split screen or the two eyes of a headset. A game with one camera needs none to
    draw. Events (thunder, the begin of rain) are those at `position`, which the game keeps up to
    date; drops are where the camera is.
    """

    position: tuple[float, float, float] = (0.0, 0.0, 0.0)  # m, world axes; each within 1e7

    checks: ClassVar[dict[str, Check]] = {"position": vector(3, -FAR, FAR)}
