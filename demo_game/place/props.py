"""Lamp posts, fences and the mailbox, in world coordinates."""

from __future__ import annotations

from collections.abc import Callable

import numpy as np
from numpy.typing import NDArray

from . import layout, palette
from .mesh import GLOW, PLAIN, WOOD, Builder, yaw_matrix

Height = Callable[[float, float], float]
LAMP_HEIGHT = 3.15  # m, of the light
FENCE_STEP = 2.4  # m, between posts


def lamp_head(x: float, ground: float, z: float, lean_to: float) -> list[float]:
    """Where a lamp post's light is, m."""
    out = yaw_matrix(lean_to) @ np.array([0.0, 0.0, 0.62])
    return [x + float(out[0]), ground + LAMP_HEIGHT, z + float(out[2])]


def lamp_post(build: Builder, x: float, ground: float, z: float, lean_to: float) -> None:
    """An iron post with a lantern on an arm towards `lean_to` (rad)."""
    out = yaw_matrix(lean_to) @ np.array([0.0, 0.0, 1.0])
    foot, iron = np.array([x, ground, z]), palette.IRON
    up = np.array([0.0, 1.0, 0.0])
    build.tube(foot - up * 0.3, foot + up * 0.45, (0.12, 0.085), iron, sides=8, material=PLAIN)
    build.tube(foot + up * 0.45, foot + up * 3.55, (0.05, 0.04), iron, material=PLAIN)
    ring = foot + up * 0.47
    build.tube(ring - up * 0.04, ring + up * 0.03, (0.10, 0.07), iron, sides=8, material=PLAIN)
    points = [(0.0, 3.50), (0.16, 3.66), (0.38, 3.72), (0.56, 3.64), (0.62, 3.52)]
    for (a, b), (c, d) in zip(points[:-1], points[1:], strict=True):
        start, end = foot + out * a + up * b, foot + out * c + up * d
        build.tube(start, end, (0.024, 0.024), iron, sides=4, material=PLAIN)
    start, end = foot + up * 3.15, foot + out * 0.40 + up * 3.70
    build.tube(start, end, (0.015, 0.015), iron, sides=4, material=PLAIN)
    head = np.array(lamp_head(x, ground, z, lean_to))
    turn = yaw_matrix(lean_to)
    build.tube(head + up * 0.20, head + up * 0.38, (0.20, 0.03), iron, sides=8, material=PLAIN)
    build.box(head, (0.19, 0.34, 0.19), palette.GLOW_WARM, rotation=turn, material=GLOW, vary=0.0)
    for sx in (-0.11, 0.11):
        for sz in (-0.11, 0.11):
            at = head + turn @ np.array([sx, 0.0, sz])
            build.box(at, (0.022, 0.40, 0.022), iron, rotation=turn, material=PLAIN)
    build.box(head - up * 0.20, (0.26, 0.04, 0.26), iron, rotation=turn, material=PLAIN)


def fence_posts(line: list[tuple[float, float]]) -> NDArray:
    """(n, 2) even posts along a line."""
    curve = layout.smooth_line(line, step=24)
    along = np.concatenate([[0.0], np.cumsum(np.linalg.norm(np.diff(curve, axis=0), axis=1))])
    count = max(2, round(along[-1] / FENCE_STEP) + 1)
    at = np.linspace(0.0, along[-1], count)
    return np.stack([np.interp(at, along, curve[:, 0]), np.interp(at, along, curve[:, 1])], 1)


def fence(build: Builder, posts: NDArray, height: Height) -> None:
    """Split rails between leaning posts; here and there one has slipped."""
    rng = build.random
    feet = np.array([(x, height(float(x), float(z)), z) for x, z in posts])
    for foot in feet:
        lean = rng.normal(0.0, 0.035, 2)
        top = foot + (lean[0], rng.uniform(1.1, 1.25), lean[1])
        build.tube(
            foot - (0, 0.3, 0), top, (0.075, 0.065), palette.FENCE * rng.uniform(0.8, 1.1),
            sides=5, caps=True,
        )  # fmt: skip
    for start, end in zip(feet[:-1], feet[1:], strict=True):
        for level in (0.45, 0.92):
            a = start + (0.0, level + rng.normal(0, 0.03), 0.0)
            b = end + (0.0, level + rng.normal(0, 0.03), 0.0)
            if rng.random() < 0.06:
                b = end + (0.1, 0.06, 0.15)
            over = (b - a) * 0.05
            tint = palette.FENCE * rng.uniform(0.85, 1.15)
            build.tube(a - over, b + over, (0.05, 0.042), tint, sides=4, caps=True)


