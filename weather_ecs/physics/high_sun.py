"""The sun by height: clouds are in its light when the ground has it no more, and less reddened.

A table of its light at HEIGHTS, between which it is linear in the root of the height: most of the
air that takes of it is low. `cloud_light.glsl` reads it so, too.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from weather_ecs.physics.atmosphere import through_from
from weather_ecs.physics.checks import FloatArray
from weather_ecs.physics.haze import MIXED, RIM
from weather_ecs.physics.spectrum import seen

LEVELS = 7
HIGHEST = 12_000.0  # m
BRIGHT, ROOM = 1.15, 0.35  # from where on its light is bent, and by how much it grows then
HEIGHTS = HIGHEST * (np.arange(LEVELS) / (LEVELS - 1)) ** 2  # m over the ground


def high_suns(altitude: float, turbidity: float) -> FloatArray:
    """(LEVELS, 3) of the light of a source at a true altitude in degrees, as seen at the ground."""
    return seen(through_from(HEIGHTS, math.sin(math.radians(altitude)), turbidity))


def sun_at(suns: FloatArray, height: ArrayLike) -> FloatArray:
    """Linear RGB (..., 3) at a height in m, of such a table."""
    share = np.clip(np.asarray(height, np.float64) / HIGHEST, 0.0, 1.0)
    at = np.sqrt(share) * (LEVELS - 1)
    i = np.minimum(at.astype(np.intp), LEVELS - 2)
    return np.asarray(suns[i] + (suns[i + 1] - suns[i]) * (at - i)[..., None])


def shown_suns(suns: FloatArray, scale: FloatArray, haze: float, sine: float) -> FloatArray:
    """The table as clouds are shown in it: `scale` (3,) on all of it, as bright as a picture can.

    The eye is used to the ground's dusk, where a sun over it is many times too bright. haze: depth
    straight up of what is mixed into the lowest air; sine of the altitude.
    """
    over = haze * np.maximum(1.0 - HEIGHTS / MIXED, 0.0)
    light = suns * scale * np.exp(-over / (max(sine, 0.0) + RIM))[:, None]
    most = light.max(axis=1, keepdims=True)
    bent = BRIGHT + ROOM * -np.expm1(-np.maximum(most - BRIGHT, 0.0) / ROOM)
    return np.asarray(light * np.where(most > BRIGHT, bent / np.maximum(most, BRIGHT), 1.0))
