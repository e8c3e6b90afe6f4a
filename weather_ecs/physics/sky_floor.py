"""What is below the horizon, seen from high up: the ground or clouds, behind clean air."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from weather_ecs.physics.checks import FloatArray
from weather_ecs.physics.cloud_light import CLEAN, CLEAN_HEIGHT, Body, Surround, full_light
from weather_ecs.physics.sky_map import SHOULDER

LEAST_SINE = 0.02  # of the way down: the Earth is round, and nobody looks through more air
FALL = 40.0  # how fast ground takes the sky's place under the horizon (`sky.glsl`)
AROUND = 14_000.0  # m, in which clouds count
FILLED = 0.6  # of the box round a cloud that it covers
RISES = 700.0  # m over the tops of clouds, in which they come to stand for all that is below
LOST_ABOVE = 0.25  # of the sun, that the seeds on top of a cloud have lost
MEAN_SHADE = 0.66  # of the images' texels, of what shades itself, and of the gaps


def depth_below(height: float, floor: float = 0.0) -> float:
    """Optical depth of clean air straight down from a height to a floor, both m over the ground."""
    low, high = (float(np.exp(-max(h, 0.0) / CLEAN_HEIGHT)) for h in (floor, max(height, floor)))
    return CLEAN * CLEAN_HEIGHT * (low - high)


def floor_light(
    level: FloatArray, ground: FloatArray, clouds: FloatArray, share: float, depth: float,
    up: FloatArray,
) -> FloatArray:  # fmt: skip
    """Light along directions whose sine of elevation `up` (...) is not positive, (..., 3).

    level: the sky's at the horizon there; ground, clouds: what lies below, and the share of the
    latter; depth: of the air straight down.
    """
    down = np.minimum(up, 0.0)[..., None]
    sky = np.exp(FALL * down)
    land = ground + (level - ground) * sky
    land = land + (clouds - land) * share * (1.0 - sky)
    return np.asarray(level + (land - level) * np.exp(-depth / (LEAST_SINE - down)))


def share_covered(areas: FloatArray) -> float:
    """Share of a floor AROUND that clouds cover which stand at random, their areas (n,) in m2."""
    return float(-np.expm1(-FILLED * areas.sum() / (np.pi * AROUND**2)))


def top_light(light: Surround, darkness: float, height: float = 0.0) -> FloatArray:
    """Linear RGB (3,) of clouds seen from above, on average; their height in m."""
    body = Body(np.ones(3), -1.0, darkness, height=height)
    top, none, down = np.array([0.0, 1.0, 0.0]), np.zeros(3), np.array([0.0, -1.0, 0.0])
    lit = full_light(top, none, down, np.array(LOST_ABOVE), body, light)
    return np.asarray(MEAN_SHADE * (lit.shade + lit.facing * (lit.lit - lit.shade)))


def unbent(shown: ArrayLike) -> FloatArray:
    """Light that a drawn sky shows as this much: what `sky_map.shown` bends, the other way."""
    bent = np.clip(np.asarray(shown, np.float64), 0.0, 0.96)
    over = np.sqrt((1.0 - SHOULDER) / (1.0 - bent))
    return np.where(bent > SHOULDER, SHOULDER + (over - 1.0) * (1.0 - SHOULDER) / 0.5, bent)
