"""The uniform block of the snow: what moves and draws the flakes of one container."""

from __future__ import annotations

from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import ContainerData, SkyLight, ViewData
from weather_ecs.gpu.blocks import BlockBuffer, UniformBlock
from weather_ecs.physics.snow import clump_onset
from weather_ecs.physics.snow_step import PERIOD

SNOW = UniformBlock(
    "Snow",
    ("snow_motion", "vec4"),  # flutter, share of the swings' period, clumps' onset in mm, model
    ("snow_look", "vec4"),  # aperture in m, exposure in s
    ("snow_color", "vec4"),  # linear, what a flake shows of sky and ground
)


@lru_cache(maxsize=8)
def flake_light(sky: SkyLight) -> NDArray:
    """What a flake shows, linear RGB: white, lit from all sides by sky and ground."""
    zenith, horizon = np.array(sky.zenith_color), np.array(sky.horizon_color)
    return 0.95 * (0.42 * zenith + 0.36 * horizon + 0.22 * np.array(sky.ground_color))


def fill_snow(block: BlockBuffer, container: ContainerData, view: ViewData) -> None:
    """Write what is the same for all flakes of a container."""
    look, time = view.frame.flakes, view.frame.time
    paper = float(look.model == "liu_tong")
    data = block.data
    onset = clump_onset(container.law[3])
    data["snow_motion"] = (look.flutter, time % PERIOD / PERIOD, onset, paper)
    data["snow_look"] = (look.aperture, look.exposure, 0.0, 0.0)
    data["snow_color"][:3] = look.brightness * flake_light(view.frame.sky)
