"""A windmill: a tower that stands and four sails that turn. Local axes: y = 0 on the ground,
the sails look along +z."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from . import palette
from .mesh import PLAIN, STONE, WOOD, Builder, axis_matrix, placed, yaw_matrix

HEIGHT, STONE_TOP = 10.4, 4.2  # m
RADIUS_LOW, RADIUS_HIGH = 3.3, 2.05  # m
HUB = np.array([0.0, 11.35, 2.75])
TILT = np.radians(6.0)  # of the shaft, upwards
REACH, ROOT, CLOTH = 7.6, 1.5, 1.55  # m, sail's length, where its lattice starts, its width
FACING = -0.32  # rad
SIDES = 10


def radius_at(y: float) -> float:
    """Radius of the tower, m; flares a little at the foot."""
    share = y / HEIGHT
    return RADIUS_LOW + (RADIUS_HIGH - RADIUS_LOW) * share + 0.35 * (1.0 - share) ** 4


def tower(build: Builder) -> None:
    """Stone below, boards above, a gallery rail, a cap."""
    levels = [*np.linspace(-0.8, STONE_TOP, 6), *np.linspace(STONE_TOP, HEIGHT, 8)[1:]]
    angle = np.linspace(0.0, 2.0 * np.pi, SIDES + 1)
    for low, high in zip(levels[:-1], levels[1:], strict=True):
        stone = high <= STONE_TOP + 1e-6
        for a, b in zip(angle[:-1], angle[1:], strict=True):
            r0, r1 = radius_at(low) + (0.0 if stone else 0.05), radius_at(high)
            tint = 1.0 + 0.07 * build.random.uniform(-1, 1)
            color = (palette.LIME if stone else palette.PLANK * 1.05) * tint
            corner = [(r0 * np.sin(t), low, r0 * np.cos(t)) for t in (a, b)]
            corner += [(r1 * np.sin(t), high, r1 * np.cos(t)) for t in (b, a)]
            build.quad(corner, color, STONE if stone else WOOD)
            if not stone:  # the boards' lower edge
                edge = [(r * np.sin(t), low, r * np.cos(t)) for r, t in
                        ((r0 - 0.05, a), (r0 - 0.05, b), (r0, b), (r0, a))]  # fmt: skip
                build.quad(edge, palette.PLANK * 0.5, WOOD)
    _openings(build)
    _cap(build)


def _openings(build: Builder) -> None:
    for turn, y, size in ((0.3, 1.05, (1.15, 2.2)), (0.3, 5.6, (0.6, 0.8)), (0.3, 8.2, (0.5, 0.7)),
                          (2.2, 5.4, (0.6, 0.8)), (-1.6, 6.0, (0.6, 0.8))):  # fmt: skip
        rotation = yaw_matrix(turn)
        flat = radius_at(y) * np.cos(np.pi / SIDES)
        at = rotation @ np.array([0.0, y, flat + 0.02])
        color = palette.DOOR if size[1] > 1.0 else palette.GLASS * 0.5
        frame = (size[0] + 0.24, size[1] + 0.2, 0.22)
        build.box(at, frame, palette.BEAM, rotation=rotation)
        at = rotation @ np.array([0.0, y - 0.02, flat + 0.10])
        build.box(at, (*size, 0.12), color, rotation=rotation, material=WOOD)


def _cap(build: Builder) -> None:
    angle = np.linspace(0.0, 2.0 * np.pi, SIDES + 1)
    rings = [(RADIUS_HIGH + 0.28, HEIGHT - 0.05), (RADIUS_HIGH + 0.22, HEIGHT + 0.35),
             (1.75, HEIGHT + 1.55), (0.85, HEIGHT + 2.3), (0.03, HEIGHT + 2.65)]  # fmt: skip
    for (r0, y0), (r1, y1) in zip(rings[:-1], rings[1:], strict=True):
        for a, b in zip(angle[:-1], angle[1:], strict=True):
            tint = 1.0 + 0.1 * build.random.uniform(-1, 1)
            corner = [(r0 * np.sin(t), y0, r0 * np.cos(t)) for t in (a, b)]
            corner += [(r1 * np.sin(t), y1, r1 * np.cos(t)) for t in (b, a)]
            build.quad(corner, palette.SHINGLE * tint, WOOD)
    ring = np.stack(
        [rings[0][0] * np.sin(angle[:-1]), 0 * angle[:-1], rings[0][0] * np.cos(angle[:-1])], 1
    )
    fan = np.array([[0, i + 1, i] for i in range(1, SIDES - 1)])
    build.faces(ring + (0, HEIGHT - 0.05, 0), fan, palette.BEAM * 0.6)
    shaft = np.array([0.0, np.sin(TILT), np.cos(TILT)])
    build.tube(HUB - shaft * 2.2, HUB - shaft * 0.2, (0.26, 0.22), palette.BEAM, sides=8)


def sails(build: Builder) -> None:
    """Four lattice arms with half their cloth set, about the hub, in the xy plane."""
    build.tube((0, 0, -0.35), (0, 0, 0.3), (0.30, 0.24), palette.IRON, sides=8, caps=True)
    for k in range(4):
        turn = axis_matrix((0, 0, 1), k * np.pi / 2)

        def at(x: float, y: float, z: float, turn: NDArray = turn) -> NDArray:
            return turn @ np.array([x, y, z])

        build.box(at(0, REACH / 2, 0), (0.18, REACH, 0.16), palette.BEAM, rotation=turn)
        twist = np.linspace(0.30, 0.06, 9)  # m, the cloth's outer edge leans back less and less
        heights = np.linspace(ROOT, REACH - 0.1, 9)
        for y, lean in zip(heights, twist, strict=True):
            start, end = at(-0.42, y, -0.05 + lean * 0.3), at(CLOTH, y, 0.05 - lean)
            build.tube(start, end, (0.035, 0.03), palette.BEAM, sides=4)
        for x, share in ((CLOTH, 1.0), (CLOTH * 0.5, 0.5), (-0.42, -0.3)):
            start = at(x, ROOT, -lean_at(twist[0], share))
            end = at(x, REACH - 0.1, -lean_at(twist[-1], share))
            build.tube(start, end, (0.03, 0.03), palette.BEAM, sides=4)
        for j in range(8):
            low, high = heights[j], heights[j + 1]
            inner, outer = 0.08, CLOTH * 0.97
            corner = [at(inner, low, 0.05), at(outer, low, 0.08 - twist[j])]
            corner += [at(outer, high, 0.08 - twist[j + 1]), at(inner, high, 0.05)]
            tint = palette.SAIL * (1.0 + 0.05 * build.random.uniform(-1, 1))
            build.quad(corner, tint, PLAIN)
            back = [p - turn @ np.array([0.0, 0.0, 0.02]) for p in corner[::-1]]
            build.quad(back, tint * 0.85, PLAIN)


def lean_at(twist: float, share: float) -> float:
    """How far back a bar across the sail lies, m."""
    return twist * share - 0.05


def base(ground: float, x: float, z: float) -> NDArray:
    """(4, 4) transform of the tower."""
    return placed(yaw_matrix(FACING), (x, ground, z))


def sail_pose(t: float, stand: NDArray) -> NDArray:
    """(4, 4) transform of the sails at time t, s: about 7 turns a minute, with the gusts."""
    angle = -(0.72 * t + 0.5 * np.sin(0.23 * t) + 0.22 * np.sin(0.61 * t + 1.0))
    tilt = axis_matrix((1.0, 0.0, 0.0), -TILT)
    return stand @ placed(tilt @ axis_matrix((0.0, 0.0, 1.0), angle), HUB)
