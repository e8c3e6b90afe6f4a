"""Looks and views of splashes."""

from __future__ import annotations

import math

from tests.rain_frames import camera, frame
from weather_ecs.frame import SplashLook, ViewData

LOOK = SplashLook()
NORTH = math.pi / 2  # the heading of -z


def view_at(
    position: tuple[float, float, float] = (0.0, 1.7, 3.0),
    pitch: float = -0.5,
    time: float = 100.0,
    **rest: object,
) -> ViewData:
    """Looking north and down at the origin."""
    at = camera(position, NORTH, pitch)
    seen = frame(time=time, **rest)
    return ViewData(seen, 0, at.view, at.projection, at.position, (0.0, 0.0, 0.0), 1 / 60, (), ())
