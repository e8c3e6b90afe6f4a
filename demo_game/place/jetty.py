"""A jetty of planks over the pond's edge: under it the water is quiet while it rains."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from demo_game.collision import Box

from . import palette
from .layout import JETTY
from .mesh import Builder
from .terrain import Terrain

WIDTH = 1.5  # m, along z
ABOVE_WATER = 0.42  # m, of the deck
THICK = 0.07  # m
PLANK, GAP = 0.45, 0.018  # m, along x
FOOT = 1.5  # m below the water


def deck(terrain: Terrain) -> tuple[NDArray, NDArray]:
    """Middle and size of the deck, m."""
    (low, high), z = JETTY
    top = terrain.pond_level + ABOVE_WATER
    center = np.array([0.5 * (low + high), top - 0.5 * THICK, z])
    return center, np.array([high - low, THICK, WIDTH])


def jetty(build: Builder, terrain: Terrain) -> None:
    """Planks on two beams, and the posts that carry them."""
    center, size = deck(terrain)
    rng = build.random
    low = center[0] - 0.5 * size[0]
    count = round(size[0] / PLANK)
    step = size[0] / count
    for k in range(count):
        at = (low + (k + 0.5) * step, center[1] + rng.uniform(-0.006, 0.006), center[2])
        wide = WIDTH + rng.uniform(-0.05, 0.05)
        color = palette.FENCE * rng.uniform(0.82, 1.05)
        ends = ("" if k == 0 else " -x") + ("" if k == count - 1 else " +x")
        build.box(at, (step - GAP, THICK, wide), color, skip="-y" + ends)
    for side in (-1.0, 1.0):
        beam = center + (0.0, -0.11, side * (0.5 * WIDTH - 0.12))
        build.box(beam, (size[0], 0.15, 0.1), palette.BEAM, skip="+y -y")
        for x in (low + 0.3, low + 0.55 * size[0]):
            top = center[1] + rng.uniform(0.24, 0.34)
            tall = top + FOOT - terrain.pond_level
            post = (x, top - 0.5 * tall, center[2] + side * (0.5 * WIDTH + 0.03))
            build.box(post, (0.14, tall, 0.14), palette.BEAM * 1.15, skip="-y", cuts=1)


def deck_box(terrain: Terrain) -> Box:
    """The deck, which carries walkers."""
    center, size = deck(terrain)
    (x, y, z), half = center.tolist(), (size / 2.0).tolist()
    return Box((x, z), (half[0], half[2]), y - half[1], y + half[1])
