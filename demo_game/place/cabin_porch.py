"""The cabin's porch, steps and open door."""

from __future__ import annotations

import numpy as np

from . import palette
from .cabin import DEPTH, DOOR, FLOOR_ABOVE_GROUND, ROW, TOP, WIDTH
from .mesh import GLOW, PLAIN, WOOD, Builder, axis_matrix, yaw_matrix

PORCH = 2.1  # m, depth
STEPS, TREAD, STEPS_WIDE = 3, 0.32, 2.0
POSTS = (-2.86, -1.12, 1.12, 2.86)  # m, x of the porch's posts
POST_Z = DEPTH / 2.0 + PORCH - 0.14
ROOF_HIGH, ROOF_LOW = TOP - 0.22, 2.10  # m, underside at the wall and at the edge
DOOR_OPEN = np.radians(152.0)
LANTERN = (-1.75, 1.86, DEPTH / 2.0 + 1.1)  # local, hangs from the porch roof


def porch(build: Builder) -> None:
    """Floor boards, posts, rails, lean-to roof."""
    front = DEPTH / 2.0
    boards = 9
    for k in range(boards):
        z = front + (k + 0.5) * PORCH / boards
        size = (WIDTH, 0.06, PORCH / boards - 0.012)
        build.box((0, -0.03, z), size, palette.BOARD, vary=0.12, cuts=6, skip="-y")
    edge = front + PORCH
    build.box((0, -0.15, edge - 0.04), (WIDTH, 0.18, 0.05), palette.BEAM)
    for side in (-1, 1):
        at = (side * (WIDTH / 2 - 0.03), -0.15, front + PORCH / 2)
        build.box(at, (0.05, 0.18, PORCH), palette.BEAM)
    build.box((0, -0.75, edge - 0.18), (WIDTH - 0.2, 1.0, 0.1), palette.BEAM * 0.35)
    for side in (-1, 1):
        at = (side * (WIDTH / 2 - 0.16), -0.75, front + PORCH / 2)
        build.box(at, (0.1, 1.0, PORCH - 0.2), palette.BEAM * 0.35)
    for x in POSTS:
        build.box((x, ROOF_LOW / 2.0, POST_Z), (0.13, ROOF_LOW, 0.13), palette.BEAM, skip="+y -y")
        build.box((x, -0.7, POST_Z), (0.18, 1.0, 0.18), palette.BEAM * 0.7, skip="+y -y")
        for way in (-1, 1):  # braces
            turn = axis_matrix((0, 0, 1), way * np.radians(45.0))
            at = (x + way * 0.21, ROOF_LOW - 0.24, POST_Z)
            build.box(at, (0.07, 0.58, 0.06), palette.BEAM, rotation=turn)
    build.box((0, ROOF_LOW, POST_Z), (WIDTH + 0.3, 0.14, 0.12), palette.BEAM)
    for low, high in rails():
        (x0, z0), (x1, z1) = low, high
        middle = ((x0 + x1) / 2.0, (z0 + z1) / 2.0)
        size = (max(x1 - x0, 0.07), 0.06, max(z1 - z0, 0.07))
        build.box((middle[0], 0.92, middle[1]), size, palette.BEAM)
        build.box((middle[0], 0.16, middle[1]), size, palette.BEAM)
        count = int(max(x1 - x0, z1 - z0) / 0.17)
        for t in (np.arange(count) + 0.5) / count:
            at = (x0 + (x1 - x0) * t, 0.54, z0 + (z1 - z0) * t)
            build.box(at, (0.035, 0.72, 0.035), palette.BOARD, skip="+y -y")
    _lean_to(build)


def rails() -> list[tuple[tuple[float, float], tuple[float, float]]]:
    """Ends (x, z) of the porch's rails; open where the steps are."""
    front = DEPTH / 2.0
    pieces = [((POSTS[0], POST_Z), (POSTS[1], POST_Z)), ((POSTS[2], POST_Z), (POSTS[3], POST_Z))]
    pieces += [((x, front), (x, POST_Z)) for x in (POSTS[0], POSTS[3])]
    return pieces


