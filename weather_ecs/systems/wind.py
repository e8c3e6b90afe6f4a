"""`WindSystem`: the sum of all winds at a moment, and how it varies in space."""

from __future__ import annotations

import math

from weather_ecs.clock import STEP
from weather_ecs.components import Wind
from weather_ecs.frame import WindProfile
from weather_ecs.physics.gusts import gust_factor, gust_now, key_of, steady_now, veer_now
from weather_ecs.systems.queries import alive
from weather_ecs.systems.state import WeatherState

Vector = tuple[float, float, float]
Blowing = list[tuple[int, Wind]]  # winds by uid

REFERENCE = 10.0  # m above the ground, where winds are measured and `Wind.speed` holds (WMO)
CALM = WindProfile(reference=REFERENCE)


def winds_at(found: Blowing, seed: int, time: float) -> tuple[Vector, WindProfile]:
    """Sum of winds at the reference height, m/s in world axes, and its profile.

    Turbulence adds up as independent fluctuations do. Where winds differ in exponent, ground or
    scale, the profile has their mean, each by its present speed.
    """
    x = z = weight = exponent = ground = scale = spread = 0.0
    for uid, wind in found:
        speed, (dx, dz) = velocity_now(wind, key_of(seed, uid), time)
        x += dx * speed
        z += dz * speed
        share = max(speed, 1e-9)  # in a calm all count alike
        weight += share
        exponent += share * wind.exponent
        ground += share * wind.ground
        scale += share * wind.scale
        spread += (wind.turbulence * speed) ** 2
    if not found:
        return (0.0, 0.0, 0.0), CALM
    return (x, 0.0, z), WindProfile(
        REFERENCE, exponent / weight, ground / weight, math.sqrt(spread), scale / weight
    )


def velocity_now(wind: Wind, key: int, time: float) -> tuple[float, tuple[float, float]]:
    """Speed in m/s and direction of one wind at a time of the weather's clock."""
    speed = wind.speed * strength(wind, time)
    x, z = wind.direction
    if speed > 0.0:
        if wind.gustiness > 0.0:
            speed *= gust_factor(time, wind.gustiness, wind.interval, key)
        if wind.veer > 0.0:
            angle = wind.veer * veer_now(time, wind.veer_period, key)
            c, s = math.cos(angle), math.sin(angle)
            x, z = x * c + z * s, z * c - x * s
    return speed, (x, z)


def strength(wind: Wind, time: float) -> float:
    """What the law says at a time of the weather's clock, without unit."""
    if wind.law == "constant":
        return 1.0
    passed, (tc, _, t_max) = time - wind.start, wind.times
    if wind.period > 0.0 and passed > 0.0:
        passed = math.fmod(passed, max(wind.period, t_max))
    if wind.law == "steady":
        return steady_now(passed, wind.times, wind.coefficients)  # type: ignore[arg-type]
    a, b, c, d = wind.coefficients[:4]
    return gust_now(passed, tc, t_max, a, b, c, d)


def varies(found: Blowing) -> bool:
    """Whether any of the winds is another a moment later."""
    return any(
        wind.speed > 0.0 and (wind.law != "constant" or wind.gustiness > 0.0 or wind.veer > 0.0)
        for _, wind in found
    )


class WindSystem:
    """Sums the winds for the systems after it, at the end of the step."""

    def run(self, state: WeatherState) -> None:
        """Set `state.wind` and `state.profile`."""
        found = alive(Wind, state.uids)
        state.wind, state.profile = winds_at(found, state.seed, state.step * STEP)
