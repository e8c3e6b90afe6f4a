"""Scenes for the renderer: rain near and far."""

from __future__ import annotations

import math
from typing import Any

import numpy as np

from tests.rain_frames import camera
from weather_ecs.components import RainArea

NORTH = math.pi / 2


def near(**changes: Any) -> RainArea:
    """Rain around the origin."""
    return RainArea(**{"center": (0, 0), "radii": (60, 40), "rain_rate": 25.0, **changes})


def far(**changes: Any) -> RainArea:
    """Rain straight along -z, its rim 80 m off."""
    return near(**{"center": (0, -120), **changes})


# Bad input


def matrices() -> tuple[np.ndarray, np.ndarray]:
    at = camera()
    return at.view, at.projection
