"""Tufts of grass beside the path, reeds at the pond: three blades each, in patches."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import layout, palette
from .noise import smoothstep
from .terrain import Terrain

CANDIDATES = 125000
PATCH = 10.0  # m, side of a patch


@dataclass(frozen=True)
class Grass:
    """Blades as triangles of three vertices each, sorted by patch, thinned from a patch's end."""

    vertices: NDArray  # (n, 3) f4, m
    colors: NDArray  # (n, 3) f4, linear albedo
    sway: NDArray  # (n,) f4, 0 at the root, 1 at the tip
    roots: NDArray  # (n, 3) f4, m, foot of the tuft
    patches: NDArray  # (p, 2) first vertex, vertices
    centers: NDArray  # (p, 3) m


def _stands(terrain: Terrain, rng: np.random.Generator) -> NDArray:
    """(n, 4) x, z, height m, kind: 0 grass, 1 reed, 2 flower."""
    x, z = rng.uniform(-24, 24, CANDIDATES), rng.uniform(-170, 92, CANDIDATES)
    middle = np.interp(z, terrain.path[::-1, 1], terrain.path[::-1, 0])
    near = (np.abs(x - middle) < 11.5) | ((z > -90.0) & (z < -42.0) & (x > -4.0))
    x, z = x[near], z[near]
    count = len(x)
    points = np.stack([x, z], 1)
    trail = terrain.trail_distance(points)
    clump = terrain.noise.fbm(x / 3.1, z / 3.1 + 50, 3)
    chance = smoothstep(1.0, 1.6, trail) * smoothstep(11.0, 1.6, trail) ** 1.3
    chance *= 0.28 + 0.72 * smoothstep(-0.05, 0.40, clump)
    dx, dz = np.abs(x - layout.CABIN[0]), np.abs(z - layout.CABIN[1] - 1.4)
    chance *= (dx > 3.4) | (dz > 4.6)
    loop = layout.smooth_line(layout.FIGURE_LOOP, closed=True, step=3)
    chance *= layout.distance_to_line(points, loop) > 0.7
    chance *= terrain.pond_radius(x, z) > 1.12
    keep = rng.random(count) < chance
    tall = rng.uniform(0.11, 0.27, count) * (1.0 + 0.8 * np.clip(clump, 0, 1))
    drift = smoothstep(0.10, 0.45, terrain.noise.fbm(x / 19.0 + 40, z / 19.0, 3))
    kind = np.where(rng.random(count) < 0.22 * drift, 2.0, 0.0)
    meadow = np.stack([x, z, tall, kind], 1)[keep]
    ring = rng.uniform(0, 2 * np.pi, 1500)
    reach = rng.uniform(0.90, 1.22, 1500)
    x = layout.POND[0] + layout.POND_RADII[0] * reach * np.cos(ring)
    z = layout.POND[1] + layout.POND_RADII[1] * reach * np.sin(ring)
    stand = terrain.noise.fbm(ring * 2.2, 0 * ring + 3.3, 2)
    keep = (stand > 0.05) & (np.abs(terrain.pond_radius(x, z) - 1.04) < 0.10)
    tall = rng.uniform(0.7, 1.35, 1500)
    reeds = np.stack([x, z, tall, np.ones(1500)], 1)[keep]
    return np.concatenate([meadow, reeds])


def grass(terrain: Terrain, seed: int = 0, blades: int = 3) -> Grass:
    """All tufts of the place."""
    rng = np.random.default_rng(seed + 11)
    stands = _stands(terrain, rng)
    cell = np.floor(stands[:, :2] / PATCH).astype("i8")
    order = np.lexsort((rng.random(len(stands)), cell[:, 0], cell[:, 1]))
    stands, cell = stands[order], cell[order]
    n = len(stands)
    x, z, tall, kind = stands.T
    reed = (kind == 1.0).astype("f8")
    y = np.asarray(terrain.height(x, z))
    root = np.stack([x, y - 0.03, z], 1)[:, None]  # (n, 1, 3)
    turn = rng.uniform(0, 2 * np.pi, (n, blades))
    away = rng.uniform(0.0, 0.10, (n, blades, 1))
    out = np.stack([np.cos(turn), 0 * turn, np.sin(turn)], -1)
    side = np.stack([-np.sin(turn), 0 * turn, np.cos(turn)], -1)
    high = tall[:, None, None] * rng.uniform(0.7, 1.15, (n, blades, 1))
    wide = np.where(reed > 0, 0.022, 0.019)[:, None, None] * rng.uniform(0.8, 1.3, (n, blades, 1))
    foot = root + out * away
    lean = np.where(reed > 0, 0.18, 0.55)[:, None, None] * rng.uniform(0.2, 1.0, (n, blades, 1))
    tip = foot + out * high * lean + np.array([0.0, 1.0, 0.0]) * high
    vertices = np.stack([foot - side * wide, foot + side * wide, tip], 2)
    dry = np.clip(terrain.noise.fbm(x / 34.0, z / 34.0, 3) + 0.3, 0, 1)[:, None]
    color = palette.GRASS + (palette.GRASS_DRY - palette.GRASS) * dry
    color = np.where(reed[:, None] > 0, palette.GRASS_LUSH * 1.05, color)
    tint = color[:, None] * (1.0 + 0.22 * rng.uniform(-1, 1, (n, blades, 1)))
    shades = np.stack([tint * 0.62, tint * 0.62, tint * 1.25], 2)
    _flower_heads(vertices, shades, kind, tip, side, rng)
    starts = np.flatnonzero(np.any(np.diff(cell, axis=0, prepend=cell[:1] - 1) != 0, axis=1))
    counts = np.diff(np.append(starts, n))
    centers = np.array([root[s : s + c, 0].mean(0) for s, c in zip(starts, counts, strict=True)])
    each = blades * 3
    return Grass(
        vertices.reshape(-1, 3).astype("f4"),
        shades.reshape(-1, 3).astype("f4"),
        np.tile(np.array([0, 0, 1], "f4"), n * blades),
        np.repeat(root[:, 0], each, axis=0).astype("f4"),
        np.stack([starts * each, counts * each], 1),
        centers,
    )


def _flower_heads(
    vertices: NDArray, shades: NDArray, kind: NDArray, tip: NDArray, side: NDArray,
    rng: np.random.Generator,
) -> None:  # fmt: skip
    """Turn the first blade of each flowering tuft into a small head above the others."""
    heads = np.flatnonzero(kind == 2.0)
    size = rng.uniform(0.016, 0.030, (len(heads), 1))
    top = tip[heads, 0] + np.array([0.0, 0.06, 0.0])
    vertices[heads, 0, 0] = top - side[heads, 0] * size
    vertices[heads, 0, 1] = top + side[heads, 0] * size
    vertices[heads, 0, 2] = top + np.array([0.0, 1.0, 0.0]) * size * 1.4
    tones = np.array([palette.LINEN, palette.LINEN * (1.0, 0.82, 0.42), palette.HEATHER])
    shades[heads, 0] = (tones[rng.integers(0, 3, len(heads))] * 1.1)[:, None]
