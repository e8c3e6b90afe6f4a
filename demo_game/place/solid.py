"""What stops walkers, as the game's collision wants it."""

from __future__ import annotations

import math

from numpy.typing import NDArray

from demo_game.collision import Box, Post

from . import flag, jetty, layout, sight_posts, windmill
from .cabin_solid import Block
from .layout import BIRCH, BUSH, CONIFER
from .scatter import VARIANTS, Trees
from .terrain import Terrain

SUNK = 1.0  # m that everything reaches into the ground


def cabin_boxes(blocks: list[Block], origin: NDArray) -> list[Box]:
    """Walls with their door gap, furniture, and floors and steps whose tops carry walkers."""
    found = []
    for block in blocks:
        if block.solid:
            x, y, z = (block.center + origin).tolist()
            wide, tall, deep = (block.size / 2.0).tolist()
            found.append(Box((x, z), (wide, deep), y - tall, y + tall, block.heading))
    return found


def tree_posts(trees: Trees) -> list[Post]:
    """Trunks and bushes."""
    found = []
    rows = zip(trees.foot.tolist(), trees.height.tolist(), trees.shape.tolist(), strict=True)
    for (x, y, z), tall, shape in rows:
        kind = shape // VARIANTS
        share = {CONIFER: 0.026, BIRCH: 0.018, BUSH: 0.42}.get(kind, 0.032)
        high = 0.5 if kind == BUSH else 0.4
        found.append(Post((x, z), share * tall, y - SUNK, y + high * tall))
    return found


def fence_boxes(terrain: Terrain, fences: list[list[list[float]]]) -> list[Box]:
    """One box between every two posts."""
    found = []
    for posts in fences:
        for (x0, z0), (x1, z1) in zip(posts[:-1], posts[1:], strict=True):
            x, z = (x0 + x1) / 2.0, (z0 + z1) / 2.0
            y = terrain.height(x, z)
            half = (math.hypot(x1 - x0, z1 - z0) / 2.0, 0.07)
            heading = math.atan2(-(z1 - z0), x1 - x0)
            found.append(Box((x, z), half, y - SUNK, y + 1.15, heading))
    return found


def single_posts(
    terrain: Terrain, rocks: list[tuple[float, float, float, float, float]]
) -> list[Post]:
    """Rocks, lamp posts, mailbox, flag pole, the windmill's tower."""
    found = [Post((x, z), 0.40 * size, y - SUNK, y + 0.30 * size) for x, y, z, size, _ in rocks]

    def put(x: float, z: float, radius: float, tall: float) -> None:
        y = terrain.height(x, z)
        found.append(Post((x, z), radius, y - SUNK, y + tall))

    for x, z in layout.LAMPS:
        put(x, z, 0.12, 3.6)
    for x, z in sight_posts.feet().tolist():
        put(x, z, 0.3, sight_posts.TALL)
    put(*layout.MAILBOX, 0.16, 1.4)
    put(*layout.FLAG, 0.08, flag.TALL)
    put(*layout.WINDMILL, windmill.radius_at(0.5), windmill.HEIGHT)
    return found


def yard_boxes(terrain: Terrain) -> list[Box]:
    """The bench by the path, the woodpile at the cabin, the jetty in the pond."""
    (x, z), turn = layout.BENCH, layout.BENCH_FACING
    y = terrain.height(x, z)
    found = [Box((x, z), (0.85, 0.25), y - SUNK, y + 0.48, turn)]
    x, z = layout.WOODPILE
    y = terrain.height(x, z)
    found.append(Box((x, z), (0.26, 1.5), y - SUNK, y + 1.0))
    return [*found, jetty.deck_box(terrain)]
