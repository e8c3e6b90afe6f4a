"""Water on level ground under the open sky at many places at once: what the GPU begins with."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weather_ecs.physics.ground_law import WATER, GroundLaw
from weather_ecs.physics.rain_field import area_shares, plain_rows
from weather_ecs.physics.wetness import MM_PER_S

_BITS = 32


Level = tuple[float, NDArray, NDArray, float, NDArray, GroundLaw]


def open_water(
    points: NDArray, levels: list[Level], rest: float, areas: NDArray, law: GroundLaw = WATER
) -> NDArray[np.float64]:
    """mm at points (n, 2) (x, z); the same as `systems.wet_ground.WetGround.at`, but for ceilings.

    levels: of every size of cells its side in m, tiles (t, 2), water (t, 8, 8) in mm, and areas
    (AREA_DTYPE) that have rained for some s since, by a law. After all that, `areas` have for
    `rest` s by `law`; or it has snowed.
    """
    water = np.zeros(len(points))
    for cell, places, tiles, waited, rows, own in levels:
        here = _between(points, cell, places, tiles)
        water = law.merge(water, _later(points, here, rows, waited, own))
    return _later(points, water, areas, rest, law)


def _later(
    points: NDArray, water: NDArray, areas: NDArray, seconds: float, law: GroundLaw
) -> NDArray:
    if seconds <= 0.0 or not (len(areas) or water.any()):
        return water
    return law.settle(water, _rain(points, areas) * MM_PER_S, seconds)


def _rain(points: NDArray, areas: NDArray) -> NDArray[np.float64]:
    rate = np.zeros(len(points))
    for _, center, radii, heading, full, edge, _ in plain_rows(areas):
        if full > 0.0:
            rate += full * area_shares(points[:, 0], points[:, 1], center, radii, heading, edge)
    return rate


def _between(points: NDArray, cell: float, places: NDArray, tiles: NDArray) -> NDArray:
    """Bilinear between the middles of cells; cells without a tile are dry."""
    if not len(places):
        return np.zeros(len(points))
    names = _name(places[:, 0], places[:, 1])
    order = np.argsort(names)
    names = names[order]
    at = points / cell - 0.5
    low = np.floor(at).astype(np.int64)
    part = at - low
    total = np.zeros(len(points))
    for i in (0, 1):
        for j in (0, 1):
            x, z = low[:, 0] + i, low[:, 1] + j
            wanted = _name(x >> 3, z >> 3)
            found = np.minimum(np.searchsorted(names, wanted), len(names) - 1)
            there = names[found] == wanted
            value = np.where(there, tiles[order[found], z & 7, x & 7], 0.0)
            share = (part[:, 0] if i else 1.0 - part[:, 0]) * (
                part[:, 1] if j else 1.0 - part[:, 1]
            )
            total += value * share
    return total


def _name(i: NDArray, j: NDArray) -> NDArray[np.int64]:
    return (i << _BITS) + j
