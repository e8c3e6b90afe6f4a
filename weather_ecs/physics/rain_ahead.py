"""How much rain a look goes through: what a rainbow stands in."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from weather_ecs.physics.checks import FloatArray

FAR = 4000.0  # m, beyond which a bow is lost in the haze
DEPTH = 500.0  # m of 1 mm/h in which a bow comes to 1 - 1/e of its strength


def rain_along(areas: NDArray, place: Sequence[float], looks: FloatArray) -> FloatArray:
    """mm/h to the power 0.63, times m over the ground, of the areas along directions (..., 3).

    `areas` have the fields of `frame.AREA_DTYPE`, `place` is (x, y, z); the power is that of the
    drops' cross-sections. Above an area's ceiling there is none of its rain.
    """
    total = np.zeros(looks.shape[:-1])
    level = np.maximum(np.hypot(looks[..., 0], looks[..., 2]), 1e-6)
    azimuths, slope = looks[..., (0, 2)] / level[..., None], looks[..., 1] / level
    slope = np.where(np.abs(slope) < 1e-6, 1e-6, slope)
    for area in areas:
        if area["rain_rate"] <= 0.0:
            continue
        c, s = np.cos(area["heading"]), np.sin(area["heading"])
        off = np.array((place[0], place[2])) - area["center"]
        a, b = np.maximum(area["radii"] - 0.5 * area["soft_edge"], 0.5 * area["radii"])
        # Along the axes of the ellipse (x, -z turned by the heading), which become a circle's.
        ox, oz = (off[0] * c - off[1] * s) / a, (off[0] * s + off[1] * c) / b
        dx = (azimuths[..., 0] * c - azimuths[..., 1] * s) / a
        dz = (azimuths[..., 0] * s + azimuths[..., 1] * c) / b
        square, half = dx * dx + dz * dz, ox * dx + oz * dz
        inside = half * half - square * (ox * ox + oz * oz - 1.0)
        root = np.sqrt(np.maximum(inside, 0.0))
        passes = (float(area["ceiling"]) - place[1]) / slope  # where a look is at its height
        first = np.where(slope < 0.0, np.clip(passes, 0.0, FAR), 0.0)
        last = np.where(slope > 0.0, np.clip(passes, 0.0, FAR), FAR)
        enters = np.clip((-half - root) / square, first, np.maximum(first, last))
        leaves = np.clip((-half + root) / square, first, np.maximum(first, last))
        total += np.where(inside > 0.0, leaves - enters, 0.0) * float(area["rain_rate"]) ** 0.63
    return total


def bow_strength(rain: FloatArray) -> FloatArray:
    """Share of a bow's full light that so much rain along the look gives, 0 to 1."""
    return np.asarray(1.0 - np.exp(-rain / DEPTH))
