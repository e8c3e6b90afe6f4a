"""Snow in the air: what it hides, and the numbers, sizes, kinds and speeds of its flakes.

Flakes are measured by the diameter D of the drop they melt to, in mm; rates R are mm/h of water.
Sizes follow Gunn and Marshall (1958), N(D) = N0 exp(-L D) with N0 = 3800 R^-0.87 per m3 and mm and
L = 2.55 R^-0.48 per mm; the flakes that are drawn run from 0.2 to 4 mm, and their number is such
that a gauge reads exactly R. What a flake is depends on where it grew and on its size: a single
crystal of the habit of its temperature, or a clump of many. `snow_law.glsl` evaluates the same.
"""

from __future__ import annotations

import math
from enum import IntEnum
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from weather_ecs.errors import InvalidValueError

from .checks import FloatArray, floats
from .drops import terminal_speed

SMALLEST_FLAKE, LARGEST_FLAKE = 0.2, 4.0  # mm, melted
ATTENUATION = 11.0  # dB per km and mm/h, Warner and Gunn (1969)
# Flakes grow above the ground, so much colder (degrees): 0.5 to 2.3 km up at 6.5 degrees a km.
ABOVE, DEPTH = 3.0, 12.0
CLUMPS = 0.4  # mm, over which crystals give way to aggregates
AGGREGATE = (
    4.0  # diameter over the melted one: mass (mg) = 0.012 area^1.5 (mm2), Sasyo, Matsuo 1980
)
WET = 1.3  # the same of a flake that has all but melted
MODELS = ("physical", "liu_tong")


class Habit(IntEnum):
    """What a single crystal has grown to."""

    PLATE = 0
    COLUMN = 1  # and needles
    STAR = 2  # stellar crystals and dendrites


# By habit: diameter over the melted one, and m/s. A dendrite of 3.26 mm weighs 0.043 mg and falls
# at 0.31 m/s, needles and plates at about 0.50 (Nakaya and Terada 1935); a plate of 1 mm weighs
# 0.026 mg (Mitchell 1996).
CRYSTAL_SIZE = (2.7, 3.0, 7.5)
CRYSTAL_SPEED = (0.50, 0.50, 0.31)


class SnowLaw(NamedTuple):
    """What is the same for all flakes of a snowfall; the first four are a container's law."""

    slope: float  # 1/mm
    span: float  # 1 - exp(-3.8 slope): the share of the sizes that is drawn
    wet: float  # share of a flake that has melted
    temperature: float  # degrees Celsius, at the ground
    model: str = "physical"


def snow_law(
    rate: float, wet: float = 0.0, temperature: float = -2.0, model: str = "physical"
) -> SnowLaw:
    """The law of snow that falls at `rate` mm/h of water, by steps of 0.02 and 0.25 degrees.

    The steps keep tables of it few. Raises InvalidValueError for an unknown model.
    """
    if model not in MODELS:
        raise InvalidValueError("model", model, "'physical' or 'liu_tong'")
    slope = 2.55 * min(max(float(rate), 1e-3), 1e3) ** -0.48
    span = -math.expm1(-(LARGEST_FLAKE - SMALLEST_FLAKE) * slope)
    wet = round(min(max(float(wet), 0.0), 1.0) * 50.0) / 50.0
    degrees = round(min(max(float(temperature), -60.0), 10.0) * 4.0) / 4.0
    return SnowLaw(slope, span, wet, degrees, model)


def snow_extinction(rate: ArrayLike) -> FloatArray:
    """Light lost per metre, 1/m, to snow that falls at `rate` mm/h of water.

    Proportional to the rate (Warner and Gunn 1969, from 20 storms): 11 dB/km for 1 mm/h, by
    Koschmieder a visibility of 1.5 km, and of 600 m in heavy snow, 2.5 mm/h.
    """
    return ATTENUATION * math.log(10.0) / 10.0 * 1e-3 * floats("rate", rate, 0.0)


