"""The wetness map: where it lies, and the oracle of `shaders/wetness_step.frag`, in float64."""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from weather_ecs.physics.footprint import Footprint
from weather_ecs.physics.snow_cover import collect, stays
from weather_ecs.physics.wetness import (
    CATCHMENT,
    DEEPEST,
    MM_PER_S,
    film_capacity,
    settle,
)

BANDS = 32  # parts of the map that are brought up to date in turn
RINGS = (0.6, 2.0)  # m, radii in which a hollow is looked for
EDGE = 0.6  # m, as in shaders/shelter.glsl
SAME = 0.5  # m between heights of what may be one surface
COVERED = 0.1  # m by which a moving thing stands over it
SLENDER = 0.8  # m, width of what hides nothing of what lies below it
FAR_ABOVE = 1.0  # m over what is beside it
NOTHING = -1e9  # m, height of no surface


@dataclass(frozen=True, slots=True)
class MapPlace:
    """Where a wetness map lies; its texels are two by two of the heightmap's."""

    center: tuple[float, float]  # m, (x, z) carried along the fall to height 0
    texel: float  # m
    size: int  # texels on a side
    slope: tuple[float, float]  # horizontal metres per metre of fall

    @property
    def rows(self) -> int:
        """Rows in a band."""
        return -(-self.size // BANDS)


def place_over(footprint: Footprint, heightmap_size: int) -> MapPlace:
    """The wetness map over a heightmap: a texel smaller on every side, on a grid of its own.

    Its middle is a whole number of its texels, so that it shows the same places of the world in
    the same way wherever the heightmap lies.
    """
    texel = 4.0 * footprint.half / heightmap_size
    x, z = footprint.center
    center = round(x / texel) * texel, round(z / texel) * texel
    return MapPlace(center, texel, heightmap_size // 2 - 2, footprint.slope)


@dataclass(frozen=True, slots=True)
class Surface:
    """What rain meets first at every texel of a wetness map; arrays (n, n), rows along z."""

    position: NDArray[np.float64]  # (n, n, 3), m
    known: NDArray[np.bool_]
    facing: NDArray[np.float64]  # rain on its own square metre over that on a level one
    capacity: NDArray[np.float64]  # mm
    gathers: NDArray[np.float64]  # times its own rain that comes to it
    exposed: NDArray[np.float64]  # 0 to 1, share that rain reaches
    stays: NDArray[np.float64]  # 0 to 1, share of the snow that stays on it


def surface(place: MapPlace, footprint: Footprint, still: NDArray, cover: NDArray) -> Surface:
    """The surface under a map, from the heightmap's depths without and with what moves."""
    n, m = place.size, len(still)
    texel = 2.0 * footprint.half / m
    at = (np.arange(n) + 0.5 - 0.5 * n) * place.texel
    u, w = place.center[0] + at, place.center[1] + at
    i = np.floor((u - footprint.center[0] + footprint.half) / texel - 0.5).astype(int)
    j = np.floor((w - footprint.center[1] + footprint.half) / texel - 0.5).astype(int)
    span = footprint.top - footprint.bottom
    heights = np.where(still < 1.0, footprint.top - still.astype(float) * span, NOTHING)

    def fetch(table: NDArray, di: int, dj: int) -> NDArray[np.float64]:
        rows, columns = np.clip(j + dj, 0, m - 1), np.clip(i + di, 0, m - 1)
        return table[rows[:, None], columns[None, :]]

    def near(di: int, dj: int, own: NDArray) -> NDArray[np.float64]:
        h = fetch(heights, di, dj)
        return np.where(np.abs(h - own) < EDGE, h, own)

    block = [(0, 0), (1, 0), (0, 1), (1, 1)]
    four = np.array([fetch(heights, *step) for step in block])
    tops = footprint.top - np.array([fetch(cover, *step) for step in block]) * span
    known = four > NOTHING
    y = np.where(known, four, np.inf).min(axis=0)
    y = np.where(np.isinf(y), NOTHING, y)
    wide = max(math.floor(0.5 * (SLENDER / texel - 1.0) + 0.5), 1)
    sides = [(-wide, 0), (1, -wide), (-wide, -wide), (1 + wide, -wide)]
    pairs = [np.maximum(fetch(heights, a, b), fetch(heights, 1 - a, 1 - b)) for a, b in sides]
    beside = np.min(pairs, axis=0)
    slender = (beside > NOTHING) & (beside < four.max(axis=0) - FAR_ABOVE)
    y = np.where(slender & (beside < y - FAR_ABOVE), beside, y)
    reached = (
        known & ((four - y <= SAME) | slender) & (tops - y <= np.maximum(four - y, 0.0) + COVERED)
    )
    sx, sz = footprint.slope
    ends = [near(*at, y) for at in ((2, 0), (2, 1), (-1, 0), (-1, 1))]
    rise_x = (ends[0] + ends[1] - ends[2] - ends[3]) / (6.0 * texel)
    ends = [near(*at, y) for at in ((0, 2), (1, 2), (0, -1), (1, -1))]
    rise_z = (ends[0] + ends[1] - ends[2] - ends[3]) / (6.0 * texel)
    scale = 1.0 / np.maximum(1.0 - rise_x * sx - rise_z * sz, 0.2)
    slope_x, slope_z = rise_x * scale, rise_z * scale
    up = 1.0 / np.sqrt(1.0 + slope_x**2 + slope_z**2)
    deep, own = np.zeros_like(y), near(0, 0, y)
    for radius in RINGS:
        s = max(round(radius / texel), 1)
        d = max(int(0.7071 * s + 0.5), 1)
        ring = [(s, 0), (-s, 0), (0, s), (0, -s), (d, d), (-d, -d), (d, -d), (-d, d)]
        mean = np.mean([near(*step, own) for step in ring], axis=0)
        deep = np.maximum(deep, np.clip((mean - own) * 1000.0, 0.0, DEEPEST))
    share = np.clip((deep - 1.0) / 19.0, 0.0, 1.0)
    position = np.stack([u[None, :] - y * sx, y, w[:, None] - y * sz], axis=-1)
    return Surface(
        position,
        y > NOTHING,
        np.maximum(1.0 + slope_x * sx + slope_z * sz, 0.0) * up,
        film_capacity(up) + deep,
        1.0 + CATCHMENT * share * share * (3.0 - 2.0 * share),
        reached.sum(axis=0) / np.maximum(known.sum(axis=0), 1),
        stays(up),
    )


def carried(
    found: Surface,
    open_water: NDArray,
    before: NDArray | None,
    old: MapPlace | None,
    ages: NDArray,
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """((n, n, 2) mm of water and of snow that lay there before, (n, n) s since then).

    open_water: (n, n, 2) mm of both in the open; before: the map before, (n, n, 3) mm of water,
    m of height, mm of snow.
    """
    water, seconds = open_water.astype(float), np.zeros(open_water.shape[:2])
    water[..., 1] *= found.stays
    if before is None or old is None:
        return water, seconds
    x, y, z = np.moveaxis(found.position, -1, 0)
    i = np.floor((x + y * old.slope[0] - old.center[0]) / old.texel + 0.5 * old.size).astype(int)
    j = np.floor((z + y * old.slope[1] - old.center[1]) / old.texel + 0.5 * old.size).astype(int)
    inside = found.known & (i >= 0) & (j >= 0) & (i < old.size) & (j < old.size)
    i, j = np.clip(i, 0, old.size - 1), np.clip(j, 0, old.size - 1)
    was = before[j, i]
    same = inside & (np.abs(was[..., 1] - y) < SAME)
    hidden = inside & ~same & (was[..., 1] > y)
    water = np.where(hidden[..., None], 0.0, water)
    water = np.where(same[..., None], was[..., [0, 2]], water)
    return water, np.where(same, ages[j // old.rows], 0.0)


def step(
    found: Surface,
    before: NDArray,
    seconds: NDArray,
    rate: NDArray,
    snow_share: float = 0.0,
    melt: float = 0.0,
    collects: float | None = None,
) -> NDArray[np.float64]:
    """(n, n, 2) mm of water and snow after those seconds; 0 where nothing is known.

    rate: mm/h of water that falls, of which `snow_share` is snow; melt: mm/s of snow; collects:
    times the rate that collects as snow, if it is another share.
    """
    gathered = snow_share if collects is None else collects
    falls = rate * found.exposed * MM_PER_S * found.facing
    result = np.zeros_like(before)
    for age in np.unique(seconds):
        now = found.known & (seconds == age)
        span = math.fabs(float(age))
        snow, fresh = before[now][:, 1], falls[now] * gathered * found.stays[now]
        result[now, 1] = left = collect(snow, fresh, melt, span)
        melted = (snow + fresh * span - left) / span if span > 0.0 else np.zeros_like(snow)
        inflow = falls[now] * (1.0 - snow_share) * found.gathers[now] + np.maximum(melted, 0.0)
        result[now, 0] = settle(before[now][:, 0], inflow, found.capacity[now], span)
    return result
