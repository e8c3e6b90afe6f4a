"""Views of a few areas, and what of them is compared."""

from __future__ import annotations

import math

from tests.rain_frames import area
from weather_ecs.frame import DropLook, ViewData

LOOK = DropLook()
NEAR = area()
FAR = area(1, (0.0, -150.0))  # its rim is 110 m off, straight along -z
NORTH = math.pi / 2  # the heading of -z


def counts(view: ViewData) -> dict[int, float]:
    """Drops in use by area, both halves of a whole cylinder counted."""
    found: dict[int, float] = {}
    for container in view.containers:
        found[container.area] = found.get(container.area, 0.0) + container.count
    return found
