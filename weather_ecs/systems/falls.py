"""What falls in an area: rain, snow, or in sleet both, each with its law and its share to show."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from weather_ecs.frame import RAIN, SNOW, AirData, DropLook, SnowLook
from weather_ecs.physics.container import size_factor, weight_shape
from weather_ecs.physics.drops import drop_density, extinction, terminal_speed
from weather_ecs.physics.front import steepness
from weather_ecs.physics.rain_step import law_of
from weather_ecs.physics.snow import snow_extinction
from weather_ecs.physics.snowfall import snowfall
from weather_ecs.physics.streak import BOLD, PROFILE

_HEAVY = 2.5  # mm/h of water, from which snow is heavy


class Fall(NamedTuple):
    """One kind of what falls in an area, where its rate is full."""

    kind: int  # RAIN or SNOW
    rate: float  # mm/h of water
    law: tuple[float, float, float, float]  # see `ContainerData`
    density: float  # drops or flakes per m3
    cover: float  # share of its disc that one hides
    extinction: float  # 1/m
    part: float  # of what there is to see of all kinds, 0 to 1
    busy: float = 1.0  # share of the drops it may have that it needs


@lru_cache(maxsize=256)
def falls(rate: float, air: AirData, look: SnowLook) -> tuple[Fall, ...]:
    """What falls where `rate` mm/h of water do; nothing where nothing falls.

    What there is to see is what light is lost to: the same water hides more as flakes.
    """
    snow_rate = rate * min(max(air.snow_share, 0.0), 1.0)
    rain_rate = rate - snow_rate
    found: list[Fall] = []
    if rain_rate > 0.0:
        lost, density = float(extinction(rain_rate)), float(drop_density(rain_rate))
        found.append(Fall(RAIN, rain_rate, law_of(rain_rate), density, 1.0, lost, 1.0))
    if snow_rate > 0.0:
        # What is half rain is snow that has half melted.
        fall = snowfall(snow_rate, 1.0 - air.snow_share, air.temperature, look.model)
        lost, law = float(snow_extinction(snow_rate)), fall.law[:4]
        # Nature has about as many flakes in light snow, but hardly any are seen: they are small.
        busy = min((snow_rate / _HEAVY) ** 0.4, 1.0)
        found.append(Fall(SNOW, snow_rate, law, fall.density, fall.cover, lost, 1.0, busy))
    total = sum(each.extinction for each in found)
    return tuple([each._replace(part=each.extinction / total) for each in found])


@lru_cache(maxsize=256)
def shown_distance(look: DropLook, rain_rate: float, count: int) -> float:
    """Distance (m) at which the share of the extinction that the drops show has fallen to 0.

    The share falls about linearly; the line has the integral that the share of a middling drop
    has: what a streak can show is its area times its greatest opacity.
    """
    d = np.linspace(0.01, 0.99, 33)
    # Of all drops, those of up to 2.67 over the slope take half of the light.
    diameter = min(max(2.67 / steepness(rain_rate), 0.7), 2.0) * 1e-3
    width = diameter * size_factor(d, look.size_maximum) * look.width
    load = float(drop_density(rain_rate)) * look.density * 0.7854 * diameter**2
    length = float(terminal_speed(diameter * 1e3)) * look.exposure
    area = PROFILE * width * np.maximum(length, width)  # as shaders/streak.geom
    return _shown(look, load, area, look.opacity ** max(BOLD / diameter, 1.0), count)


@lru_cache(maxsize=256)
def snow_shown_distance(look: DropLook, snow: SnowLook, fall: Fall, count: int) -> float:
    """The same of flakes, of the mean cross-section and as discs."""
    d = np.linspace(0.01, 0.99, 33)
    area = fall.extinction / max(fall.density * fall.cover, 1e-12)
    disc = area * (snow.size * size_factor(d, snow.size_maximum)) ** 2
    load = fall.extinction * snow.density
    return _shown(look, load, disc, snow.opacity, count)


def _shown(look: DropLook, load: float, area: np.ndarray, opacity: float, count: int) -> float:
    """load: m2 a m3 to be shown; area: m2, of one drop as drawn, at 33 distances."""
    d = np.linspace(0.01, 0.99, 33)
    load *= look.height * math.pi * look.reach**2 / (2.0 * max(count, 1))
    wanted = load * d / weight_shape(d) / area
    share = np.minimum(opacity / np.maximum(wanted, 1e-9), 1.0)
    # Near its rim the container thins out, whatever a streak could show.
    share *= np.minimum((1.0 - d) * 4.0, 1.0)
    return float(2.0 * share.mean() * look.reach)
