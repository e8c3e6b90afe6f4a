"""How far one sees: fog, visibility and what rain does to it. Metres and 1/m throughout."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from weather_ecs.errors import InvalidValueError

from .checks import FloatArray, floats
from .drops import extinction
from .snow import snow_extinction

CONTRAST = 3.912  # ln 50: Koschmieder, an object is seen down to 2 % of its contrast
CLEAR_VISIBILITY = 50_000.0  # m, in clean air
LEAST_VISIBILITY = 1.0  # m, the thickest fog there is
EARTH = 6.371e6  # m, radius
DARK = 0.02  # light of things for which blending encoded light is right, over the fog's
CLEAR = CONTRAST / CLEAR_VISIBILITY  # 1/m
_RAIN = float(extinction(1.0))  # 1/m at 1 mm/h
_RAIN_POWER = 0.63  # three times the 0.21 of Marshall and Palmer's slope
_SNOW = float(snow_extinction(1.0))


def fog_factor(distance: ArrayLike, density: ArrayLike) -> FloatArray:
    """Share of an object's own light left after `distance`, exp(-density distance), 0 to 1.

    1 at distance 0 or in clear air (density 0), also at infinity: then nothing is lost. The rest,
    1 minus this, is filled with the fog's colour.
    """
    far = floats("distance", distance, 0.0, math.inf)
    thick = floats("density", density, 0.0, math.inf)
    with np.errstate(invalid="ignore", over="ignore"):  # 0 times infinity: no fog, or no way
        depth = far * thick
    return np.exp(-np.where(np.isnan(depth), 0.0, depth))


def visibility_to_extinction(visibility: ArrayLike) -> FloatArray:
    """Extinction of air in which one sees this far (Koschmieder 1924): 3.912 / visibility.

    0 for an infinite visibility. Raises InvalidValueError for 0, where extinction has no value.
    """
    seen = floats("visibility", visibility, 0.0, math.inf)
    if not np.all(seen >= 1e-300):  # below, the quotient is infinite
        raise InvalidValueError("visibility", visibility, "above 0")
    return CONTRAST / seen


def extinction_to_visibility(extinction: ArrayLike) -> FloatArray:
    """How far one sees in air of this extinction; infinite where it is 0."""
    lost = floats("extinction", extinction, 0.0, math.inf)
    with np.errstate(divide="ignore", over="ignore"):
        return np.divide(CONTRAST, lost)


def visibility_in_rain(rain_rate: ArrayLike, clear: ArrayLike = math.inf) -> FloatArray:
    """How far one sees through rain (mm/h), in air that shows `clear` metres without it."""
    return extinction_to_visibility(extinction(rain_rate) + visibility_to_extinction(clear))


def air_extinction(visibility: float) -> float:
    """Extinction (1/m) of air with fog in which one sees this far, at most 50 km and at least 1 m.

    Clean air and fog together: a thing at the visibility's distance keeps 2 % of its contrast.
    """
    return CONTRAST / min(max(visibility, LEAST_VISIBILITY), CLEAR_VISIBILITY)


def falling_extinction(rain_rate: float, snow_rate: float) -> float:
    """Extinction (1/m) of rain and snow (mm/h of water) at one point; nothing is checked."""
    return float(_RAIN * rain_rate**_RAIN_POWER + _SNOW * snow_rate)


def falling_extinctions(rain_rate: FloatArray, snow_rate: FloatArray) -> FloatArray:
    """`falling_extinction` at many points."""
    return np.asarray(_RAIN * rain_rate**_RAIN_POWER + _SNOW * snow_rate)


def layer_path(elevation_sine: ArrayLike, depth: float) -> FloatArray:
    """Metres of a layer `depth` m deep above the eye that a ray of this elevation goes through.

    depth / (sine + sqrt(2 depth / radius)): straight up the depth itself, and at the horizon the
    way that it is on a round Earth; rays downwards count as level.
    """
    sine = np.clip(np.asarray(elevation_sine, np.float64), 0.0, 1.0)
    return depth / (sine + layer_rim(depth))


def layer_rim(depth: float) -> float:
    """Sine of the elevation at which the Earth's roundness halves the way through a layer."""
    return math.sqrt(max(2.0 * depth / EARTH, 1e-9))


def overlay_opacity(factor: ArrayLike) -> FloatArray:
    """Opacity with which fog is blended over a picture, where `factor` of its light is left.

    The picture holds light encoded by a power of 2.2, and blending it as it stands would leave dark
    things, which fog changes most, twice too dark. This one is right for things of 2 % of the fog's
    light (with a root for the power, which costs a shader less) and within 0.1 of it for others.
    """
    covered = 1.0 - np.asarray(factor, np.float64)
    dark = math.sqrt(DARK)
    return np.asarray((np.sqrt(DARK + (1.0 - DARK) * covered) - dark) / (1.0 - dark))
