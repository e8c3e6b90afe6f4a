"""The cabin's shell: foundation, clapboard walls, shingled roof, chimney. Local axes: the middle
of the room, y = 0 on the floor, the door in the +z wall."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import palette
from .mesh import STONE, WOOD, Builder, axis_matrix

WIDTH, DEPTH = 6.0, 5.0  # m, outside of the walls, along x and z
WALL = 0.16  # m
ROW = 0.225  # m, one plank
ROWS = 12
TOP = ROW * ROWS  # m, top of the walls
PITCH = np.radians(38.0)
EAVES, GABLE = 0.34, 0.5  # m, overhang
FLOOR_ABOVE_GROUND = 0.56  # m
RIDGE = TOP + DEPTH / 2.0 * np.tan(PITCH)

# (wall, from, to along it, from, to in plank rows)
DOOR = ("front", -0.52, 0.52, 0, 9)
WINDOWS = [
    ("front", 1.45, 2.45, 4, 9), ("left", -0.55, 0.55, 4, 9),
    ("right", -2.0, -1.0, 4, 9), ("back", -1.9, -0.7, 4, 9),
]  # fmt: skip
# name: outward normal and the direction of its coordinate, length, distance from the middle
WALLS = {
    "front": (np.array([0.0, 0, 1]), np.array([1.0, 0, 0]), WIDTH, DEPTH / 2),
    "back": (np.array([0.0, 0, -1]), np.array([-1.0, 0, 0]), WIDTH, DEPTH / 2),
    "left": (np.array([-1.0, 0, 0]), np.array([0.0, 0, 1]), DEPTH, WIDTH / 2),
    "right": (np.array([1.0, 0, 0]), np.array([0.0, 0, -1]), DEPTH, WIDTH / 2),
}
UP = np.array([0.0, 1.0, 0.0])


def spans(wall: str, row: int) -> list[tuple[float, float]]:
    """The stretches of a wall's plank row that openings leave, m along the wall."""
    _, _, length, _ = WALLS[wall]
    reach = length / 2.0
    if row >= ROWS:  # gables narrow to the ridge
        reach = min(reach, (RIDGE - (row + 0.5) * ROW) / np.tan(PITCH) + 0.04)
    edges = [-reach]
    for name, low, high, first, last in sorted([DOOR, *WINDOWS], key=lambda o: o[1]):
        if name == wall and first <= row < last:
            edges += [low, high]
    edges.append(reach)
    return list(zip(edges[::2], edges[1::2], strict=True))


def rows_of(wall: str) -> int:
    """Plank rows of a wall; the gables have more."""
    return ROWS if wall in ("front", "back") else int((RIDGE - 0.12) / ROW)


def walls(build: Builder, room: Builder) -> None:
    """Lapped planks outside, flush planks inside (into `room`), frames round the openings."""
    for name, (out, along, _, away) in WALLS.items():
        for row in range(rows_of(name)):
            low, high = row * ROW, (row + 1) * ROW
            for start, end in spans(name, row):
                tint = 1.0 + 0.13 * build.random.uniform(-1.0, 1.0)
                lap = out * (away + 0.028), out * (away + 0.006)
                a, b = along * start, along * end
                face = [a + lap[0] + UP * low, b + lap[0] + UP * low]
                face += [b + lap[1] + UP * high, a + lap[1] + UP * high]
                cuts = max(1, round((end - start) / 1.2))
                build.quad(face, palette.PLANK * tint, WOOD, cuts)
                under = [a + out * away + UP * low, b + out * away + UP * low]
                build.quad([*under, face[1], face[0]], palette.PLANK * tint * 0.5, WOOD)
                inner = out * (away - WALL)
                back = [b + inner + UP * low, a + inner + UP * low]
                back += [a + inner + UP * high, b + inner + UP * high]
                tint = 1.0 + 0.10 * build.random.uniform(-1.0, 1.0)
                cuts = max(1, round((end - start) / 0.6))
                room.quad(back, palette.PLANK_INSIDE * tint, WOOD, cuts)
    for x in (-1, 1):
        for z in (-1, 1):
            at = (x * (WIDTH / 2 - 0.02), TOP / 2, z * (DEPTH / 2 - 0.02))
            build.box(at, (0.17, TOP, 0.17), palette.TRIM, skip="+y -y")
    for opening in [DOOR, *WINDOWS]:
        _frame(build, *opening)


