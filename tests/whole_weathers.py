"""Names of the whole weathers, and time that passes over them."""

from __future__ import annotations

import esper

from weather_ecs.weathers import WEATHERS

NAMES = list(WEATHERS)


def rain(seconds: float, step: float = 0.5) -> None:
    for _ in range(round(seconds / step)):
        esper.process(step)