def _lean_to(build: Builder) -> None:
    length = WIDTH + 0.7
    start, end = DEPTH / 2.0 - 0.02, DEPTH / 2.0 + PORCH + 0.32
    fall = (ROOF_HIGH - ROOF_LOW) / (POST_Z - start)
    courses = 7
    for k in range(courses):
        z0 = start + (end - start) * k / courses
        z1 = start + (end - start) * (k + 1) / courses
        y0 = ROOF_HIGH + 0.10 - fall * (z0 - start)
        y1 = ROOF_HIGH + 0.15 - fall * (z1 - start)
        edges = np.linspace(-length / 2, length / 2, 15)
        edges[1:-1] += build.random.uniform(-0.12, 0.12, 13)
        for a, b in zip(edges[:-1], edges[1:], strict=True):
            mix = build.random.random() * 0.5
            color = palette.SHINGLE + (palette.SHINGLE_MOSS - palette.SHINGLE) * mix
            color = color * (1.0 + 0.16 * build.random.uniform(-1.0, 1.0))
            build.quad([(a, y1, z1), (b, y1, z1), (b, y0, z0), (a, y0, z0)], color, WOOD)
        half = length / 2
        lip = [(-half, y1 - 0.05, z1), (half, y1 - 0.05, z1), (half, y1, z1), (-half, y1, z1)]
        build.quad(lip, palette.SHINGLE * 0.78, WOOD)
    low = ROOF_HIGH - fall * (end - start)
    half = length / 2
    under = [(half, low, end), (-half, low, end), (-half, ROOF_HIGH, start)]
    build.quad([*under, (half, ROOF_HIGH, start)], palette.BOARD * 0.8, WOOD, 10)
    build.box((0, low + 0.05, end), (length, 0.15, 0.05), palette.TRIM)
    turn = axis_matrix((1, 0, 0), np.arctan(fall))
    for x in (-half, half):
        at = (x, (ROOF_HIGH + low) / 2 + 0.06, (start + end) / 2)
        build.box(at, (0.05, 0.18, (end - start) * 1.03), palette.TRIM, rotation=turn)
    for x in np.linspace(-half + 0.5, half - 0.5, 7):  # rafters
        at = (x, (ROOF_HIGH + low) / 2 - 0.04, (start + end) / 2)
        build.box(at, (0.07, 0.10, end - start), palette.BEAM, rotation=turn)


def step_boxes() -> list[tuple[tuple[float, float, float], tuple[float, float, float]]]:
    """Centre and size of each step, local axes, highest first."""
    rise = FLOOR_ABOVE_GROUND / (STEPS + 1)
    edge = DEPTH / 2.0 + PORCH
    found = []
    for k in range(STEPS):
        top = -rise * (k + 1)
        found.append(
            ((0.0, top - 0.5, edge + TREAD * (k + 0.5)), (STEPS_WIDE - 0.02 * k, 1.0, TREAD))
        )
    return found


def steps(build: Builder) -> None:
    """Three broad steps down to the path."""
    for (x, y, z), (wide, tall, deep) in step_boxes():
        top = y + tall / 2.0
        tread = (wide + 0.06, 0.06, deep + 0.04)
        build.box((x, top - 0.03, z), tread, palette.BOARD, vary=0.1, cuts=2)
        riser = (wide, tall - 0.06, deep)
        build.box((x, y - 0.03, z), riser, palette.BEAM * 0.8, skip="+y -y", cuts=2)


def door_box() -> tuple[np.ndarray, np.ndarray, float]:
    """Centre, size and turn of the open door's leaf, local axes."""
    _, low, high, _, last = DOOR
    wide, tall = high - low, last * ROW - 0.03
    hinge = np.array([low, tall / 2.0 + 0.015, DEPTH / 2.0 + 0.06])
    turn = -DOOR_OPEN
    center = hinge + yaw_matrix(turn) @ np.array([wide / 2.0, 0.0, 0.0])
    return center, np.array([wide, tall, 0.05]), float(turn)


def door(build: Builder) -> None:
    """A plank door standing open, and the lantern beside it."""
    center, size, turn = door_box()
    rotation = yaw_matrix(turn)
    planks = 5
    for k in range(planks):
        offset = ((k + 0.5) / planks - 0.5) * size[0]
        at = center + rotation @ np.array([offset, 0.0, 0.0])
        plank = (size[0] / planks - 0.008, size[1], size[2])
        build.box(at, plank, palette.DOOR, rotation=rotation, vary=0.12)
    for y in (-0.62, 0.62):
        at = center + rotation @ np.array([0.0, y, 0.035])
        build.box(at, (size[0] - 0.1, 0.13, 0.03), palette.DOOR * 0.8, rotation=rotation)
        at = center + rotation @ np.array([0.0, y, -0.035])
        build.box(at, (size[0] - 0.1, 0.13, 0.03), palette.DOOR * 0.8, rotation=rotation)
    x, y, z = LANTERN
    lantern(build, x, y - 0.22, z)
    build.tube((x, y, z), (x, y + 0.5, z), (0.008, 0.008), palette.IRON, sides=4, material=PLAIN)


def lantern(build: Builder, x: float, y: float, z: float) -> None:
    """A small iron lantern standing at height y."""
    build.box((x, y + 0.02, z), (0.17, 0.03, 0.17), palette.IRON, material=PLAIN)
    build.box((x, y + 0.12, z), (0.10, 0.17, 0.10), palette.GLOW_WARM, material=GLOW, vary=0.0)
    for sx in (-0.065, 0.065):
        for sz in (-0.065, 0.065):
            build.box((x + sx, y + 0.12, z + sz), (0.015, 0.2, 0.015), palette.IRON, material=PLAIN)
    top = (x, y + 0.30, z)
    build.tube((x, y + 0.21, z), top, (0.13, 0.02), palette.IRON, material=PLAIN)
