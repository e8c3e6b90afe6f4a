"""How much the sun throws shadows: what none would see need not be drawn."""

from __future__ import annotations

import math

from .environment import Environment

SUN_STRENGTH = 2.6  # of the sun against its colour
DULL = 1.5  # times the sky's light: under a weaker sun shadows are soft
FAINT = 0.4  # likewise: under a weaker one what moves throws none


def contrast(environment: Environment) -> float:
    """Light of a sun that is faced, in terms of the sky's."""
    above, level = environment.zenith_color, environment.horizon_color
    sky = max(a + b for a, b in zip(above, level, strict=True))
    return SUN_STRENGTH * max(environment.sun_color) / max(0.5 * sky, 1e-6)


def share(environment: Environment, x: float, z: float) -> float:
    """What rain areas leave of the sun at a place, 0 to 1; as light.glsl has it."""
    dim = 0.0
    for (middle_x, middle_z), (a, b), heading, rate, _ in environment.rain_areas:
        if rate <= 0.0:
            continue
        cos, sin = math.cos(heading), math.sin(heading)
        away_x, away_z = x - middle_x, z - middle_z
        r = math.hypot((away_x * cos - away_z * sin) / a, (away_x * sin + away_z * cos) / b)
        t = min(max((r - 0.72) / (1.35 - 0.72), 0.0), 1.0)
        dark = 0.35 + 0.5 * (1.0 - math.exp(-rate / 4.0))
        dim = max(dim, dark * (1.0 - t * t * (3.0 - 2.0 * t)))
    return 1.0 - 0.9 * dim


def is_dull(environment: Environment) -> bool:
    """Whether the sun is too weak for sharp shadows."""
    return contrast(environment) < DULL
