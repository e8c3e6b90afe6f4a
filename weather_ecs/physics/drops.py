"""Raindrops: how many of which size, how fast they fall, how flat they are, what they hide.

Diameters in mm, rain rates in mm/h, speeds in m/s, numbers per cubic metre of air. Sizes follow
Marshall and Palmer (1948), N(D) = N0 exp(-L D) with L = 4.1 R^-0.21. `size_distribution` and
`extinction` speak of drops of all sizes; the drops that are sampled and drawn run from 0.5 to
6 mm, and every other function that takes a rain rate speaks of these. A rain rate of 0 is no
rain: no drops and no NaN. Negative, NaN or infinite rates raise InvalidValueError.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from weather_ecs.errors import InvalidValueError

from .checks import FloatArray, count, floats, number
from .fall import fall_speed

__all__ = [
    "LARGEST_DROP",
    "SMALLEST_DROP",
    "axis_ratio",
    "diameter_quantile",
    "drop_density",
    "extinction",
    "extinction_of_sampled",
    "fall_speed",
    "flux_normalisation",
    "mean_cross_section",
    "number_density",
    "sample_diameters",
    "size_distribution",
    "slope",
    "terminal_speed",
]

INTERCEPT = 8000.0  # N0, drops per m3 and mm
SMALLEST_DROP, LARGEST_DROP = 0.5, 6.0  # mm; below they drift, above drag breaks them
ATLAS = (9.65, 10.3, 0.6)  # v = 9.65 - 10.3 exp(-0.6 D), Atlas et al. (1973)
WATER = math.pi / 6.0 * 3600.0 * 1e-6  # mm/h from N(D) D^3 v in mm3 m-3 m/s
KNOTS = 4096  # of the table that inverts the flux distribution


def slope(rain_rate: ArrayLike) -> FloatArray:
    """Marshall and Palmer's L = 4.1 R^-0.21, 1/mm; infinite without rain."""
    rate = floats("rain_rate", rain_rate, 0.0)
    with np.errstate(divide="ignore"):
        return 4.1 * rate**-0.21


def size_distribution(diameter_mm: ArrayLike, rain_rate: ArrayLike) -> FloatArray:
    """Drops per cubic metre of air and millimetre of diameter, for any D >= 0."""
    diameter = floats("diameter_mm", diameter_mm, 0.0)
    steepness = slope(rain_rate)
    dry = np.isinf(steepness)
    return np.where(dry, 0.0, INTERCEPT * np.exp(-np.where(dry, 0.0, steepness) * diameter))


def number_density(
    rain_rate: ArrayLike, smallest: float = SMALLEST_DROP, largest: float = LARGEST_DROP
) -> FloatArray:
    """Drops per cubic metre with diameters in [smallest, largest]; (0, inf) counts them all."""
    low = number("smallest", smallest, 0.0)
    high = number("largest", largest, low, math.inf)
    steepness = slope(rain_rate)
    dry = np.isinf(steepness)
    finite = np.where(dry, 1.0, steepness)
    share = -np.expm1(-finite * (high - low)) * np.exp(-finite * low)
    return np.where(dry, 0.0, INTERCEPT / finite * share)


def diameter_quantile(u: ArrayLike, rain_rate: ArrayLike) -> FloatArray:
    """Diameter below which a share u of the drops in the air lies, 0.5 to 6 mm.

    -ln(e^(-0.5 L) - u (e^(-0.5 L) - e^(-6 L))) / L, written so that it does not underflow; a shader
    evaluates the same. Without rain: 0.5, the limit of ever lighter rain.
    """
    share = floats("u", u, 0.0, 1.0)
    steepness = slope(rain_rate)
    width = LARGEST_DROP - SMALLEST_DROP
    with np.errstate(divide="ignore", invalid="ignore"):  # u = 1 where e^(-5.5 L) rounds to 0
        above = -np.log1p(share * np.expm1(-steepness * width)) / steepness
    above = np.where(np.isinf(steepness), 0.0, above)
    return SMALLEST_DROP + np.clip(above, 0.0, width)


def sample_diameters(
    n: int, rain_rate: float, rng: np.random.Generator, flux: bool = False
) -> FloatArray:
    """n diameters of 0.5 to 6 mm: drops in a volume of air, or with `flux` drops that land.

    Drops that cross a plane are distributed as N(D) v(D), v the `atlas` speed. One random number
    a drop either way. Without rain every drop is 0.5 mm, the limit of ever lighter rain.
    """
    u = rng.random(count("n", n))
    rate = number("rain_rate", rain_rate, 0.0)
    if not flux or rate == 0.0:
        return diameter_quantile(u, rate)
    steepness = float(slope(rate))
    above = np.linspace(0.0, min(LARGEST_DROP - SMALLEST_DROP, 40.0 / steepness), KNOTS)
    top, factor, decay = ATLAS
    crossing = -top / steepness * np.expm1(-steepness * above)
    steeper = steepness + decay
    crossing += factor * math.exp(-decay * SMALLEST_DROP) / steeper * np.expm1(-steeper * above)
    return SMALLEST_DROP + np.interp(u * crossing[-1], crossing, above)


