"""Haze and fog between the sky and the ground: what they take of its light and give back.

Both are layers of the same thickness everywhere, on a round Earth. Haze is what is mixed up to the
lowest kilometre; what it scatters is white beside the blue of the air. Fog is so thick that light
is scattered many times, nearly all of it forwards: of what falls on it 1 / (1 + (1 - g) depth / 2)
comes out below (C. F. Bohren, "Multiple scattering of light and some of its observable
consequences", American Journal of Physics 55, 1987), with g = 0.85 for droplets.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np

from weather_ecs.physics.checks import FloatArray
from weather_ecs.physics.optics import CONTRAST, EARTH

CLEAR_HAZE = 0.1  # of `WholeWeather.haze`: that of a clear day, which the sky's tables have
CLEAREST, THICKEST = 70_000.0, 4000.0  # m that one sees in that and in the thickest; WMO: 1 to 5 km
MIXED = 1000.0  # m of air that it is mixed into
RIM = math.sqrt(2.0 * MIXED / EARTH)  # sine of the elevation that a level look has in the layer
FORWARD = 0.85  # mean cosine by which droplets scatter
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def haze_visibility(haze: float) -> float:
    """m that one sees in a haze of 0 to 1; in even steps to the eye."""
    share = max(haze - CLEAR_HAZE, 0.0) / (1.0 - CLEAR_HAZE)
    return float(CLEAREST * (THICKEST / CLEAREST) ** share)


def haze_depth(haze: float) -> float:
    """Optical depth straight up of a haze of 0 to 1, over that of a clear day."""
    return MIXED * CONTRAST * (1.0 / haze_visibility(haze) - 1.0 / CLEAREST)


def haze_left(depth: float, up: FloatArray | float) -> FloatArray:
    """Share of the light from a sine of elevation, 0 at least, that such a depth lets through."""
    return np.exp(-depth / (np.asarray(up) + RIM))


def whitened(color: FloatArray) -> FloatArray:
    """Light of the horizon (3,) as haze in it scatters it: half bleached."""
    return 0.5 * color + 0.5 * float(color @ LUMINANCE)


class Lit(NamedTuple):
    """Light of sun and sky, linear RGB (3,)."""

    sun: FloatArray
    zenith: FloatArray
    horizon: FloatArray


def under_fog(light: Lit, sine: float, depth: float) -> Lit:
    """What fog of an optical depth straight up leaves; `sine` of the sun's height.

    The sun's own light goes by its way through the fog. All else comes from all round, somewhat
    bleached, and as much of it as the fog lets through.
    """
    if depth <= 0.0:
        return light
    left = math.exp(-depth / max(sine, 0.1))
    seen = math.exp(-depth)
    level = light.sun * max(sine, 0.0)
    sky = 0.5 * (light.zenith + light.horizon)
    through = (level + sky) / (1.0 + 0.5 * (1.0 - FORWARD) * depth)
    around = np.maximum(through - left * level - seen * sky, 0.0)
    around = 0.5 * around + 0.5 * float(around @ LUMINANCE)
    # A look into the fog meets what the ground sends back too: it is even all round.
    return Lit(
        light.sun * left,
        seen * light.zenith + 1.06 * around,
        seen * light.horizon + 0.94 * around,
    )
