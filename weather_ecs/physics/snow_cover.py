"""How much snow lies: what falls collects, and above freezing it melts.

S is snow on a square metre in millimetres of water, s the mm/s of it that reach it and stay, m the
mm/s that melt where there is any:

    dS/dt = s - m while S > 0, and never below 0

which has a closed form as long as s and m are constant. `shaders/snow_cover.glsl` has the same
symbols. Melting is that of a game's minute and not of nature's afternoon, as is the drying of
`physics.wetness`; snow collects as fast as it falls.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from weather_ecs.physics.checks import FloatArray, floats

DENSITY = 100.0  # kg/m3 of snow that has just fallen: ten times as deep as its water
# Degree-day factor of snow, 4 mm of water a day and degree (Hock 2003 gives 2.5 to 5.5), in mm/s,
# sped up as much as drying is: a minute for an hour.
QUICKER = 60.0
DEGREE_DAY = 4.0 / 86_400.0 * QUICKER
STEEPEST, GENTLE = 0.5, 0.8  # upward parts of a normal on which no snow stays, and all of it
SOAKED = 0.5  # mm of melting snow that keep the ground as wet as it can be
COVERING = 3e-3  # m of depth after which two thirds of the ground no longer show


def melt_rate(wet_bulb: ArrayLike) -> FloatArray:
    """mm/s of water that snow loses at a wet-bulb temperature in degrees Celsius; 0 in frost."""
    return DEGREE_DAY * np.maximum(floats("wet_bulb", wet_bulb, -200.0, 200.0), 0.0)


def collect(snow: ArrayLike, inflow: ArrayLike, melt: float, seconds: float) -> FloatArray:
    """S in mm of water after some seconds; inflow s and melt m in mm/s."""
    grown = np.asarray(snow, np.float64) + (np.asarray(inflow, np.float64) - melt) * seconds
    return np.maximum(grown, 0.0)


def stays(up: ArrayLike) -> FloatArray:
    """Share of the snow that stays on a surface whose normal points up by `up`, 0 to 1."""
    share = np.clip((np.asarray(up, np.float64) - STEEPEST) / (GENTLE - STEEPEST), 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)


def depth(snow: ArrayLike) -> FloatArray:
    """Depth in m of S mm of water."""
    return np.asarray(snow, np.float64) / DENSITY


def cover(depth_m: ArrayLike) -> FloatArray:
    """Share of the ground that so deep a snow hides, 0 to 1."""
    return 1.0 - np.exp(-np.maximum(np.asarray(depth_m, np.float64), 0.0) / COVERING)
