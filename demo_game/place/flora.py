"""Trees in four levels of detail, made of small faces; a metre tall per unit of height."""

from __future__ import annotations

from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from . import palette
from .foliage import SOLID
from .mesh import LEAF, WOOD, Builder, Mesh
from .rocks import sphere

LEVELS = 4  # of detail: near, middle, far, a silhouette
UP = np.array([0.0, 1.0, 0.0])
SPRUCE_PROFILE = [(0.10, 0.22), (0.46, 0.11), (0.47, 0.16), (1.02, 0.0)]


def conifer(seed: int, level: int) -> Mesh:
    """A spruce: drooping sprays wound up a dark core."""
    rng = np.random.default_rng(seed)
    build = Builder(seed)
    color = palette.CONIFER[seed % 3]
    if level == 3:
        return _silhouette(build, color, SPRUCE_PROFILE)
    build.tube((0, -0.05, 0), (0, 0.4, 0), (0.020, 0.012), palette.BARK, sides=(6, 4, 3)[level])
    _core(build, color, 6 if level == 0 else 4)
    count = (150, 64, 20)[level]
    share = ((np.arange(count) + rng.uniform(-0.4, 0.4, count)) / count).clip(0, 1)
    share = share**1.12  # denser below
    foot = 0.09 + 0.89 * share
    taper = 0.250 * (1.0 - share) ** 0.82 + 0.020
    ragged = rng.uniform(0.74, 1.12, count) * (1.0 + 0.08 * np.sin(share * 46.0 + seed))
    length = taper * ragged * (1.0, 1.06, 1.06)[level]
    turn = np.arange(count) * 2.399963 + rng.uniform(-0.5, 0.5, count)
    wide = length * (0.44, 0.62, 0.80)[level] + (0.012, 0.016, 0.022)[level]
    droop = length * rng.uniform(0.25, 0.52, count) * (1.0 - 0.75 * share)
    lift = (0.035, 0.05, 0.075)[level] * (1.0 - 0.5 * share)
    tint = color * (1.0 + 0.24 * rng.uniform(-1, 1, (count, 1)))
    out = np.stack([np.cos(turn), 0 * turn, np.sin(turn)], 1)
    side = np.stack([-np.sin(turn), 0 * turn, np.cos(turn)], 1)
    root = UP * (foot + lift)[:, None]
    tip = out * length[:, None] + UP * (foot - droop)[:, None]
    elbow = out * (length * 0.55)[:, None] + UP * (foot - droop * 0.62 - 0.010)[:, None]
    left, right = elbow + side * wide[:, None], elbow - side * wide[:, None]
    points = np.stack([root, left, tip, right], 1).reshape(-1, 3)
    soft = out * 0.8 + UP * 0.6
    normals = np.stack([UP + 0.3 * out, soft + side * 0.6, soft, soft - side * 0.6], 1)
    index = np.arange(count)[:, None] * 4
    bend = 0.12 + 0.88 * foot
    spray = np.array([(0.75, 0.0), (0.985, 0.5), (0.75, 1.0), (0.515, 0.5)])
    build.faces(
        points,
        np.concatenate([index + (0, 2, 1), index + (0, 3, 2)]),
        (tint[:, None] * np.array([0.5, 1.0, 1.25, 1.0])[:, None]).reshape(-1, 3),
        normals=normals.reshape(-1, 3),
        uvs=np.tile(spray if level < 2 else np.array([SOLID] * 4), (count, 1)),
        material=LEAF,
        ambient=np.tile([0.30, 0.86, 1.0, 0.86], count),
        sway=np.stack([0.3 * bend, bend, bend, bend], 1).ravel(),
    )
    return _closed_bark(build.build())


def _closed_bark(mesh: Mesh) -> Mesh:
    """Bark has no holes."""
    return replace(mesh, uvs=np.where((mesh.material == WOOD)[:, None], SOLID, mesh.uvs))


