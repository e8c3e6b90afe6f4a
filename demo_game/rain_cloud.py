"""The clouds that the game's own rain areas hang from: one over each, small as the areas are."""

from __future__ import annotations

import math

from weather_ecs.components import Cloud, CloudModel, CloudSeed, RainArea

SPREAD = 1.65  # of the area's radii, how far its cloud reaches
THICK = 0.9  # of the area's smaller radius
LOW = 0.75  # of the ceiling that the rain falls from: it comes out of the cloud
LEAST_GROWTH = 0.30  # of a cloud that hardly rains


def rain_cloud_model(name: str, radii: tuple[float, float]) -> CloudModel:
    """A flat dark cloud with a heaped top that covers an area with these radii, m.

    It carries no rain itself: the game's area has it.
    """
    a, b = SPREAD * radii[0], SPREAD * radii[1]
    high = THICK * radii[1]
    size = 0.72 * b
    # Sheets close it, shreds make its underside and rim, and heaps its top.
    seeds = [_seed((0.0, 0.30 * high, 0.0), (0.75 * a, 0.2 * high, 0.75 * b), "sheet", 2.0)]
    for k in range(7):
        turn = math.tau * (k + 0.5) / 7
        x, z = 0.62 * a * math.cos(turn), 0.62 * b * math.sin(turn)
        seeds.append(_seed((x, 0.26 * high, z), (0.5 * a, 0.30 * high, 0.5 * b), "ragged"))
    for k in range(3):
        turn = math.tau * (k + 0.2) / 3
        x, z = 0.34 * a * math.cos(turn), 0.34 * b * math.sin(turn)
        seeds.append(_seed((x, 0.70 * high, z), (0.5 * a, 0.4 * high, 0.5 * b), "puff", 1.1))
    return CloudModel(
        name=name,
        seeds=tuple(seeds),
        billboards_min=2,
        billboards_max=2,
        size_min=size,
        size_max=1.35 * size,
        images=("ragged",),
        light_penetration=1.1 * high,
        roundness=0.5,
        flatness=0.8,
        aspect=0.5,
        opacity=0.96,
        darkness=0.95,
    )


def _seed(
    center: tuple[float, float, float],
    size: tuple[float, float, float],
    image: str,
    large: float = 1.0,
) -> CloudSeed:
    return CloudSeed(center, *size, images=(image,), size_factor=large)


def place_over(cloud: Cloud, area: RainArea, rate: float) -> None:
    """Carry a cloud to where its area is, as grown as it rains (mm/h) there."""
    strength = 1.0 - math.exp(-rate / 3.0)
    growth = 0.0 if rate <= 0.0 else round(LEAST_GROWTH + (1.0 - LEAST_GROWTH) * strength, 2)
    position = (area.center[0], LOW * area.ceiling, area.center[1])
    if cloud.position != position:
        cloud.position = position
    if cloud.heading != area.heading:
        cloud.heading = area.heading
    if cloud.growth != growth:
        cloud.growth = growth