def _frame(build: Builder, wall: str, low: float, high: float, first: int, last: int) -> None:
    out, along, _, away = WALLS[wall]
    turn = np.stack([along, UP, out], 1)
    bottom, top = first * ROW, last * ROW
    depth = WALL + 0.09
    middle = out * (away - WALL / 2.0)

    def piece(u: float, v: float, size: ArrayLike, color: NDArray = palette.TRIM) -> None:
        build.box(middle + along * u + UP * v, size, color, rotation=turn)

    for u in (low - 0.03, high + 0.03):
        piece(u, (bottom + top) / 2.0, (0.10, top - bottom, depth))
    piece((low + high) / 2.0, top + 0.05, (high - low + 0.24, 0.10, depth + 0.03))
    if first > 0:
        piece((low + high) / 2.0, bottom - 0.03, (high - low + 0.26, 0.07, depth + 0.10))
        piece((low + high) / 2.0, (bottom + top) / 2.0, (0.045, top - bottom, 0.05))
        piece((low + high) / 2.0, (bottom + top) / 2.0, (high - low, 0.045, 0.05))


def roof(build: Builder, room: Builder) -> None:
    """Two slopes of shingle courses, ridge and rake boards; boards below (into `room`)."""
    length = WIDTH + 2.0 * GABLE
    slope = (DEPTH / 2.0 + EAVES) / np.cos(PITCH)
    courses, thick = 12, 0.10
    for side in (1.0, -1.0):
        down = np.array([0.0, -np.sin(PITCH), side * np.cos(PITCH)])
        normal = np.array([0.0, np.cos(PITCH), side * np.sin(PITCH)])
        right = np.array([side, 0.0, 0.0])
        ridge = np.array([0.0, RIDGE + 0.04, 0.0])
        for course in range(courses):
            top = ridge + down * slope * course / courses + normal * (thick - 0.02)
            low = ridge + down * slope * (course + 1) / courses + normal * (thick + 0.03)
            edges = np.linspace(-length / 2.0, length / 2.0, 15)
            edges[1:-1] += build.random.uniform(-0.12, 0.12, 13)
            moss = course / courses * 0.5
            for a, b in zip(edges[:-1], edges[1:], strict=True):
                mix = moss * build.random.random()
                color = palette.SHINGLE + (palette.SHINGLE_MOSS - palette.SHINGLE) * mix
                color = color * (1.0 + 0.16 * build.random.uniform(-1.0, 1.0))
                drop = down * build.random.uniform(-0.015, 0.03)
                face = [low + right * a + drop, low + right * b + drop, top + right * b]
                build.quad([*face, top + right * a], color, WOOD)
            lip = low - normal * 0.06
            ends = right * -length / 2.0, right * length / 2.0
            face = [lip + ends[0], lip + ends[1], low + ends[1], low + ends[0]]
            build.quad(face, palette.SHINGLE * 0.78, WOOD)
        under, eave = ridge, ridge + down * slope
        face = [eave + right * length / 2, eave - right * length / 2, under - right * length / 2]
        room.quad([*face, under + right * length / 2], palette.BOARD * 0.8, WOOD, 10)
        turn = axis_matrix((1.0, 0.0, 0.0), side * PITCH)
        for x in (-length / 2.0, length / 2.0):
            at = ridge + down * slope / 2.0 + normal * 0.04
            build.box(at + (x, 0, 0), (0.06, 0.20, slope + 0.06), palette.TRIM, rotation=turn)
        build.box(eave + normal * 0.03, (length, 0.14, 0.05), palette.TRIM, rotation=turn)
    build.box((0, RIDGE + 0.17, 0), (length + 0.04, 0.07, 0.24), palette.SHINGLE * 0.8)


def foundation(build: Builder) -> None:
    """Field stones under the walls, and the chimney on the right."""
    for name in WALLS:
        out, along, length, away = WALLS[name]
        turn = np.stack([along, UP, out], 1)
        for low in (-1.05, -0.55):
            u = -length / 2.0
            while u < length / 2.0 - 0.05:
                size = min(build.random.uniform(0.45, 0.95), length / 2.0 - u)
                at = along * (u + size / 2.0) + out * (away - 0.10) + UP * (low + 0.25)
                bulge = build.random.uniform(0.24, 0.33)
                build.box(
                    at,
                    (size - 0.02, 0.48, bulge),
                    palette.STONE_COOL,
                    rotation=turn,
                    material=STONE,
                    vary=0.2,
                )
                u += size
    _chimney(build)


def _chimney(build: Builder) -> None:
    top, course = RIDGE + 0.75, 0.34
    for k, y in enumerate(np.arange(-1.0, top, course).tolist()):
        wide, deep = (1.25, 0.85) if y < 1.6 else (0.85, 0.62)
        jitter = build.random.uniform(-0.02, 0.02, 2)
        at = (WIDTH / 2 + deep / 2 - 0.02 + jitter[0], y + course / 2, -0.6 + jitter[1])
        color = palette.STONE_WARM if k % 3 else palette.STONE_COOL
        size = (deep, course - 0.015, wide)
        build.box(at, size, color, material=STONE, vary=0.12, cuts=2)
    cap = (WIDTH / 2 + 0.29, top + 0.10, -0.6)
    build.box(cap, (0.80, 0.12, 1.02), palette.STONE_COOL, material=STONE)