def holed(mesh: Mesh) -> NDArray:
    """(m,) which triangles have holes painted into them."""
    u, v = mesh.uvs[mesh.indices].transpose(2, 0, 1)
    return (np.ptp(u, axis=1) > 0.1) & (np.ptp(v, axis=1) > 0.3) & (v.max(axis=1) < 1.01)


def _core(build: Builder, color: NDArray, sides: int) -> None:
    angle = np.linspace(0, 2 * np.pi, sides, endpoint=False)
    ring = np.stack([0.135 * np.cos(angle), np.full(sides, 0.12), 0.135 * np.sin(angle)], 1)
    points = np.concatenate([ring, [[0.0, 1.01, 0.0]]])
    fan = [[(i + 1) % sides, i, sides] for i in range(sides)]
    sway = np.append(np.full(sides, 0.1), 1.0)
    uvs = np.tile(SOLID, (len(points), 1))
    build.faces(points, fan, color * 0.5, uvs=uvs, material=LEAF, ambient=0.5, sway=sway)


def _silhouette(
    build: Builder, color: NDArray, profile: list[tuple[float, float]], sides: int = 5
) -> Mesh:
    """A turned shape on a trunk; its profile is (height, radius) from below up."""
    build.tube((0, -0.05, 0), (0, 0.4, 0), (0.02, 0.02), palette.BARK, sides=3)
    angle = np.linspace(0, 2 * np.pi, sides + 1)
    way = np.stack([np.cos(angle), 0 * angle, np.sin(angle)], 1)
    n = sides + 1
    k = np.arange(sides)[:, None]
    for (y0, r0), (y1, r1) in zip(profile[:-1], profile[1:], strict=True):
        points = np.concatenate([way * r0 + UP * y0, way * r1 + UP * y1])
        faces = np.concatenate([k + (0, n, 1), k + (1, n, n + 1)])
        slope = (r0 - r1) / max(y1 - y0, 0.01)
        build.faces(
            points, faces, color * (0.8 + 0.25 * y1), normals=np.tile(way + slope * UP, (2, 1)),
            uvs=np.tile(SOLID, (2 * n, 1)), material=LEAF, ambient=0.62 + 0.38 * y1,
        )  # fmt: skip
    return build.build()


def broadleaf(seed: int, level: int, birch: bool = False) -> Mesh:
    """A crown of leaf clumps on lobes; a birch is narrower."""
    rng = np.random.default_rng(seed)
    build = Builder(seed)
    color = (palette.BIRCH if birch else palette.BROADLEAF)[seed % 3]
    bark = palette.BIRCH_BARK if birch else palette.BARK
    spread, base = (0.17, 0.34) if birch else (0.28, 0.36)
    thick = 0.014 if birch else 0.028
    if level == 3:
        crown = [(-0.08, 0.3), (0.06, 1.0), (0.30, 1.1), (0.50, 0.75), (0.62, 0.1)]
        return _silhouette(build, color, [(base + y, spread * r) for y, r in crown])
    lean = rng.uniform(-0.03, 0.03, 2)
    fork = np.array([lean[0], 0.42, lean[1]])
    build.tube((0, -0.05, 0), fork, (thick * 1.25, thick * 0.7), bark, sides=(7, 5, 3)[level])
    for at, radius in _lobes(rng, 9, spread, base, 0.86):
        if level == 0:
            build.tube(fork, at, (thick * 0.45, thick * 0.15), bark, sides=3)
        _lobe(build, rng, at, radius, color, level)
    return _closed_bark(build.build())


def bush(seed: int, level: int) -> Mesh:
    """Leaf clumps on the ground, wider than high."""
    rng = np.random.default_rng(seed)
    build = Builder(seed)
    color = palette.BUSH[seed % 3]
    level = min(level, 2)
    for at, radius in _lobes(rng, 5, 0.62, 0.16, 0.62):
        _lobe(build, rng, at, radius * (1.0, 0.85, 1.0), color, level)
    return build.build()