def mailbox(build: Builder, x: float, ground: float, z: float, facing: float) -> None:
    """A round-topped box on a post with its flag up, facing `facing` (rad)."""
    turn = yaw_matrix(facing)
    foot = np.array([x, ground, z])
    build.box(foot + (0, 0.4, 0), (0.11, 1.3, 0.11), palette.FENCE, rotation=turn, cuts=2)
    build.box(foot + (0, 1.06, 0), (0.2, 0.05, 0.5), palette.BEAM, rotation=turn)
    arc = np.linspace(0.0, np.pi, 9)
    profile = [(-0.12, 0.0)] + [(-0.12 * np.cos(a), 0.16 + 0.12 * np.sin(a)) for a in arc]
    outline = np.array([*profile, (0.12, 0.0)])
    front = np.column_stack([outline, np.full(len(outline), 0.27)])
    back = front * (1, 1, -1)
    base = foot + (0, 1.09, 0)
    n = len(outline)
    shell = np.concatenate([front, back]) @ turn.T + base
    k = np.arange(n - 1)[:, None]
    sides = np.concatenate([k + (0, n, 1), k + (1, n, n + 1)])
    build.faces(shell, sides, palette.MAILBOX_RED, material=PLAIN)
    fan = np.array([[0, i, i + 1] for i in range(1, n - 1)])
    for points, order in ((shell[:n], fan[:, ::-1]), (shell[n:], fan)):
        build.faces(points, order, palette.MAILBOX_RED * 0.85, material=PLAIN)
    flag = base + turn @ np.array([0.135, 0.24, 0.05])
    build.box(flag, (0.015, 0.3, 0.03), palette.TRIM, rotation=turn, material=PLAIN)
    flag = base + turn @ np.array([0.135, 0.36, 0.10])
    build.box(flag, (0.02, 0.09, 0.14), palette.PAPER, rotation=turn, material=PLAIN)
    slot = base + turn @ np.array([0.0, 0.14, 0.275])
    build.box(slot, (0.13, 0.02, 0.012), palette.IRON, rotation=turn, material=PLAIN)


def bench(build: Builder, x: float, ground: float, z: float, facing: float) -> None:
    """A plain plank bench."""
    turn = yaw_matrix(facing)
    foot = np.array([x, ground, z])
    for dz in (-0.13, 0.13):
        at = foot + turn @ np.array([0.0, 0.45, dz])
        build.box(at, (1.7, 0.06, 0.22), palette.FENCE, rotation=turn, cuts=2, vary=0.1)
    for dx in (-0.6, 0.6):
        at = foot + turn @ np.array([dx, 0.15, 0.0])
        build.box(at, (0.12, 0.6, 0.42), palette.FENCE * 0.7, rotation=turn)


def woodpile(build: Builder, x: float, ground: float, z: float, length: float) -> None:
    """Split logs stacked along z."""
    rng = build.random
    for row in range(6):
        for k in range(int(length / 0.2) - row % 2):
            at = np.array([x, ground + 0.09 + row * 0.165, z - length / 2 + 0.1 + k * 0.2])
            at[2] += 0.1 * (row % 2)
            reach = np.array([0.24 + rng.uniform(-0.02, 0.03), 0.0, 0.0])
            radius = rng.uniform(0.078, 0.098)
            color = palette.BEAM * rng.uniform(0.8, 1.3)
            build.tube(
                at - reach, at + reach, (radius, radius), color, sides=5, caps=True, material=WOOD
            )
