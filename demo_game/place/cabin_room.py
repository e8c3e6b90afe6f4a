"""Inside the cabin: floor, beams, hearth, table with the letter, bench, bed, shelf."""

from __future__ import annotations

from . import palette
from .cabin import DEPTH, TOP, WALL, WIDTH
from .cabin_porch import lantern
from .mesh import GLOW, PLAIN, STONE, Builder, yaw_matrix

TABLE = (-1.65, -0.95)  # (x, z)
LETTER = (TABLE[0] + 0.3, 0.772, TABLE[1] + 0.1)
LAMP = (-1.9, 0.98, -1.1)  # the lantern's light
EMBERS = (WIDTH / 2 - 0.42, 0.22, -0.6)
# What stands in the way, local axes: (centre, size)
FURNITURE = [
    ((TABLE[0], 0.38, TABLE[1]), (1.5, 0.76, 0.85)),
    ((2.15, 0.28, -1.75), (1.35, 0.56, 0.95)),
    ((WIDTH / 2 - 0.36, 0.6, -0.6), (0.4, 1.2, 1.5)),
    ((-2.5, 0.95, 1.6), (0.45, 1.9, 1.1)),
]


def room(build: Builder, letter: Builder) -> None:
    """Everything in the room that does not move; the letter can be taken, so it is apart."""
    wide, deep = WIDTH - 2 * WALL, DEPTH - 2 * WALL
    boards = 20
    for k in range(boards):
        z = -deep / 2 + (k + 0.5) * deep / boards
        size = (wide, 0.05, deep / boards - 0.006)
        skip = "-x +x -y -z +z"
        build.box((0, -0.025, z), size, palette.BOARD * 1.05, vary=0.12, cuts=12, skip=skip)
    build.box((0, -0.06, 0), (wide, 0.02, deep), palette.BEAM * 0.2, skip="-x +x -y -z +z")
    build.box((0, -0.03, DEPTH / 2 - WALL / 2), (1.04, 0.06, WALL + 0.1), palette.BEAM)  # sill
    for x in (-1.9, 0.0, 1.9):
        build.box((x, TOP - 0.09, 0), (0.16, 0.2, deep), palette.BEAM, cuts=4)
    _table(build, letter)
    _hearth(build)
    _bed(build)
    _shelf(build)
    build.box((0.2, 0.006, -0.3), (2.0, 0.012, 1.4), palette.CLOTH * 0.8, material=PLAIN, cuts=4)
    build.box((0.2, 0.012, -0.3), (1.7, 0.012, 1.1), palette.LINEN * 0.6, material=PLAIN, cuts=4)


def _table(build: Builder, letter: Builder) -> None:
    x, z = TABLE
    for k in range(4):
        at = (x, 0.74, z - 0.31 + k * 0.21)
        build.box(at, (1.5, 0.05, 0.2), palette.BOARD, vary=0.1, cuts=4)
    for sx in (-0.65, 0.65):
        for sz in (-0.32, 0.32):
            build.box((x + sx, 0.36, z + sz), (0.08, 0.72, 0.08), palette.BEAM)
    build.box((x, 0.42, z + 0.85), (1.4, 0.05, 0.3), palette.BOARD, cuts=3)  # bench
    for sx in (-0.55, 0.55):
        build.box((x + sx, 0.2, z + 0.85), (0.06, 0.4, 0.26), palette.BEAM)
    turn = yaw_matrix(0.35)
    letter.random = build.random
    size = (0.24, 0.008, 0.16)
    letter.box(LETTER, size, palette.PAPER, rotation=turn, material=PLAIN, vary=0.0)
    seal = (LETTER[0], 0.78, LETTER[2])
    letter.box(seal, (0.03, 0.008, 0.03), palette.MAILBOX_RED, rotation=turn, material=PLAIN)
    lantern(build, LAMP[0], 0.765, LAMP[2])
    build.tube((x + 0.1, 0.765, z - 0.25), (x + 0.1, 0.87, z - 0.25), (0.04, 0.045), palette.TRIM)


def _hearth(build: Builder) -> None:
    x, z = WIDTH / 2 - 0.34, -0.6
    for side in (-1, 1):
        at = (x, 0.55, z + side * 0.58)
        build.box(at, (0.36, 1.1, 0.34), palette.STONE_WARM, material=STONE, cuts=3)
    build.box((x, 1.15, z), (0.46, 0.16, 1.62), palette.BEAM, cuts=3)
    at = (x + 0.04, 1.95, z)
    build.box(at, (0.26, 1.5, 1.1), palette.STONE_WARM, material=STONE, cuts=3)
    build.box((x - 0.3, 0.03, z), (0.75, 0.06, 1.5), palette.STONE_COOL, material=STONE, cuts=3)
    build.box((x + 0.15, 0.5, z), (0.04, 1.1, 0.8), palette.IRON * 0.3, material=PLAIN)
    for k, (dx, dz) in enumerate(((0.0, -0.12), (-0.08, 0.1), (0.04, 0.02))):
        turn = yaw_matrix(1.2 + k)
        at = (x + dx - 0.02, 0.12 + 0.05 * k, z + dz)
        build.box(at, (0.45, 0.09, 0.09), palette.BEAM * 0.4, rotation=turn)
    ember = palette.GLOW_WARM * (0.9, 0.42, 0.25)
    build.box((x - 0.02, 0.10, z), (0.22, 0.05, 0.34), ember, material=GLOW)


def _bed(build: Builder) -> None:
    x, z = 2.15, -1.75
    build.box((x, 0.22, z), (1.4, 0.2, 0.98), palette.BEAM, cuts=2)
    build.box((x, 0.40, z), (1.34, 0.18, 0.92), palette.LINEN * 0.8, material=PLAIN, cuts=3)
    build.box((x - 0.2, 0.46, z), (0.95, 0.12, 0.97), palette.CLOTH, material=PLAIN, cuts=3)
    build.box((x + 0.5, 0.53, z), (0.3, 0.12, 0.6), palette.LINEN, material=PLAIN)
    build.box((x + 0.72, 0.4, z), (0.06, 0.8, 0.98), palette.BEAM)


def _shelf(build: Builder) -> None:
    x, z = -2.55, 1.6
    for y in (0.05, 0.55, 1.05, 1.5, 1.88):
        build.box((x, y, z), (0.36, 0.04, 1.1), palette.BOARD, cuts=2)
    for side in (-1, 1):
        build.box((x, 0.95, z + side * 0.55), (0.36, 1.9, 0.04), palette.BOARD)
    books = (palette.CLOTH, palette.DOOR, palette.LINEN * 0.8, palette.HEATH, palette.BEAM)
    for y in (0.57, 1.07, 1.52):
        reach = z - 0.48
        while reach < z + 0.32 * build.random.uniform(0.4, 1.0):
            thick = build.random.uniform(0.03, 0.07)
            tall = build.random.uniform(0.2, 0.32)
            color = books[int(build.random.integers(len(books)))]
            at = (x - 0.02, y + tall / 2, reach + thick / 2)
            build.box(at, (0.2, tall, thick), color, material=PLAIN, skip="-y")
            reach += thick + 0.004
