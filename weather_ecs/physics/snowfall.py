"""A snowfall as a whole: how many flakes it has, what each carries, how much they cover."""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np

from .drops import WATER
from .snow import (
    SnowLaw,
    flake_size,
    flake_speed,
    melted_diameter,
    snow_extinction,
    snow_law,
)

PAPER_SIZE, PAPER_SIZE_SPREAD = 0.05, 0.01  # m, Liu and Tong's flakes; also in snow_law.glsl
PAPER_SPEED = 1.0  # m/s, their mean fall
_QUANTILES, _GROWTHS = 512, 48  # points that means over the flakes are taken at


class Snowfall(NamedTuple):
    """Means over all flakes in the air."""

    law: SnowLaw
    density: float  # flakes per m3 that carry exactly the rate
    water: float  # mm3 that a flake which lands carries on average
    speed: float  # m/s, mean fall of the flakes in the air
    cover: float  # share of its disc that a flake hides, so that all hide what snow does


@lru_cache(maxsize=256)
def snowfall(
    rate: float, wet: float = 0.0, temperature: float = -2.0, model: str = "physical"
) -> Snowfall:
    """Snow that falls at `rate` mm/h of water, 0 for none; see `snow_law`.

    The density is the rate over the water that one flake per m3 carries through a plane. The cover
    makes the flakes' discs hide `snow_extinction`; clumps are full of holes, and it is about a
    tenth to a third.
    """
    law = snow_law(rate, wet, temperature, model)
    u = (np.arange(_QUANTILES) + 0.5) / _QUANTILES
    at = (np.arange(_GROWTHS) + 0.5) / _GROWTHS
    diameter = melted_diameter(u, law)[:, None]
    if model == "physical":
        speeds = flake_speed(diameter, at, law)
        area = float((flake_size(diameter, at, law) ** 2).mean()) * 1e-6
    else:
        speeds = np.full((1, 1), PAPER_SPEED)
        area = PAPER_SIZE**2 + PAPER_SIZE_SPREAD**2 / 3.0
    carried = WATER * float((diameter**3 * speeds).mean())
    density, speed = max(rate, 0.0) / carried, float(speeds.mean())
    water = carried / (3600e-6 * speed)
    cover = 0.0
    if density > 0.0:
        cover = float(snow_extinction(rate)) / (density * 0.25 * math.pi * area)
    return Snowfall(law, density, water, speed, min(cover, 1.0))
