"""How much rain a look along the ground goes through: what a rainbow stands in."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weather_ecs.physics.checks import FloatArray

FAR = 4000.0  # m, beyond which a bow is lost in the haze
DEPTH = 500.0  # m of 1 mm/h in which a bow comes to 1 - 1/e of its strength


def rain_along(areas: NDArray, place: tuple[float, float], azimuths: FloatArray) -> FloatArray:
    """mm/h to the power 0.63, times m, of the areas along horizontal directions (..., 2).

    `areas` have the fields of `frame.AREA_DTYPE`, `place` is (x, z); the power is that of the
    drops' cross-sections.
    """
    total = np.zeros(azimuths.shape[:-1])
    for area in areas:
        if area["rain_rate"] <= 0.0:
            continue
        c, s = np.cos(area["heading"]), np.sin(area["heading"])
        off = np.array(place) - area["center"]
        a, b = np.maximum(area["radii"] - 0.5 * area["soft_edge"], 0.5 * area["radii"])
        # Along the axes of the ellipse (x, -z turned by the heading), which become a circle's.
        ox, oz = (off[0] * c - off[1] * s) / a, (off[0] * s + off[1] * c) / b
        dx = (azimuths[..., 0] * c - azimuths[..., 1] * s) / a
        dz = (azimuths[..., 0] * s + azimuths[..., 1] * c) / b
        square, half = dx * dx + dz * dz, ox * dx + oz * dz
        inside = half * half - square * (ox * ox + oz * oz - 1.0)
        root = np.sqrt(np.maximum(inside, 0.0))
        enters = np.clip((-half - root) / square, 0.0, FAR)
        leaves = np.clip((-half + root) / square, 0.0, FAR)
        total += np.where(inside > 0.0, leaves - enters, 0.0) * float(area["rain_rate"]) ** 0.63
    return total


def bow_strength(rain: FloatArray) -> FloatArray:
    """Share of a bow's full light that so much rain along the look gives, 0 to 1."""
    return np.asarray(1.0 - np.exp(-rain / DEPTH))
