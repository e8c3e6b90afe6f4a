"""The place's meshes, their light baked into them."""

from __future__ import annotations

import math
from collections.abc import Iterator, Sequence

import numpy as np
from numpy.typing import NDArray

from . import (
    bake,
    cabin,
    cabin_porch,
    cabin_room,
    cabin_solid,
    figure,
    flag,
    jetty,
    layout,
    props,
    sight_posts,
    windmill,
)
from .cabin_solid import Block
from .mesh import Builder, Mesh, merge, placed, yaw_matrix
from .rocks import rock
from .terrain import Terrain

EMBER_LIGHT = 0.25  # of a lamp's
BIG_ROCK = 1.2  # m, from where a rock has four times the faces
# Sky light that walls do not keep out, in lieu of what they throw back.
BOUNCE_ROOM, BOUNCE_OUTSIDE = 0.30, 0.10


def towards_path(path: NDArray, x: float, z: float) -> float:
    """Heading (rad about +y, 0 looks along +z) from (x, z) to the nearest of the path's points."""
    gap = path - (x, z)
    nearest = gap[np.argmin(np.hypot(gap[:, 0], gap[:, 1]))]
    return float(math.atan2(nearest[0], nearest[1]))


def cabin_meshes(
    blocks: list[Block], origin: NDArray, lamps: Sequence[tuple]
) -> Iterator[tuple[str, Mesh]]:
    """Room, letter, shell, and the simple cabin for the distance, in the world's axes."""
    lights = [(np.array(lamp[0]) - origin, max(lamp[1])) for lamp in lamps]
    lights.append((np.array(cabin_room.EMBERS), EMBER_LIGHT))
    shell, inside, letter = Builder(21), Builder(22), Builder()
    cabin.walls(shell, inside)
    cabin.roof(shell, inside)
    for part in (cabin.foundation, cabin_porch.porch, cabin_porch.steps, cabin_porch.door):
        part(shell)
    cabin_room.room(inside, letter)
    simple = cabin_solid.simple_mesh(blocks)
    for name, mesh, bounce in (
        ("room", inside.build(), BOUNCE_ROOM),
        ("letter", letter.build(), BOUNCE_ROOM),
        ("cabin", shell.build(), BOUNCE_OUTSIDE),
        ("cabin_far", simple, BOUNCE_OUTSIDE),
    ):
        yield name, bake.bake(mesh, blocks, lights, bounce).moved(placed(np.eye(3), origin))


def open_meshes(
    terrain: Terrain, fences: list[list[list[float]]], rocks: list[tuple], mill: NDArray
) -> Iterator[tuple[str, Mesh]]:
    """What stands in the open, in the world's axes; lit by nothing yet."""
    height = terrain.height
    posts, rails, box, yard = Builder(23), Builder(24), Builder(25), Builder(26)
    for x, z in layout.LAMPS:
        props.lamp_post(posts, x, height(x, z), z, towards_path(terrain.path, x, z))
    yield "lamps", posts.build()
    for line in fences:
        props.fence(rails, np.array(line), height)
    yield "fences", rails.build()
    x, z = layout.MAILBOX
    props.mailbox(box, x, height(x, z), z, towards_path(terrain.path, x, z))
    yield "mailbox", box.build()
    x, z = layout.WOODPILE
    props.woodpile(yard, x, height(x, z), z, 3.0)
    x, z = layout.BENCH
    props.bench(yard, x, height(x, z), z, layout.BENCH_FACING)
    x, z = layout.FLAG
    flag.pole(yard, x, height(x, z), z)
    yield "yard", yard.build()
    pier = Builder(31)
    jetty.jetty(pier, terrain)
    yield "jetty", pier.build()
    row = Builder(29)
    sight_posts.posts(row, height)
    yield "sight_posts", row.build()
    stones = []
    for k, (x, y, z, size, turn) in enumerate(rocks):
        shape = rock(300 + k % 5, 2 if size > BIG_ROCK else 1)
        stones.append(shape.moved(placed(yaw_matrix(turn) * size, (x, y, z))))
    yield "rocks", merge(stones)
    tower = Builder(27)
    windmill.tower(tower)
    yield "windmill", tower.build().moved(mill)


def moving_meshes() -> Iterator[tuple[str, Mesh]]:
    """Figure and sails in their parts' own axes; the sails are the part after the figure's."""
    yield "figure", figure.mesh()
    sails = Builder(28)
    sails.part = len(figure.PARTS)
    windmill.sails(sails)
    yield "sails", sails.build(dynamic=True)
