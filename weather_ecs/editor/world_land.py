"""The land of the world view: a village green among fields, and hills as far as one sees.

It is only something to stand on and to judge sizes by; the game's own land is the game's affair.
"""

from __future__ import annotations

import math
from functools import cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

RINGS, SECTORS = 72, 112
NEAREST, FARTHEST = 2.0, 120_000.0  # m, radii of the first and the last ring
PATCH = 160.0  # m, radius of the ground that rain falls on
GREEN = 350.0  # m, of level ground round the origin
MEADOW = (0.098, 0.133, 0.046)  # linear RGB

VERTEX = np.dtype([("place", "f4", 3), ("normal", "f4", 3), ("color", "f4", 4)])

# Wavelength in m, heading in rad, share: hills as a sum of waves that never come together twice.
_WAVES = (
    (9100.0, 0.3, 1.0), (6700.0, 1.9, 0.8), (4300.0, 2.6, 0.55), (2900.0, 0.9, 0.4),
    (1700.0, 1.5, 0.2), (1130.0, 0.1, 0.12),
)  # fmt: skip


class Mesh(NamedTuple):
    """Triangles."""

    vertices: NDArray  # VERTEX, (n,)
    indices: NDArray[np.uint32]  # (3 t,)


def heights(x: NDArray, z: NDArray) -> NDArray[np.float64]:
    """m of the land; level round the origin, hilly beyond."""
    away = np.hypot(x, z)
    swell = np.zeros(np.broadcast(x, z).shape)
    for length, heading, share in _WAVES:
        along = math.tau / length * (x * math.cos(heading) + z * math.sin(heading))
        swell = swell + share * np.sin(along + 7.0 * share)
    rolling = 14.0 * _ease((away - GREEN) / 2500.0)
    hills = 170.0 * _ease((away - 2500.0) / 20_000.0)
    return (rolling + hills) * (swell + 0.9 * np.clip(away / 30_000.0, 0.0, 1.0))


def height(x: float, z: float) -> float:
    """m of the land at one place."""
    if x * x + z * z <= GREEN * GREEN:
        return 0.0
    return float(heights(np.array(x), np.array(z)))


def ground(x: float, z: float) -> Mesh:
    """Rings round a place, finer the nearer."""
    radii = np.concatenate(([0.0], np.geomspace(NEAREST, FARTHEST, RINGS)))
    angles = np.linspace(0.0, math.tau, SECTORS, endpoint=False)
    px = x + radii[:, None] * np.cos(angles)
    pz = z + radii[:, None] * np.sin(angles)
    py = heights(px, pz)
    # The Earth bends away: a hill 60 km off is 280 m lower.
    py -= radii[:, None] ** 2 / (2.0 * 6.371e6)
    rows = np.zeros(px.size, VERTEX)
    rows["place"] = np.stack((px, py, pz), -1).reshape(-1, 3)
    step = np.maximum(0.02 * radii[:, None], 2.0)
    slope_x = (heights(px + step, pz) - heights(px - step, pz)) / (2.0 * step)
    slope_z = (heights(px, pz + step) - heights(px, pz - step)) / (2.0 * step)
    normal = np.stack((-slope_x, np.ones_like(slope_x), -slope_z), -1)
    normal /= np.linalg.norm(normal, axis=-1, keepdims=True)
    rows["normal"] = normal.reshape(-1, 3)
    rows["color"] = (*MEADOW, 1.0)
    return Mesh(rows, _ring_indices())


def patch_of(mesh: Mesh) -> Mesh:
    """The part of a ground on which rain is seen to fall."""
    rings = int(np.searchsorted(np.geomspace(NEAREST, FARTHEST, RINGS), PATCH)) + 1
    return Mesh(mesh.vertices[: (rings + 1) * SECTORS], mesh.indices[: rings * SECTORS * 6])


@cache
def _ring_indices() -> NDArray[np.uint32]:
    ring, sector = np.meshgrid(np.arange(RINGS), np.arange(SECTORS), indexing="ij")
    here, there = ring * SECTORS, (ring + 1) * SECTORS
    after = (sector + 1) % SECTORS
    corners = (here + sector, there + after, there + sector, here + sector, here + after)
    quads = np.stack((*corners, there + after), -1)
    return quads.reshape(-1).astype(np.uint32)


def things() -> Mesh:
    """Houses of 6 to 8 m, a church tower of 31 m and trees of 5 to 13 m, to judge sizes by."""
    rng = np.random.default_rng(11)
    parts: list[tuple[NDArray, tuple[float, float, float]]] = []
    plaster, roof = (0.55, 0.50, 0.42), (0.24, 0.095, 0.06)
    for x, z, turn, length in (
        (-34.0, -38.0, 0.3, 11.0), (-52.0, -66.0, 1.2, 14.0), (26.0, -74.0, -0.2, 12.0),
        (58.0, -48.0, 0.9, 10.0), (74.0, -96.0, 0.4, 15.0), (-88.0, -24.0, 0.1, 12.0),
    ):  # fmt: skip
        parts += _house(x, z, turn, (length, 7.5, 3.6), 3.4, plaster, roof)
    parts += _house(4.0, -118.0, 0.1, (22.0, 10.0, 7.0), 5.5, plaster, roof)
    parts += _tower(-10.0, -118.0, 0.1, plaster, (0.10, 0.12, 0.115))
    for _ in range(110):
        away, at = 60.0 + 330.0 * math.sqrt(rng.random()), rng.random() * math.tau
        x, z = away * math.sin(at), -away * math.cos(at)
        if abs(x) < 14.0 and z > -60.0:
            continue  # the way ahead stays free
        parts += _tree(x, z, 5.0 + 8.0 * rng.random(), 0.8 + 0.4 * rng.random())
    return _joined(parts)