def _lobes(
    rng: np.random.Generator, count: int, spread: float, base: float, top: float
) -> list[tuple[NDArray, NDArray]]:
    """(centre, radii) of a crown's parts, from below up."""
    found = []
    for k in range(count):
        share = k / (count - 1)
        a = k * 2.399963 + rng.uniform(-0.4, 0.4)
        swell = np.sin(np.pi * (0.18 + 0.74 * share)) ** 0.7
        off = spread * swell * rng.uniform(0.45, 0.8) * (0.15 + (share < 0.95))
        at = np.array([np.cos(a) * off, base + (top - base) * share + 0.02, np.sin(a) * off])
        radius = spread * swell * rng.uniform(0.48, 0.64) + 0.02
        found.append((at, np.array([radius, radius * rng.uniform(0.75, 0.95), radius])))
    return found


def _lobe(
    build: Builder, rng: np.random.Generator, at: NDArray, radii: NDArray, color: NDArray,
    level: int,
) -> None:  # fmt: skip
    """A dark ball with leaf clumps on it: bent squares that face outwards, roughly."""
    points, faces = sphere((1, 0, 0)[level])
    bumps = 1.0 + 0.16 * rng.uniform(-1, 1, (len(points), 1))
    low = 0.55 + 0.45 * (points[:, 1] * 0.5 + 0.5)
    build.faces(
        at + points * radii * (0.82, 0.86, 0.92)[level] * bumps,
        faces,
        color * (0.66, 0.70, 0.74)[level],
        normals=points,
        uvs=points[:, :2] * 0.13 + (0.25, 0.5),
        material=LEAF,
        ambient=low * (0.72, 0.74, 0.78)[level],
        sway=0.3 + 0.4 * at[1],
    )
    clumps = (26, 11, 5)[level]
    k = np.arange(clumps) + 0.5
    up = 1.0 - 1.7 * k / clumps
    turn = k * 2.399963 + rng.uniform(0, 6)
    flat = np.sqrt(np.maximum(1 - up * up, 0))
    way = np.stack([flat * np.cos(turn), up, flat * np.sin(turn)], 1)
    way += rng.normal(0, 0.18, way.shape)
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    center = at + way * radii * rng.uniform(0.78, 1.02, (clumps, 1))
    facing = way + rng.normal(0, (0.45, 0.35, 0.25)[level], way.shape)
    facing /= np.linalg.norm(facing, axis=1, keepdims=True)
    one = np.cross(facing, rng.normal(0, 1, way.shape))
    one /= np.linalg.norm(one, axis=1, keepdims=True)
    two = np.cross(facing, one)
    size = radii.mean() * (0.62, 0.92, 0.80)[level] * rng.uniform(0.75, 1.25, (clumps, 1))
    bulge = facing * size * 0.22
    corner = np.stack(
        [center - one * size, center - two * size + bulge, center + one * size,
         center + two * size + bulge], 1
    )  # fmt: skip
    tint = 1.0 + 0.26 * rng.uniform(-1, 1, (clumps, 1))
    normal = way * 0.8 + (at - (0.0, 0.55, 0.0)) * 1.2 + facing * 0.25
    index = np.arange(clumps)[:, None] * 4
    clump = np.array([(0.04, 0.08), (0.46, 0.08), (0.46, 0.92), (0.04, 0.92)])
    build.faces(
        corner.reshape(-1, 3),
        np.concatenate([index + (0, 1, 2), index + (0, 2, 3)]),
        np.repeat(color * tint * 1.12, 4, axis=0),
        normals=np.repeat(normal, 4, axis=0),
        uvs=np.tile(clump if level < 2 else np.array([SOLID] * 4), (clumps, 1)),
        material=LEAF,
        ambient=np.repeat(0.62 + 0.38 * (way[:, 1] * 0.5 + 0.5), 4),
        sway=0.35 + 0.5 * np.repeat(center[:, 1], 4),
    )
