"""Rain, sleet or snow: wet-bulb temperature, and the share of what falls that is snow.

What falls takes on about the wet-bulb temperature T_w of the air it falls through, for the water
that leaves it cools it: dry air turns rain to snow a few degrees above freezing.
"""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import ArrayLike

from .checks import FloatArray, floats

LAPSE_RATE = 6.5e-3  # K/m, of the standard atmosphere's lowest 11 km (ISO 2533)
COLDEST, WARMEST = -20.0, 50.0  # degrees Celsius, range of Stull's fit
DRIEST, DAMPEST = 5.0, 99.0  # %, of the same
COLD_DRY = (27.7, -2.27)  # least % at 0 degrees, and its slope: the range's edge in cold air
CUT = 0.02  # share of rain or snow below which there is none


def wet_bulb(temperature: ArrayLike, humidity: ArrayLike) -> FloatArray:
    """Wet-bulb temperature at sea level from temperature (degrees Celsius) and humidity (0 to 1).

    Stull (2011, J. Appl. Meteor. Climatol. 50, 2267), a fit to measured tables, by his count -1 to
    0.65 K off it for -20 to 50 degrees, 5 to 99 % relative humidity and not less than about
    27.7 - 2.27 T %: cold and dry air is outside. There and beyond, the depression T - T_w is that
    at the nearest end of the range; from 99 to 100 % it goes to 0. Takes -100 to 100 degrees.
    """
    t = floats("temperature", temperature, -100.0, 100.0)
    rh = floats("humidity", humidity, 0.0, 1.0) * 100.0
    inside = np.clip(t, COLDEST, WARMEST)
    r = np.clip(np.maximum(rh, COLD_DRY[0] + COLD_DRY[1] * inside), DRIEST, DAMPEST)
    fit = (
        inside * np.arctan(0.151977 * np.sqrt(r + 8.313659))
        + np.arctan(inside + r)
        - np.arctan(r - 1.676331)
        + 0.00391838 * r**1.5 * np.arctan(0.023101 * r)
        - 4.686035
    )
    depression = np.maximum(inside - fit, 0.0) * np.clip(100.0 - rh, 0.0, 1.0)
    return np.asarray(t - depression)


def snow_share(wet_bulb_temperature: ArrayLike) -> FloatArray:
    """Share of the water that falls as snow, 0 to 1: at 0 degrees Celsius of wet bulb 0.85.

    Wang et al. (2019, Geophys. Res. Lett. 46, 13825): 1 / (1 + 6.99e-5 exp(2 (T_w + 3.97))), after
    the observations of Behrangi et al. (2018): half at 0.81 degrees. Its ends are stretched so that
    below -1.1 degrees there is snow only and above 2.8 rain only; between, both: sleet.
    """
    tw = floats("wet_bulb_temperature", wet_bulb_temperature, -200.0, 200.0)
    snow = 1.0 / (1.0 + 6.99e-5 * np.exp(2.0 * (tw + 3.97)))
    return np.asarray(np.clip((snow - CUT) / (1.0 - 2.0 * CUT), 0.0, 1.0))


def temperature_at(temperature: float, height: float) -> float:
    """Temperature `height` m above where it is `temperature`: 6.5 K less a kilometre up to 11 km.

    Above and more than 11 km below it stays, as in the standard atmosphere's next layer.
    """
    return temperature - LAPSE_RATE * min(max(height, -11_000.0), 11_000.0)


def temperatures_at(temperature: float, heights: FloatArray) -> FloatArray:
    """`temperature_at` for many heights."""
    return np.asarray(temperature - LAPSE_RATE * np.clip(heights, -11_000.0, 11_000.0))


def share_at(temperature: float, humidity: float) -> float:
    """`snow_share` of the wet bulb, for one point; temperatures beyond 100 degrees count as 100.

    At a tenth of their cost where one phase is the only one there can be.
    """
    snow, rain = _bounds(humidity)
    if temperature <= snow:
        return 1.0
    if temperature >= rain:
        return 0.0
    return float(snow_share(wet_bulb(temperature, humidity)))


def warmest_snow(humidity: float) -> float:
    """Temperature from which on there is rain only."""
    return _bounds(humidity)[1]


def shares_at(temperatures: FloatArray, humidity: float) -> FloatArray:
    """`share_at` for many points."""
    snow, rain = _bounds(humidity)
    shares = np.where(temperatures <= snow, 1.0, 0.0)
    both = (temperatures > snow) & (temperatures < rain)
    if both.any():
        shares[both] = snow_share(wet_bulb(temperatures[both], humidity))
    return shares


@lru_cache(maxsize=256)
def _bounds(humidity: float) -> tuple[float, float]:
    """Temperatures at and below which there is snow only, at and above which rain only."""
    t = np.linspace(-30.0, 60.0, 9001)  # a wet bulb of 2.8 degrees needs less, in the driest air
    share = snow_share(wet_bulb(t, humidity))
    return float(t[share >= 1.0][-1]), float(t[share <= 0.0][0])


def melting_height(temperature: float, humidity: float) -> float:
    """Height in m above the ground at which half of what falls is snow; negative below it.

    By the lapse rate and a humidity that stays; at most 11 km up or down.
    """
    low, high = -11_000.0, 11_000.0
    for _ in range(40):
        middle = 0.5 * (low + high)
        if share_at(temperature_at(temperature, middle), humidity) < 0.5:
            low = middle
        else:
            high = middle
    return high