def snow_size_distribution(diameter_mm: ArrayLike, rate: ArrayLike) -> FloatArray:
    """Flakes per cubic metre and millimetre of melted diameter (Gunn and Marshall 1958)."""
    diameter, falls = floats("diameter_mm", diameter_mm, 0.0), floats("rate", rate, 0.0)
    there = np.where(falls > 0.0, falls, 1.0)
    with np.errstate(over="ignore", invalid="ignore"):
        log = math.log(3800.0) - 0.87 * np.log(there) - 2.55 * there**-0.48 * diameter
    return np.where(falls > 0.0, np.exp(log), 0.0)


def melted_diameter(quantile: ArrayLike, law: SnowLaw) -> FloatArray:
    """Melted diameter in mm below which a share `quantile` of the flakes in the air lies."""
    u = floats("quantile", quantile, 0.0, 1.0)
    above = -np.log(np.maximum(1.0 - u * law.span, 1e-7)) / law.slope
    return np.minimum(SMALLEST_FLAKE + above, LARGEST_FLAKE)


def growth_temperature(at: ArrayLike, temperature: float) -> FloatArray:
    """Degrees Celsius in which a flake grew, evenly spread over the cloud: `at` in [0, 1)."""
    return temperature - ABOVE - DEPTH * floats("at", at, 0.0, 1.0)


def habit(temperature: ArrayLike) -> NDArray[np.int64]:
    """`Habit` of crystals that grow in air of this temperature (Magono and Lee 1966).

    Plates down to -4, needles and columns to -10, plates to -12, stars and dendrites to -17,
    plates to -22, columns below.
    """
    bounds = np.array([4.0, 10.0, 12.0, 17.0, 22.0])
    kinds = np.array(
        [Habit.PLATE, Habit.COLUMN, Habit.PLATE, Habit.STAR, Habit.PLATE, Habit.COLUMN]
    )
    return kinds[np.searchsorted(bounds, -floats("temperature", temperature))].astype(np.int64)


def clump_onset(temperature: float) -> float:
    """Melted diameter in mm from which flakes are clumps: early near 0 degrees, where ice sticks.

    Clumps are largest and commonest close to freezing (Hobbs et al. 1974).
    """
    return 0.45 + 0.05 * min(max(-temperature, 0.0), 15.0)


def clumped(diameter_mm: ArrayLike, temperature: float) -> FloatArray:
    """0 for a single crystal, 1 for an aggregate; smooth between them."""
    x = (floats("diameter_mm", diameter_mm, 0.0) - clump_onset(temperature)) / CLUMPS
    x = np.clip(x, 0.0, 1.0)
    return x * x * (3.0 - 2.0 * x)


def aggregate_speed(size_mm: ArrayLike) -> FloatArray:
    """m/s of an aggregate of this diameter, not melted (Locatelli and Hobbs 1974)."""
    return 0.8 * floats("size_mm", size_mm, 0.0) ** 0.16


def flake_size(diameter_mm: ArrayLike, at: ArrayLike, law: SnowLaw) -> FloatArray:
    """Diameter in mm as the flake is, from its melted one and where it grew.

    It is that of a disc of the flake's own area as seen from below.
    """
    diameter = floats("diameter_mm", diameter_mm, 0.0)
    kind = habit(growth_temperature(at, law.temperature))
    clump = clumped(diameter, law.temperature)
    own = np.asarray(CRYSTAL_SIZE)[kind]
    dry = own + (AGGREGATE - own) * clump
    return diameter * (dry + (WET - dry) * law.wet)


def flake_speed(diameter_mm: ArrayLike, at: ArrayLike, law: SnowLaw) -> FloatArray:
    """Mean fall speed in m/s.

    A flake that melts keeps its speed for long and falls like a drop in the end (Mitra et al.
    1990): the difference counts with the square of the melted share.
    """
    diameter = floats("diameter_mm", diameter_mm, 0.0)
    kind = habit(growth_temperature(at, law.temperature))
    clump = clumped(diameter, law.temperature)
    own = np.asarray(CRYSTAL_SPEED)[kind]
    dry = own + (aggregate_speed(AGGREGATE * diameter) - own) * clump
    return dry + (terminal_speed(diameter) - dry) * law.wet**2
