"""The cabin as a few solid blocks: what blocks walkers, rain, and the light of sky and lamps."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import cabin, cabin_porch, cabin_room, palette
from .cabin import DEPTH, EAVES, GABLE, PITCH, RIDGE, ROW, TOP, WALL, WALLS, WIDTH
from .mesh import PLAIN, Builder, Mesh, axis_matrix, yaw_matrix


@dataclass(frozen=True)
class Block:
    """A box in the cabin's own axes."""

    center: NDArray  # (3,), m
    size: NDArray  # (3,), m
    rotation: NDArray  # (3, 3)
    walkable: bool = False
    solid: bool = True  # stops walkers
    stone: bool = False
    heading: float = 0.0  # rad, of a box turned about the vertical only


def _block(center, size, **more) -> Block:  # type: ignore[no-untyped-def]
    rotation = more.pop("rotation", np.eye(3))
    return Block(np.asarray(center, "f8"), np.asarray(size, "f8"), rotation, **more)


def wall_blocks() -> list[Block]:
    """Walls with their openings cut out."""
    found = []
    for name, (out, along, length, away) in WALLS.items():
        middle = out * (away - WALL / 2.0)

        def add(low: float, high: float, bottom: float, top: float) -> None:
            if high - low > 0.01 and top - bottom > 0.01:
                center = middle + along * (low + high) / 2.0  # noqa: B023
                center = center + np.array([0.0, (bottom + top) / 2.0, 0.0])
                across = np.abs(along) * (high - low) + np.abs(out) * WALL  # noqa: B023
                found.append(_block(center, across + np.array([0.0, top - bottom, 0.0])))

        reach = -length / 2.0
        for wall, low, high, first, last in sorted(
            [cabin.DOOR, *cabin.WINDOWS], key=lambda o: o[1]
        ):
            if wall != name:
                continue
            add(reach, low, 0.0, TOP)
            add(low, high, 0.0, first * ROW)
            add(low, high, last * ROW, TOP)
            reach = high
        add(reach, length / 2.0, 0.0, TOP)
        if name in ("left", "right"):  # the gable, as three lower and lower blocks
            for k in range(3):
                bottom = TOP + (RIDGE - TOP) * k / 3.0
                half = (RIDGE - bottom - (RIDGE - TOP) / 6.0) / np.tan(PITCH)
                add(-half, half, bottom, bottom + (RIDGE - TOP) / 3.0)
    return found


def roof_blocks() -> list[Block]:
    """The roof's two slopes and the porch's, not for walkers."""
    # Each reaches a little over the ridge: rain falls through the narrowest gap between them.
    over = 0.07
    slope = (DEPTH / 2.0 + EAVES) / np.cos(PITCH)
    found = []
    for side in (1.0, -1.0):
        down = np.array([0.0, -np.sin(PITCH), side * np.cos(PITCH)])
        normal = np.array([0.0, np.cos(PITCH), side * np.sin(PITCH)])
        middle = down * (slope - over) / 2.0
        center = np.array([0.0, RIDGE + 0.04, 0.0]) + middle + normal * 0.035
        turn = axis_matrix((1.0, 0.0, 0.0), side * PITCH)
        size = (WIDTH + 2.0 * GABLE, 0.05, slope + over)
        found.append(_block(center, size, rotation=turn, solid=False))
    start, end = DEPTH / 2.0 - 0.02, DEPTH / 2.0 + cabin_porch.PORCH + 0.32
    fall = (cabin_porch.ROOF_HIGH - cabin_porch.ROOF_LOW) / (cabin_porch.POST_Z - start)
    middle = cabin_porch.ROOF_HIGH - fall * (end - start) / 2.0 + 0.045
    turn = axis_matrix((1.0, 0.0, 0.0), np.arctan(fall))
    size = (WIDTH + 0.7, 0.05, (end - start) / np.cos(np.arctan(fall)))
    found.append(_block((0.0, middle, (start + end) / 2.0), size, rotation=turn, solid=False))
    return found


def floor_blocks() -> list[Block]:
    """Room, porch and steps: what one stands on."""
    porch, front = cabin_porch.PORCH, DEPTH / 2.0
    found = [_block((0.0, -0.5, 0.0), (WIDTH, 1.0, DEPTH), walkable=True)]
    found.append(_block((0.0, -0.5, front + porch / 2.0), (WIDTH, 1.0, porch), walkable=True))
    found += [_block(center, size, walkable=True) for center, size in cabin_porch.step_boxes()]
    return found


def blocks() -> list[Block]:
    """All of them."""
    found = floor_blocks() + wall_blocks() + roof_blocks()
    for x in cabin_porch.POSTS:
        foot = (x, cabin_porch.ROOF_LOW / 2.0, cabin_porch.POST_Z)
        found.append(_block(foot, (0.14, cabin_porch.ROOF_LOW, 0.14)))
    for (x0, z0), (x1, z1) in cabin_porch.rails():
        rail = (max(x1 - x0, 0.07), 0.95, max(z1 - z0, 0.07))
        found.append(_block(((x0 + x1) / 2.0, 0.475, (z0 + z1) / 2.0), rail))
    center, size, turn = cabin_porch.door_box()
    found.append(_block(center, size, rotation=yaw_matrix(turn), heading=turn))
    found += [_block(at, extent) for at, extent in cabin_room.FURNITURE]
    bottom, top = -1.0, RIDGE + 0.72  # the chimney, a little inside its stones
    at = (WIDTH / 2 + 0.38, (bottom + 1.6) / 2.0, -0.6)
    found.append(_block(at, (0.74, 1.6 - bottom, 1.14), stone=True))
    at = (WIDTH / 2 + 0.27, (1.6 + top) / 2.0, -0.6)
    found.append(_block(at, (0.50, top - 1.6, 0.74), stone=True))
    return found


def pane_blocks(openings: list[tuple[str, float, float, int, int]]) -> list[Block]:
    """A pane in each opening."""
    found = []
    for wall, low, high, first, last in openings:
        out, along, _, away = WALLS[wall]
        turn = np.stack([along, (0.0, 1.0, 0.0), out], 1)
        middle = out * (away - WALL / 2.0) + along * (low + high) / 2.0
        middle = middle + (0.0, (first + last) * ROW / 2.0, 0.0)
        found.append(_block(middle, (high - low, (last - first) * ROW, 0.02), rotation=turn))
    return found


def simple_mesh(blocks: list[Block]) -> Mesh:
    """The cabin for the distance: its blocks, dark panes in its openings."""
    build = Builder(29)
    for block in blocks:
        if block.size[1] >= 1.0 and block.walkable:
            color = palette.BEAM * 0.6
        elif not block.solid:
            color = palette.SHINGLE
        elif block.stone:
            color = palette.STONE_WARM
        elif block.heading:
            color = palette.DOOR
        else:
            color = palette.PLANK
        if min(block.size) < 0.145 and block.solid and not block.heading:
            color = palette.BEAM
        build.box(block.center, block.size, color, rotation=block.rotation, material=PLAIN)
    for pane in pane_blocks([cabin.DOOR, *cabin.WINDOWS]):
        glass = palette.GLASS * 0.25
        build.box(pane.center, pane.size, glass, rotation=pane.rotation, material=PLAIN)
    return build.build()
