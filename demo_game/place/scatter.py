"""Trees and rocks of the place: the composed ones, and others scattered around them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from . import layout
from .layout import BIRCH, BROADLEAF, BUSH, CONIFER
from .noise import smoothstep
from .terrain import Terrain

VARIANTS = 3  # shapes of each kind
FAR_TREES = 250


@dataclass(frozen=True)
class Trees:
    """Every tree: kind * VARIANTS + variant, foot, height and turn."""

    shape: NDArray  # (n,) i8
    foot: NDArray  # (n, 3) m
    height: NDArray  # (n,) m
    turn: NDArray  # (n,) rad
    far: NDArray  # (n,) bool: woods on the slopes, never near


def _clear_of_everything(terrain: Terrain, points: NDArray) -> NDArray:
    x, z = points.T
    free = terrain.trail_distance(points) > 9.0
    free &= terrain.pond_radius(x, z) > 1.7
    free &= np.hypot(x - layout.CABIN[0], z - layout.CABIN[1]) > 16.0
    free &= np.hypot(x - layout.WINDMILL[0], z - layout.WINDMILL[1]) > 22.0
    free &= np.abs(x) > 24.0 - 0.10 * (z + 100.0) * (z < 0)  # the view along the path
    free &= np.abs(x) > 14.0 + 14.0 * smoothstep(-20.0, 30.0, z)
    return free


def trees(terrain: Terrain, seed: int) -> Trees:
    """Composed trees first, then the scattered ones, then the woods on the slopes."""
    rng = np.random.default_rng(seed + 3)
    rows = [(x, z, kind, tall) for x, z, kind, tall in layout.TREES]
    placed = [np.array(t[:2]) for t in layout.TREES]
    noise = terrain.noise
    while len(rows) < 64:
        at = rng.uniform((-120.0, -190.0), (120.0, 90.0))
        grove = noise.fbm(at[0] / 55.0 + 20, at[1] / 55.0, 2)
        if rng.random() > smoothstep(-0.1, 0.4, grove):
            continue
        if min(np.linalg.norm(at - other) for other in placed) < 5.0:
            continue
        if not _clear_of_everything(terrain, at[None])[0]:
            continue
        kind = int(rng.choice([CONIFER, CONIFER, CONIFER, BROADLEAF, BIRCH]))
        tall = {CONIFER: (9.0, 17.0), BROADLEAF: (8.0, 12.0), BIRCH: (7.0, 10.0)}[kind]
        rows.append((at[0], at[1], kind, rng.uniform(*tall)))
        placed.append(at)
    rows += [(x, z, BUSH, tall) for x, z, tall in layout.BUSHES]
    near = len(rows)
    while len(rows) < near + FAR_TREES:
        ring, turn = rng.uniform(0, 1) ** 0.7 * 330.0 + 120.0, rng.uniform(0, 2 * np.pi)
        x, z = ring * np.sin(turn), ring * np.cos(turn) - 40.0
        if max(abs(x) - 125.0, abs(z + 50.0) - 145.0) < 0.0:
            continue
        wood = noise.fbm(x / 330.0, z / 330.0 + 4, 4) + 0.5 * noise(x / 60.0, z / 60.0)
        if rng.random() > smoothstep(-0.1, 0.25, wood):
            continue
        kind = BROADLEAF if rng.random() < 0.2 else CONIFER
        rows.append((x, z, kind, rng.uniform(11.0, 20.0)))
    table = np.array(rows)
    kinds = table[:, 2].astype("i8")
    x, z = table[:, 0], table[:, 1]
    variant = rng.integers(0, VARIANTS, len(table))
    far = np.arange(len(table)) >= near
    variant[far] = 0
    return Trees(
        kinds * VARIANTS + variant,
        np.stack([x, np.asarray(terrain.height(x, z)) - 0.06, z], 1),
        table[:, 3],
        rng.uniform(0.0, 2 * np.pi, len(table)),
        far,
    )


def rocks(terrain: Terrain, seed: int) -> list[tuple[float, float, float, float, float]]:
    """(x, y, z, size, turn) of boulders: at the pond, along the path, in the meadow."""
    rng = np.random.default_rng(seed + 4)
    found: list[tuple[float, float, float, float, float]] = []

    def put(x: float, z: float, size: float) -> None:
        if terrain.trail_distance(np.array([[x, z]]))[0] > 1.6 + 0.5 * size:
            y = float(terrain.height(x, z)) + 0.06 * size
            found.append((x, y, z, size, rng.uniform(0, 2 * np.pi)))

    for ring in (0.3, 0.42, 0.5, 2.0, 2.9, 3.1, 4.4, 5.6):
        reach = rng.uniform(1.02, 1.14)
        x = layout.POND[0] + layout.POND_RADII[0] * reach * np.cos(ring)
        z = layout.POND[1] + layout.POND_RADII[1] * reach * np.sin(ring)
        put(x, z, rng.uniform(0.5, 1.3))
    for x, z, size in ((-6.0, 66.0, 1.7), (-7.2, 64.8, 0.9), (4.6, 33.0, 1.1), (5.2, 31.8, 0.6),
                       (-4.4, 12.0, 1.4), (6.4, -12.0, 2.0), (7.9, -13.1, 1.1), (-9.5, -33.0, 1.3),
                       (-13.5, -95.0, 1.6), (-4.2, -100.0, 1.0), (-15.4, -137.0, 1.8),
                       (-27.5, -157.0, 0.8), (25.5, -90.5, 1.2), (15.0, -48.0, 1.5)):  # fmt: skip
        put(x, z, size)
    while len(found) < 36:
        x, z = rng.uniform(-60, 60), rng.uniform(-170, 80)
        clear = _clear_of_everything(terrain, np.array([[x, z]]))[0]
        if clear or (abs(x) > 8 and rng.random() < 0.02):
            put(x, z, rng.uniform(0.5, 2.2))
    return found