def terminal_speed(diameter_mm: ArrayLike, model: str = "atlas") -> FloatArray:
    """Speed at which a drop of this size no longer accelerates in still air, m/s.

    `atlas`: Atlas, Srivastava and Sekhon (1973), smooth, 0 below 0.109 mm where the fit turns
    negative. `liu_tong`: Liu and Tong (2015), in three pieces that jump at 1.5 and 4.0 mm; given
    for 0.5 to 6 mm, its first and last piece are used beyond.
    """
    diameter = floats("diameter_mm", diameter_mm, 0.0)
    if model == "atlas":
        return np.maximum(ATLAS[0] - ATLAS[1] * np.exp(-ATLAS[2] * diameter), 0.0)
    if model != "liu_tong":
        raise InvalidValueError("model", model, "'atlas' or 'liu_tong'")
    small, medium = 3.8435 * diameter**0.9201, 4.6254 * np.sqrt(diameter)
    return np.where(diameter <= 1.5, small, np.where(diameter <= 4.0, medium, 9.0))


def axis_ratio(diameter_mm: ArrayLike) -> FloatArray:
    """Height over width of a falling drop, at most 1 (Beard and Chuang 1987).

    The polynomial ends with the largest drops ever measured: above 8 mm its value there.
    """
    d = np.minimum(floats("diameter_mm", diameter_mm, 0.0), 8.0)
    ratio = 1.0048 + d * (5.7e-4 + d * (-0.02628 + d * (3.682e-3 - d * 1.677e-4)))
    return np.minimum(ratio, 1.0)


def drop_density(rain_rate: ArrayLike) -> FloatArray:
    """Drops of 0.5 to 6 mm per cubic metre that carry exactly the rain rate through a plane.

    R over the mean water that one drop carries; `number_density` times `flux_normalisation`.
    """
    rate = floats("rain_rate", rain_rate, 0.0)
    return rate / _water_per_drop(rate)


def flux_normalisation(rain_rate: ArrayLike) -> FloatArray:
    """Factor on `number_density` at which the gauge reads the rain rate exactly.

    The distribution cut to 0.5 to 6 mm and falling at the `atlas` speed carries more than its R
    in ordinary rain, and nearly nothing in the lightest, where the factor grows without limit (it
    is held at 1e300). Without rain: 1. `drop_density` has no such trouble.
    """
    rate = floats("rain_rate", rain_rate, 0.0)
    natural = number_density(rate)
    with np.errstate(divide="ignore", over="ignore", invalid="ignore"):
        factor = np.minimum(drop_density(rate) / natural, 1e300)
    return np.where(rate > 0.0, np.where(natural > 0.0, factor, 1e300), 1.0)


def mean_cross_section(rain_rate: ArrayLike) -> FloatArray:
    """Mean of pi/4 D^2 over the drops of 0.5 to 6 mm in the air, m2."""
    return math.pi / 4.0 * 1e-6 * _mean_power(2, slope(rain_rate))


def extinction(rain_rate: ArrayLike) -> FloatArray:
    """Light lost per metre, 1/m, to drops of all sizes.

    The closed form of the integral of 2 pi/4 D^2 N(D): a drop much larger than the wavelength
    takes twice its cross-section out of a beam (van de Hulst 1957).
    """
    steepness = slope(rain_rate)
    return math.pi * 1e-6 * INTERCEPT / steepness**3


def extinction_of_sampled(rain_rate: ArrayLike) -> FloatArray:
    """Like `extinction`, for the drops of 0.5 to 6 mm alone, not normalised."""
    return 2.0 * number_density(rain_rate) * mean_cross_section(rain_rate)


def moment(k: int, decay: ArrayLike, diameter_mm: ArrayLike = LARGEST_DROP) -> FloatArray:
    """Integral of x^k exp(-decay (x - 0.5)) from x = 0.5 to the diameter, mm^(k + 1).

    By repeated integration by parts from x = 0.5, where the exponential is 1.
    """
    rate, top = np.asarray(decay, np.float64), np.asarray(diameter_mm, np.float64)
    end = np.exp(-rate * (top - SMALLEST_DROP))
    integral = (1.0 - end) / rate
    for power in range(1, k + 1):
        ends = SMALLEST_DROP**power - top**power * end
        integral = (ends + power * integral) / rate
    return integral


def _mean_power(k: int, steepness: FloatArray, faster: float = 0.0) -> FloatArray:
    """Mean of D^k exp(-faster (D - 0.5)) over the drops of 0.5 to 6 mm in the air."""
    decay = np.where(np.isinf(steepness), 1.0, steepness)
    whole = -np.expm1(-decay * (LARGEST_DROP - SMALLEST_DROP)) / decay
    return np.where(np.isinf(steepness), SMALLEST_DROP**k, moment(k, decay + faster) / whole)


def _water_per_drop(rate: FloatArray) -> FloatArray:
    """mm/h that one drop of 0.5 to 6 mm per cubic metre carries on average."""
    steepness, (top, factor, decay) = slope(rate), ATLAS
    slow = factor * math.exp(-decay * SMALLEST_DROP) * _mean_power(3, steepness, decay)
    return WATER * (top * _mean_power(3, steepness) - slow)
