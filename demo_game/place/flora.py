"""Trees in three levels of detail, made of small faces."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from . import palette
from .mesh import LEAF, Builder, Mesh
from .rocks import sphere

LEVELS = 3  # of detail: near, middle, far


def conifer(seed: int, level: int) -> Mesh:
    """A spruce one metre tall per unit: whorls of drooping branches on a dark core."""
    rng = np.random.default_rng(seed)
    build = Builder(seed)
    color = palette.CONIFER[seed % 3]
    tiers, branches, fingers = ((14, 10, 3), (9, 7, 1), (5, 5, 1))[level]
    build.tube((0, -0.05, 0), (0, 0.5, 0), (0.022, 0.012), palette.BARK, sides=(6, 5, 4)[level])
    height = 0.11 + 0.89 * (np.arange(tiers) / tiers) ** 0.92
    core = 7 if level == 0 else 5
    build.sway = 0.0
    angle = np.linspace(0, 2 * np.pi, core, endpoint=False)
    ring = np.stack([0.115 * np.cos(angle), np.full(core, 0.13), 0.115 * np.sin(angle)], 1)
    points = np.concatenate([ring, [[0.0, 0.97, 0.0]]])
    fan = [[(i + 1) % core, i, core] for i in range(core)]
    build.faces(points, fan, color * 0.45, material=LEAF, ambient=0.5)
    for tier, y in enumerate(height):
        share = tier / (tiers - 1)
        reach = 0.235 * (1.0 - share) ** 0.80 + 0.018
        turn = rng.uniform(0, 2 * np.pi)
        for b in range(branches):
            a = turn + (b + rng.uniform(-0.3, 0.3)) * 2 * np.pi / branches
            length = reach * rng.uniform(0.78, 1.14)
            droop = length * rng.uniform(0.28, 0.5) * (1.0 - 0.5 * share)
            tint = color * (1.0 + 0.22 * rng.uniform(-1, 1))
            _branch(build, a, y + rng.uniform(-0.012, 0.012), length, droop, tint, fingers, tiers)
    build.faces(
        [(0.012, 0.93, 0.0), (-0.006, 0.93, 0.01), (-0.006, 0.93, -0.01), (0.0, 1.02, 0.0)],
        [(1, 0, 3), (2, 1, 3), (0, 2, 3)],
        color,
        material=LEAF,
        sway=(0.7, 0.7, 0.7, 1.0),
    )
    return build.build()


def _branch(
    build: Builder, angle: float, y: float, length: float, droop: float, color: NDArray,
    fingers: int, tiers: int,
) -> None:  # fmt: skip
    """A drooping spray: ridge in the middle, sides hanging, tip split into fingers."""
    out = np.array([np.cos(angle), 0.0, np.sin(angle)])
    side = np.array([-np.sin(angle), 0.0, np.cos(angle)])
    up = np.array([0.0, 1.0, 0.0])
    wide = length * (0.46 if tiers > 8 else 0.70) + 0.008
    root = up * (y + 0.05)
    tip = out * length + up * (y - droop)
    middle = out * length * 0.55 + up * (y + 0.012 - droop * 0.25)
    left = out * length * 0.62 + side * wide - up * (droop * 0.75 - y)
    right = out * length * 0.62 - side * wide - up * (droop * 0.75 - y)
    soft = out * 0.75 + up * 0.65
    normals = [up, soft + side * 0.5, soft, soft - side * 0.5, soft + up * 0.4]
    bend = 0.25 + 0.75 * y
    sway = np.array([0.2, 1.0, 1.0, 1.0, 0.6]) * bend
    points = [root, left, tip, right, middle]
    ambient = np.array([0.28, 0.9, 1.0, 0.9, 0.75])
    shade = np.array([0.55, 1.0, 1.18, 1.0, 0.9])
    if fingers == 1:
        faces = [(0, 2, 1), (0, 3, 2)]
        keep = [0, 1, 2, 3]
    else:
        notch_l = out * length * 0.66 + side * wide * 0.35 - up * (droop * 0.6 - y)
        notch_r = out * length * 0.66 - side * wide * 0.35 - up * (droop * 0.6 - y)
        points += [notch_l, notch_r]
        normals += [soft, soft]
        sway = np.append(sway, [bend, bend])
        ambient = np.append(ambient, [0.7, 0.7])
        shade = np.append(shade, [0.92, 0.92])
        faces = [(0, 5, 1), (0, 4, 5), (4, 2, 5), (4, 6, 2), (0, 6, 4), (0, 3, 6)]
        keep = list(range(7))
    build.faces(
        np.array(points)[keep],
        faces,
        color * shade[keep, None],
        normals=np.array(normals)[keep],
        material=LEAF,
        ambient=ambient[keep],
        sway=sway[keep],
    )


def broadleaf(seed: int, level: int, birch: bool = False) -> Mesh:
    """A crown of leaf clumps on lobes, one metre tall per unit; a birch is narrower."""
    rng = np.random.default_rng(seed)
    build = Builder(seed)
    color = (palette.BIRCH if birch else palette.BROADLEAF)[seed % 3]
    bark = palette.BIRCH_BARK if birch else palette.BARK
    spread, base = (0.17, 0.34) if birch else (0.27, 0.36)
    sides = (7, 5, 4)[level]
    thick = 0.014 if birch else 0.030
    lean = rng.uniform(-0.03, 0.03, 2)
    fork = np.array([lean[0], 0.42, lean[1]])
    build.tube((0, -0.05, 0), fork, (thick * 1.25, thick * 0.7), bark, sides=sides)
    count = 9 if birch else 10
    lobes = []
    for k in range(count):
        share = k / (count - 1)
        a = k * 2.399963 + rng.uniform(-0.4, 0.4)
        swell = np.sin(np.pi * (0.18 + 0.74 * share)) ** 0.7
        off = spread * swell * rng.uniform(0.45, 0.8) * (0.15 + (share < 0.95))
        at = np.array([np.cos(a) * off, base + (0.84 - base) * share + 0.02, np.sin(a) * off])
        radius = spread * swell * rng.uniform(0.46, 0.62) + 0.02
        lobes.append((at, np.array([radius, radius * rng.uniform(0.75, 0.95), radius])))
        if level == 0 and share < 0.7:
            build.tube(fork, at, (thick * 0.45, thick * 0.15), bark, sides=4)
        elif level == 1 and k == count // 2:
            build.tube(fork, (0, 0.75, 0), (thick * 0.5, thick * 0.2), bark, sides=4)
    for at, radii in lobes:
        _lobe(build, rng, at, radii, color, level)
    return build.build()


def _lobe(
    build: Builder, rng: np.random.Generator, at: NDArray, radii: NDArray, color: NDArray,
    level: int,
) -> None:  # fmt: skip
    points, faces = sphere((1, 0, 0)[level])
    inner = (0.80, 0.95, 1.15)[level]
    bumps = 1.0 + 0.16 * rng.uniform(-1, 1, (len(points), 1))
    low = 0.55 + 0.45 * (points[:, 1] * 0.5 + 0.5)
    build.faces(
        at + points * radii * inner * bumps,
        faces,
        color * (0.62 if level < 2 else 0.95),
        normals=points,
        material=LEAF,
        ambient=low * (0.6 if level < 2 else 0.9),
        sway=0.3 + 0.4 * at[1],
    )
    clumps = (52, 11, 0)[level]
    if clumps == 0:
        return
    k = np.arange(clumps) + 0.5
    up = 1.0 - 1.75 * k / clumps
    turn = k * 2.399963 + rng.uniform(0, 6)
    flat = np.sqrt(np.maximum(1 - up * up, 0))
    way = np.stack([flat * np.cos(turn), up, flat * np.sin(turn)], 1)
    way += rng.normal(0, 0.18, way.shape)
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    center = at + way * radii * rng.uniform(0.82, 1.12, (clumps, 1))
    facing = way + rng.normal(0, 0.55, way.shape)
    facing /= np.linalg.norm(facing, axis=1, keepdims=True)
    one = np.cross(facing, rng.normal(0, 1, way.shape))
    one /= np.linalg.norm(one, axis=1, keepdims=True)
    two = np.cross(facing, one)
    size = radii.mean() * (0.30, 0.58)[level] * rng.uniform(0.7, 1.35, (clumps, 1))
    bulge = facing * size * 0.25
    corner = np.stack(
        [center - one * size, center - two * size * 0.6 + bulge, center + one * size,
         center + two * size * 0.6 + bulge], 1
    )  # fmt: skip
    tint = 1.0 + 0.30 * rng.uniform(-1, 1, (clumps, 1))
    normal = way * 0.8 + (at - (0.0, 0.55, 0.0)) * 1.2 + facing * 0.25
    index = np.arange(clumps)[:, None] * 4
    build.faces(
        corner.reshape(-1, 3),
        np.concatenate([index + (0, 1, 2), index + (0, 2, 3)]),
        np.repeat(color * tint, 4, axis=0),
        normals=np.repeat(normal, 4, axis=0),
        material=LEAF,
        ambient=np.repeat(0.62 + 0.38 * (way[:, 1] * 0.5 + 0.5), 4),
        sway=0.35 + 0.5 * np.repeat(center[:, 1], 4),
    )
