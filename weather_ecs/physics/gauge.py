"""What a rain gauge makes of drops of which each stands for many; metres, mm/h, mm3."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np

from weather_ecs.physics.drops import diameter_quantile, drop_density, terminal_speed

WANTED = 40_000.0  # drawn drops that cross the catch in a window, where it may grow for them
WIDEST = 0.35  # of the container's reach, that the radius of a catch may grow to
WATCHED = 0.8  # of it, within which drops are counted; in shaders/gauge.glsl too


@lru_cache(maxsize=256)
def landing_water(rain_rate: float) -> float:
    """mm3 that a drop which lands carries on average: rate over density and mean fall speed.

    A gauge counts drops and not their own water: of the drops of 25 mm/h the largest tenth carries
    half the water, and counting them alone takes eleven times as long for the same error.
    """
    speeds = terminal_speed(diameter_quantile((np.arange(512) + 0.5) / 512.0, rain_rate))
    return rain_rate / (3600e-6 * float(drop_density(rain_rate)) * float(speeds.mean()))


def catch_radius(
    opening: float,
    window: float,
    distance: float,
    reach: tuple[float, float],
    height: float,
    count: float,
    fall_speed: float,
) -> float:
    """Radius in m of the circle in which drops are counted: wide where the drawn ones are few.

    `opening` is the gauge's own radius, `distance` that of the gauge from the container's centre in
    shares of its reach (two semi-axes, m), where `count` drops stand as Eq. 2 has them.
    """
    d = min(max(distance, 0.05), 0.9)
    density = count * 2.0 * (1.0 - d) / (math.pi * d * reach[0] * reach[1])  # drops a m2
    crossings = density * fall_speed / height * window
    wanted = math.sqrt(WANTED / (math.pi * max(crossings, 1e-9)))
    return max(min(wanted, WIDEST * min(reach)), opening)


def catch_middle(forward: float, lateral: float, radius: float) -> tuple[float, float]:
    """Where the catch of a gauge lies, in shares of the container's reach, all along its own axes.

    Around the gauge; or, where that would stick out of the half disc in which drops are counted,
    as near to it as it fits in. Rain is as much there: what covers the gauge itself, and what the
    area's edge leaves, come in as factors. A gauge outside the container has its catch around it.
    """
    away = math.hypot(forward, lateral)
    if forward < 0.0 or away >= 1.0 or radius > 0.5 * WATCHED:
        return forward, lateral
    inner = WATCHED - radius
    if away > inner:
        forward, lateral = forward * inner / away, lateral * inner / away
    if forward < radius:
        widest = math.sqrt(inner * inner - radius * radius)
        return radius, min(max(lateral, -widest), widest)
    return forward, lateral