def _house(
    x: float,
    z: float,
    turn: float,
    size: tuple[float, float, float],
    rise: float,
    wall: tuple[float, float, float],
    roof: tuple[float, float, float],
) -> list[tuple[NDArray, tuple[float, float, float]]]:
    """Triangles of walls and of a gabled roof; size is (length, width, height of the walls)."""
    a, b, h = 0.5 * size[0], 0.5 * size[1], size[2]
    base = [(-a, -b), (a, -b), (a, b), (-a, b)]
    walls = []
    for (x0, z0), (x1, z1) in zip(base, base[1:] + base[:1], strict=True):
        walls += [[(x0, 0, z0), (x1, h, z1), (x1, 0, z1)], [(x0, 0, z0), (x0, h, z0), (x1, h, z1)]]
    top = h + rise
    walls += [[(-a, h, b), (-a, top, 0), (-a, h, -b)], [(a, h, -b), (a, top, 0), (a, h, b)]]
    e, f = a + 0.4, b + 0.5
    low = h - 0.5 * rise / b
    slopes = []
    for side in (1.0, -1.0):
        corners = [(-e, low, side * f), (e, low, side * f), (e, top, 0), (-e, top, 0)]
        if side < 0.0:
            corners.reverse()
        slopes += [[corners[0], corners[1], corners[2]], [corners[0], corners[2], corners[3]]]
    return [(_placed(walls, x, z, turn), wall), (_placed(slopes, x, z, turn), roof)]


def _tower(
    x: float,
    z: float,
    turn: float,
    wall: tuple[float, float, float],
    roof: tuple[float, float, float],
) -> list[tuple[NDArray, tuple[float, float, float]]]:
    """A square tower of 18 m with a spire of 13 m."""
    a, h, top = 3.0, 18.0, 31.0
    base = [(-a, -a), (a, -a), (a, a), (-a, a)]
    walls, spire = [], []
    for (x0, z0), (x1, z1) in zip(base, base[1:] + base[:1], strict=True):
        walls += [[(x0, 0, z0), (x1, h, z1), (x1, 0, z1)], [(x0, 0, z0), (x0, h, z0), (x1, h, z1)]]
        spire.append([(1.1 * x0, h, 1.1 * z0), (0.0, top, 0.0), (1.1 * x1, h, 1.1 * z1)])
    return [(_placed(walls, x, z, turn), wall), (_placed(spire, x, z, turn), roof)]


def _tree(
    x: float, z: float, tall: float, wide: float
) -> list[tuple[NDArray, tuple[float, float, float]]]:
    """A trunk and a crown of two stumps of a cone."""
    crown = []
    r = 0.27 * tall * wide
    sides = 7
    rings = ((0.2, 0.55), (0.42, 1.0), (0.7, 0.78), (1.0, 0.04))
    for (y0, r0), (y1, r1) in zip(rings, rings[1:], strict=False):
        for k in range(sides):
            a0, a1 = math.tau * k / sides, math.tau * (k + 1) / sides
            corners = ((a0, y0, r0), (a1, y0, r0), (a1, y1, r1), (a0, y1, r1))
            p = [(r * q * math.cos(a), y * tall, r * q * math.sin(a)) for a, y, q in corners]
            crown += [[p[0], p[2], p[1]], [p[0], p[3], p[2]]]
    t = 0.02 * tall + 0.1
    feet = [(-t, -t), (t, -t), (t, t), (-t, t)]
    trunk = []
    for (x0, z0), (x1, z1) in zip(feet, feet[1:] + feet[:1], strict=True):
        h = 0.3 * tall
        trunk += [[(x0, 0, z0), (x1, h, z1), (x1, 0, z1)], [(x0, 0, z0), (x0, h, z0), (x1, h, z1)]]
    shade = 0.75 + 0.5 * ((x * 12.9 + z * 78.2) % 1.0)
    return [
        (_placed(crown, x, z, x), (0.055 * shade, 0.095 * shade, 0.022 * shade)),
        (_placed(trunk, x, z, x), (0.07, 0.05, 0.035)),
    ]


def _placed(triangles: list, x: float, z: float, turn: float) -> NDArray[np.float64]:
    """(t, 3, 3) in the world's axes."""
    at = np.array(triangles, np.float64)
    c, s = math.cos(turn), math.sin(turn)
    px, pz = at[..., 0] * c + at[..., 2] * s, at[..., 2] * c - at[..., 0] * s
    return np.stack((px + x, at[..., 1] + height(x, z), pz + z), -1)


def _joined(parts: list[tuple[NDArray, tuple[float, float, float]]]) -> Mesh:
    """One mesh; every triangle has its own normal, turned away from the inside."""
    places = np.concatenate([part for part, _ in parts])
    colors = np.concatenate([np.tile((*color, 0.0), (len(part), 1)) for part, color in parts])
    normal = np.cross(places[:, 1] - places[:, 0], places[:, 2] - places[:, 0])
    length = np.linalg.norm(normal, axis=1)
    good = length > 1e-9
    places, colors = places[good], colors[good]
    normal = normal[good] / length[good, None]
    rows = np.zeros(3 * len(places), VERTEX)
    rows["place"] = places.reshape(-1, 3)
    rows["normal"] = np.repeat(normal, 3, 0)
    rows["color"] = np.repeat(colors, 3, 0)
    return Mesh(rows, np.arange(len(rows), dtype=np.uint32))


def _ease(x: NDArray) -> NDArray:
    share = np.clip(x, 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)
