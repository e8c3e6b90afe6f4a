"""Rain that begins and ends: what of it has come down to a height; seconds, metres, mm/h.

Drops leave the ceiling together and arrive by their speeds, the largest first. Where the rain has
rested from t0 to t1, the drops are missing whose fall from the ceiling has taken a time between
now - t1 and now - t0. `dry` holds two such spells, (from, to, from, to) in seconds ago; a spell of
no length is none. A rain that begins after an endless lull: (seconds since, LONG, 0, 0); one that
has ended: (-1, seconds since, 0, 0). shaders/rain_front.glsl has the same.
"""

from __future__ import annotations

from collections.abc import Callable, Mapping
from types import MappingProxyType

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .checks import FloatArray
from .drops import ATLAS, LARGEST_DROP, SMALLEST_DROP, moment, terminal_speed

Dry = tuple[float, float, float, float]
SETTLED: Dry = (0.0, 0.0, 0.0, 0.0)  # no spell: the drops are everywhere
NO_FRONTS: Mapping[int, Dry] = MappingProxyType({})
LONG = 1e9  # s, for ever
EDGE = 0.5  # s over which the drops of a spell's end fade
SLOWEST = float(terminal_speed(SMALLEST_DROP))  # m/s
FASTEST = float(terminal_speed(LARGEST_DROP))


def steepness(rain_rate: float) -> float:
    """Slope of the diameters in 1/mm, also where there is next to no rain."""
    return 4.1 * max(rain_rate, 1e-3) ** -0.21


def fallen_share(fall_time: ArrayLike, dry: Dry) -> FloatArray:
    """1 for drops that are there, 0 for those missing, by how long they have been falling."""
    time = np.asarray(fall_time, np.float64)
    past = [np.clip((time - end) / EDGE + 0.5, 0.0, 1.0) for end in dry]
    return np.clip(1.0 - (past[0] - past[1]) - (past[2] - past[3]), 0.0, 1.0)


def diameter_at(speed: ArrayLike) -> FloatArray:
    """Diameter in mm, 0.5 to 6, of the drop that falls at a speed: Atlas's fit turned about."""
    top, factor, decay = ATLAS
    left = np.maximum(top - np.asarray(speed, np.float64), 1e-6) / factor
    return np.clip(-np.log(left) / decay, SMALLEST_DROP, LARGEST_DROP)


def water_below(speed: ArrayLike, rain_rate: float) -> FloatArray:
    """Share of the water crossing a level plane that drops slower than `speed` carry."""
    top, factor, decay = ATLAS
    steep, size = steepness(rain_rate), diameter_at(speed)
    slow = factor * np.exp(-decay * SMALLEST_DROP)

    def carried(until: ArrayLike) -> FloatArray:
        return top * moment(3, steep, until) - slow * moment(3, steep + decay, until)

    return np.asarray(carried(size) / carried(LARGEST_DROP))


def extinction_below(speed: ArrayLike, rain_rate: float) -> FloatArray:
    """Share of the extinction that drops slower than `speed` are the cause of."""
    steep = steepness(rain_rate)
    return np.asarray(moment(2, steep, diameter_at(speed)) / moment(2, steep))


def water_arrived(fall: ArrayLike, dry: Dry, rain_rate: float) -> FloatArray:
    """Share of the rain rate at `fall` metres below the ceiling."""
    return _arrived(fall, dry, lambda speed: water_below(speed, rain_rate))


def extinction_arrived(fall: ArrayLike, dry: Dry, rain_rate: float) -> FloatArray:
    """Share of the extinction at `fall` metres below the ceiling."""
    return _arrived(fall, dry, lambda speed: extinction_below(speed, rain_rate))


def _arrived(fall: ArrayLike, dry: Dry, below: Callable[[ArrayLike], FloatArray]) -> FloatArray:
    way = np.maximum(np.asarray(fall, np.float64), 1e-3)
    share = np.ones(way.shape)
    for since, until in (dry[:2], dry[2:]):
        if until > since:
            # A drop is missing whose speed lies between way / until and way / since.
            fastest = np.where(since > 0.0, way / max(since, 1e-9), 2.0 * FASTEST)
            share = share - (below(fastest) - below(way / max(until, 1e-9)))
    return np.clip(share, 0.0, 1.0)


def landing_share(fall: float, dry: Dry, rain_rate: float) -> tuple[float, float]:
    """(share of the drops, share of the water) that land at `fall` metres below the ceiling."""
    size = np.linspace(SMALLEST_DROP, LARGEST_DROP, 512)
    speed = terminal_speed(size)
    crossing = np.exp(-steepness(rain_rate) * (size - SMALLEST_DROP)) * speed
    there = fallen_share(max(fall, 0.0) / speed, dry)
    water = crossing * size**3
    return (
        float((crossing * there).sum() / crossing.sum()),
        float((water * there).sum() / water.sum()),
    )


def on_level_ground(areas: NDArray, fronts: Mapping[int, Dry]) -> NDArray:
    """Areas (AREA_DTYPE) with the rain rate that has come down to height 0; read-only."""
    if not fronts:
        return areas
    found = areas.copy()
    for k, row in enumerate(areas):
        dry = fronts.get(int(row["key"]))
        if dry is not None and row["rain_rate"] > 0.0:
            rate = float(row["rain_rate"])
            found["rain_rate"][k] = rate * float(water_arrived(row["ceiling"], dry, rate))
    found.setflags(write=False)
    return found
