"""The uniform block of one step of the wetness map, and the areas that rain on it."""

from __future__ import annotations

import math
from collections.abc import Mapping
from typing import NamedTuple

from numpy.typing import NDArray

from weather_ecs.frame import ViewData, plain_areas
from weather_ecs.gpu.blocks import BlockBuffer, UniformBlock
from weather_ecs.physics.front import SETTLED, Dry, steepness
from weather_ecs.physics.wet_map import BANDS

MAX_AREAS = 16

STEP = UniformBlock(
    "WetStep",
    ("wet_frame", "vec4"),  # middle, x and z at height 0, a texel, m; texels on a side
    ("wet_old_frame", "vec4"),  # of the map before; 0 texels: there is none
    ("wet_old_fall", "vec4"),
    ("wet_shelter", "vec4"),  # the heightmap's low corner, m; 1 / its texel
    ("wet_heights", "vec4"),  # m, of the heightmap's top
    # Share of what falls that is snow, mm/s of it that melt, times that share that collects.
    ("wet_snow", "vec4"),
    ("wet_far_place", "vec4"),  # middle of the far field, m; 1 / its side
    ("wet_ages", "vec4", BANDS // 4),  # s since each band's last update
    ("wet_area_axis", "vec4", MAX_AREAS),
    ("wet_area_shape", "vec4", MAX_AREAS),
    ("wet_area_rate", "vec4", MAX_AREAS),  # mm/h; slope of the diameters in 1/mm
    ("wet_area_dry", "vec4", MAX_AREAS),  # s, fall times of the drops that are missing
    ("wet_areas", "int"),
    ("wet_bands", "int"),  # rows in a band
    ("wet_rings", "ivec2"),  # texels, radii in which a hollow is looked for
)
PLACES = STEP.run(
    "wet_frame",
    "wet_old_frame",
    "wet_old_fall",
    "wet_shelter",
    "wet_heights",
    "wet_snow",
    "wet_far_place",
)
AGES = STEP.run("wet_ages")
COUNTS = STEP.run("wet_areas", "wet_bands", "wet_rings")


class _Areas(NamedTuple):
    """What the areas in the block were written from."""

    areas: NDArray
    fronts: Mapping[int, Dry]
    number: int


def fill_areas(block: BlockBuffer, view: ViewData) -> int:
    """The areas that rain, at most MAX_AREAS, the nearest; returns how many they are."""
    frame, known = view.frame, block.holds
    if isinstance(known, _Areas) and known.areas is frame.areas and known.fronts == frame.fronts:
        return known.number
    rows = [row for row in plain_areas(frame.areas) if row.rain_rate > 0.0]
    many = len(rows) > MAX_AREAS
    if many:
        x, _, z = view.position
        rows.sort(key=lambda row: math.dist(row.center, (x, z)) - row.radii[0])
        del rows[MAX_AREAS:]
    data, count = block.data, len(rows)
    if count:
        data["wet_area_axis"][:count] = [
            (*row.center, math.cos(row.heading), math.sin(row.heading)) for row in rows
        ]
        data["wet_area_shape"][:count] = [
            (*row.radii, min(row.soft_edge, row.radii[1]), row.ceiling) for row in rows
        ]
        data["wet_area_rate"][:count, :2] = [
            (row.rain_rate, steepness(row.rain_rate)) for row in rows
        ]
        data["wet_area_dry"][:count] = [frame.fronts.get(row.key, SETTLED) for row in rows]
    # Of too many, which they are goes by the observer.
    block.holds = None if many else _Areas(frame.areas, frame.fronts, count)
    return count
