"""How loud and of which colour rain, wind and thunder are; frequencies in Hz, arrays allowed.

Levels are root mean squares of a signal whose largest value is 1.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

RANGE = 0.75  # dB given for each dB heard outdoors: rooms are louder than a wood at night

LOUDEST_RATE = 150.0  # mm/h; more is not louder
LEVEL_AT_50 = 0.12  # of rain of 50 mm/h in the open
# A drop gives sound energy as the square of its momentum (m v)^2, and as many drops fall as
# N(D) v: with Marshall and Palmer's sizes (1948) and v as D^0.67 (Atlas and Ulbrich 1977) that
# is the 8.01st moment of the sizes, which goes as the rate to 0.21 * 9.01: 18.9 dB for ten times
# the rate. Measured A-levels under roofs are straight lines over the logarithm of the rate, too
# (natural rain noise, Applied Acoustics 2016).
RAIN_EXPONENT = 0.21 * 9.01

LEVEL_AT_20 = 0.15  # of wind of 20 m/s
STILL_AIR = 1.2  # m/s, below which one hears none
# Air that sheds eddies from leaves and twigs sounds as its speed to the sixth (Curle 1955), in a
# band about Strouhal's 0.2 v / d; over the ear it rumbles below that.
WIND_EXPONENT = 6.0
STROUHAL, TWIG = 0.2, 0.006  # 1, m
RUMBLE_SHARE, RUMBLE = 0.35, 14.0  # of the power; Hz for every m/s
FASTEST_WIND = 26.0  # m/s; more is not louder

OPEN_CORNER, LEAF_CORNER, ROOF_CORNER = 18000.0, 6000.0, 650.0  # Hz
ROOF_LOSS = 3.0  # dB of everything outside, beside the low-pass
DRUM_SHARE = 0.45  # of the power of rain in the open
LEAF_GAIN = 1.5  # of its power
SNOW_HALF = 0.02  # m of lying snow that swallow half of what falls

SOUND_SPEED = 340.0  # m/s
FARTHEST_THUNDER = 20_000.0  # m; one rarely hears it beyond (WMO Cloud Atlas)


def drop_slope(rate: float) -> float:
    """Marshall and Palmer's slope of the sizes in 1/mm at a rate in mm/h."""
    return 4.1 * max(rate, 0.05) ** -0.21


def loud_diameter(rate: float) -> float:
    """Diameter in mm of the drops that give most of the sound."""
    return min(9.01 / drop_slope(rate), 6.0)


def fall_speed(diameter: float | NDArray) -> NDArray:
    """m/s of a drop of a diameter in mm (Atlas, Srivastava and Sekhon 1973)."""
    return np.maximum(9.65 - 10.3 * np.exp(-0.6 * np.asarray(diameter)), 0.1)


def rain_level(rate: float) -> float:
    """Level of rain of a rate in mm/h in the open."""
    held = min(max(rate, 0.0), LOUDEST_RATE)
    return LEVEL_AT_50 * (held / 50.0) ** (RANGE * RAIN_EXPONENT / 2.0)


def rain_peak(rate: float) -> float:
    """Frequency about which rain hisses: v / D of its loud drops."""
    loud = loud_diameter(rate)
    return float(fall_speed(loud)) / (loud * 1e-3)


def rain_shape(f: NDArray, peak: float) -> NDArray:
    """Power over frequency of the bed of far drops, the largest value about 1."""
    x = f / peak
    return x / (1.0 + x * x) ** 1.25


def drum_shape(f: NDArray) -> NDArray:
    """Power over frequency of far drops on a roof of boards."""
    x = f / 260.0
    return x * x / (1.0 + x * x) ** 2.4


def wind_level(speed: float) -> float:
    """Level of wind of a speed in m/s at the ear."""
    held = min(speed, FASTEST_WIND)
    if held <= STILL_AIR:
        return 0.0
    begins = min((held - STILL_AIR) / 1.5, 1.0)
    return begins * LEVEL_AT_20 * (held / 20.0) ** (RANGE * WIND_EXPONENT / 2.0)


def wind_shape(f: NDArray, speed: float) -> NDArray:
    """Power over frequency of wind: rustle about Strouhal's frequency, and rumble below."""
    x = f / wind_band(speed)
    rustle = x * x / (1.0 + x * x) ** 2.2
    low = f / (RUMBLE * max(speed, 1.0))
    rumble = low / (1.0 + low) ** 4.3  # over the ear as f^-3.3 (Strasberg 1988)
    return (1.0 - RUMBLE_SHARE) * _even(rustle) + RUMBLE_SHARE * _even(rumble)


def wind_band(speed: float) -> float:
    """Frequency about which wind of a speed in m/s rustles."""
    return STROUHAL * max(speed, 1.0) / TWIG


def low_pass(f: NDArray, corner: float) -> NDArray:
    """Gain of amplitude of a low-pass of the second order without change of phase."""
    return 1.0 / np.sqrt(1.0 + (f / corner) ** 4)


def shelter_gain(f: NDArray, leaves: float, roof: float) -> NDArray:
    """Gain of amplitude for what is outside, under leaves and roof by 0 to 1 each."""
    octaves = leaves * math.log(LEAF_CORNER / OPEN_CORNER)
    octaves += roof * math.log(ROOF_CORNER / OPEN_CORNER)
    corner = OPEN_CORNER * math.exp(octaves)
    return 10.0 ** (-ROOF_LOSS * roof / 20.0) * low_pass(f, corner)


def snow_gain(depth: float) -> float:
    """Gain of power of what falls on lying snow of a depth in m."""
    return 1.0 / (1.0 + max(depth, 0.0) / SNOW_HALF)


def thunder_level(distance: float) -> float:
    """Largest value of thunder from a distance in m; fainter far away, but less than really."""
    return 0.95 * (1.0 + max(distance, 0.0) / 700.0) ** -0.75


def air_absorption(f: NDArray) -> NDArray:
    """dB per metre in air of 10 degrees Celsius and 80 % humidity (ISO 9613-1)."""
    t, ratio = 283.15, 283.15 / 293.15
    vapour = 80.0 * 10.0 ** (-6.8346 * (273.16 / t) ** 1.261 + 4.6151)  # % of molecules
    oxygen = 24.0 + 4.04e4 * vapour * (0.02 + vapour) / (0.391 + vapour)
    nitrogen = ratio**-0.5 * (9.0 + 280.0 * vapour * math.exp(-4.170 * (ratio ** (-1 / 3) - 1.0)))
    slow = 0.01275 * math.exp(-2239.1 / t) / (oxygen + f * f / oxygen)
    slow = slow + 0.1068 * math.exp(-3352.0 / t) / (nitrogen + f * f / nitrogen)
    return 8.686 * f * f * (1.84e-11 * ratio**0.5 + ratio**-2.5 * slow)


def _even(power: NDArray) -> NDArray:
    return power / power.sum()
