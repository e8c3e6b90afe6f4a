"""The animated texture of a splash, made here: crown, burst and rings as the eye would see them.

Crowns and bursts are clouds of points, the water's sheets, jets and beads, seen from a little above
and projected: where the line of sight runs along a sheet it is brighter, as in a photograph. A
frame fills its picture at every age; that the splash grows is the affair of who draws it.
"""

from __future__ import annotations

import math
from functools import cache

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.gpu.mip_array import mip_array, mip_levels

SIZE = 64  # texels on a side
FRAMES = 16  # of each kind
# Kinds, the first layer of each by FRAMES; crown and burst in two variants.
CROWN, BURST, FILM, RING = 0, 2, 4, 5
BEAD = 6 * FRAMES  # the layer of a single droplet
LAYERS = BEAD + 1
# The upright pictures: half-width 1, and so high, of which so much is below the hit.
HEIGHT, BELOW = 1.5, 0.25
_FINE = 3  # a texel's share of the grid that the points are counted on
_WEIGHTS = np.array([0.2, 0.6, 1.3, 1.8, 2.0, 1.8, 1.3, 0.6, 0.2]) / 9.8
_TILT = 0.32  # sine of the height from which crown and burst are seen


def build() -> NDArray[np.uint8]:
    """Every layer, (LAYERS, SIZE, SIZE, 2): how much water, and how bright it is."""
    layers = np.zeros((LAYERS, SIZE, SIZE, 2), np.uint8)
    ages = (np.arange(FRAMES) + 0.5) / FRAMES
    for variant in range(2):
        for k, age in enumerate(ages):
            rng = np.random.default_rng([20, variant])
            layers[(CROWN + variant) * FRAMES + k] = _upright(*_crown(float(age), rng))
            rng = np.random.default_rng([21, variant])
            layers[(BURST + variant) * FRAMES + k] = _upright(*_burst(float(age), rng))
    for k, age in enumerate(ages):
        layers[FILM * FRAMES + k] = _film(float(age))
        layers[RING * FRAMES + k] = _ring(float(age))
    layers[BEAD] = _bead()
    return layers


@cache
def _built() -> list[bytes]:
    return [level.tobytes() for level in mip_levels(build())]


def splash_texture(ctx: moderngl.Context) -> moderngl.TextureArray:
    """The frames on the GPU, with smaller levels for distance."""
    return mip_array(ctx, SIZE, 2, _built())


Cloud = tuple[NDArray, NDArray, NDArray, NDArray]  # x, y, mass, light


def _crown(age: float, rng: np.random.Generator) -> tuple[Cloud, float]:
    """A wall that rises from a thin ring, frays into jets and beads, and sinks; lopsided."""
    jets = 8 + int(rng.integers(0, 5))
    at = (np.arange(jets) + rng.uniform(-0.35, 0.35, jets)) * (2.0 * math.pi / jets)
    strength = rng.uniform(0.5, 1.2, jets) * (1.0 + 0.4 * np.cos(at - rng.uniform(0.0, 6.3)))
    wall = 0.06 + 0.44 * _arc(age, 0.34)
    flare = 0.2 + 0.14 * age
    phi = np.linspace(0.0, 2.0 * math.pi, 300, endpoint=False)
    near = np.exp(-((_between(phi, at) * jets * 0.6) ** 2))
    ragged = (near * strength).max(axis=1)
    # Jets stand out of the rim, more so as the crown ages.
    tops = wall * (1.0 - min(2.0 * age, 0.75) * (1.0 - ragged))
    s = np.linspace(0.0, 1.0, 32)[:, None]
    thick = np.where(s > 0.9, 2.2, 1.0) * (0.35 + 0.8 * ragged) * (0.3 + 0.7 * s)
    thick = thick * (1.0 - 0.8 * min(age * 1.6, 1.0))
    parts = [_body(phi, 0.5 + flare * s**1.5, tops * s, thick)]
    # Threads are drawn out of the jets and let their beads go, outwards and on ways of their own.
    pull = float(np.clip((age - 0.03) * 5.0, 0.0, 1.0))
    t = np.linspace(0.0, 1.0, 36)
    foot = 0.5 + flare
    for phi_k, m in zip(at, strength, strict=True):
        high = wall * m + 0.32 * m * _arc(age, 0.42)
        far = foot + 0.30 * m * age
        thread = 2.2 * m * pull * max(1.0 - 1.4 * age, 0.0) * (1.0 - 0.7 * t)
        rise = wall * m * 0.8 + (high - wall * m * 0.8) * t
        parts.append(_body(np.full(36, phi_k), foot + (far - foot) * t, rise, thread))
        parts.append(_drop(phi_k, far, high, 0.026 + 0.022 * m, 20.0 * pull * m, rng))
        late = _arc(max(age - 0.08, 0.0), 0.5)
        away = foot + 0.16 + 0.2 * m * age
        loose = float(rng.uniform(0.3, 1.0))
        parts.append(
            _drop(phi_k + 0.3, away, high * 0.75 + 0.24 * late, 0.024, 11.0 * pull * loose, rng)
        )
    return _joined(parts), 0.13 * float(1.0 - _smooth(0.6, 1.0, age))


def _burst(age: float, rng: np.random.Generator) -> tuple[Cloud, float]:
    """On water: a low crown, then out of its middle a jet that stands, breaks and falls."""
    jets = 7 + int(rng.integers(0, 3))
    at = (np.arange(jets) + rng.uniform(-0.3, 0.3, jets)) * (2.0 * math.pi / jets)
    phi = np.linspace(0.0, 2.0 * math.pi, 360, endpoint=False)
    s = np.linspace(0.0, 1.0, 32)[:, None]
    rise = _arc(min(age * 1.5, 1.0), 0.4)
    ragged = np.exp(-((_between(phi, at) * jets * 0.5) ** 2)).max(axis=1)
    height = (0.05 + 0.42 * rise) * s * (0.6 + 0.4 * ragged)
    sheet = (0.4 + 0.9 * ragged * s) * max(1.0 - 1.5 * age, 0.0)
    parts = [_body(phi, 0.42 + 0.2 * s + 0.2 * age, height, sheet)]
    for phi_k in at:
        m = float(rng.uniform(0.6, 1.2))
        h = 0.36 * m * rise + 0.5 * m * _arc(age, 0.5)
        parts.append(_drop(phi_k, 0.62 + 0.3 * age * m, h, 0.03, 14.0 * m * (age > 0.1), rng))
    jet = max(_arc(max((age - 0.2) / 0.8, 0.0), 0.4), 0.0)
    top = 1.05 * jet
    s = np.linspace(0.0, 1.0, 60)[:, None]
    phi = np.linspace(0.0, 2.0 * math.pi, 24, endpoint=False)
    waist = 0.05 + 0.16 * (1.0 - s) ** 3 + 0.02 * np.sin(9.0 * s + 3.0 * age)
    parts.append(_body(phi, waist, top * s, np.full(s.shape, 2.2 * min(jet * 2.0, 1.0))))
    parts.append(_drop(0.0, 0.0, top + 0.06, 0.075, 60.0 * min(jet * 2.0, 1.0), rng))
    return _joined(parts), 0.085 * float(1.0 - _smooth(0.7, 1.0, age))


def _film(age: float) -> NDArray[np.uint8]:
    """Seen along the normal: water driven out over the ground: a frayed rim, threads, beads."""
    radius, angle = _polar()
    rng = np.random.default_rng(22)
    threads = 13
    at = (np.arange(threads) + rng.uniform(-0.4, 0.4, threads)) * (2.0 * math.pi / threads)
    reach = 0.62 + rng.uniform(0.1, 0.34, threads) * (0.5 + 0.5 * age)
    force = rng.uniform(0.3, 1.0, threads)
    edge = 0.58 + 0.03 * np.cos(5.0 * angle + 0.4) + 0.03 * np.cos(8.0 * angle + 2.1)
    aside = _between(angle.ravel(), at).reshape(SIZE, SIZE, threads)
    pull = (np.exp(-((aside * 3.2) ** 2)) * force).max(axis=2)
    rim = np.exp(-(((radius - edge) / (0.085 - 0.04 * age)) ** 2)) * (0.15 + 0.85 * pull)
    away = radius[..., None]
    along = _smooth(0.5, 0.6, away) * _smooth(0.0, 0.04, reach - away)
    line = np.exp(-((aside * away / 0.022) ** 2)) * along * np.cos(np.clip(aside, -1.5, 1.5))
    bead = np.exp(-((aside * away) ** 2 + (away - reach) ** 2) / 0.04**2)
    thrown = ((0.5 * line * (1.0 - age) + bead) * force).max(axis=2)
    inside = 0.3 * max(1.0 - 1.8 * age, 0.0) * _smooth(1.0, 0.9, radius / edge)
    water = (rim + thrown + inside) * (1.0 - _smooth(0.15, 0.6, age))
    return _picture(water, 0.35 + 0.5 * rim + 0.6 * thrown)


def _ring(age: float) -> NDArray[np.uint8]:
    """Seen along the normal: two rings that run out over water, bright and dark side by side."""
    radius, _ = _polar()
    water = np.zeros_like(radius)
    bright = np.full_like(radius, 0.5)
    for at, strength in ((0.79, 1.0), (0.50, 0.7 * _smooth(0.15, 0.4, age))):
        x = (radius - at) / (0.09 - 0.035 * age)
        water += strength * np.exp(-x * x)
        bright += strength * 0.5 * np.clip(-1.6 * x * np.exp(-x * x), -0.6, 1.0)
    return _picture(water * (1.0 - _smooth(0.35, 1.0, age)), bright)


def _bead() -> NDArray[np.uint8]:
    """A droplet, in the middle half of its picture: round, soft, light at its top."""
    radius, _ = _polar()
    y = np.linspace(-2.0, 2.0, SIZE)[:, None]
    return _picture(_smooth(0.48, 0.18, radius), 0.65 + 0.35 * y + 0.0 * radius)


# The grid


def _upright(cloud: Cloud, gain: float) -> NDArray[np.uint8]:
    """A picture of points: x in [-1, 1], y in [-BELOW, HEIGHT - BELOW]."""
    x, y, mass, light = cloud
    n = SIZE * _FINE
    column = np.clip(((x + 1.0) * 0.5 * n).astype(np.int64), 0, n - 1)
    row = np.clip(((y + BELOW) / HEIGHT * n).astype(np.int64), 0, n - 1)
    at = row * n + column
    grids = [np.bincount(at, w, n * n).reshape(n, n) for w in (mass, mass * light)]
    amount, lit = (_soften(grid) for grid in grids)
    # Nothing may touch the rim of the picture, where it would be cut off.
    side = np.abs(np.linspace(-1.0, 1.0, SIZE))
    soft = _smooth(1.0, 0.88, side)
    water = (1.0 - np.exp(-gain * amount * _FINE**2)) * soft * soft[:, None]
    return _picture(water, lit / np.maximum(amount, 1e-9))


def _body(phi: NDArray, radius: NDArray, height: NDArray, mass: NDArray) -> Cloud:
    """Points about the axis, seen from a little above; what faces us and is high is brighter."""
    front = -np.sin(phi)
    x, y = radius * np.cos(phi), height - _TILT * radius * front
    light = np.clip(0.55 + 0.2 * front + 0.45 * height, 0.0, 1.0)
    x, y, mass, light = (a.ravel() for a in np.broadcast_arrays(x, y, mass, light))
    return x, y, mass, light


def _drop(
    phi: float, radius: float, height: float, size: float, mass: float, rng: np.random.Generator
) -> Cloud:
    """A ball of points."""
    turn, spread = rng.uniform(0.0, 2.0 * math.pi, 90), np.sqrt(rng.uniform(0.0, 1.0, 90))
    x = radius * math.cos(phi) + size * spread * np.cos(turn)
    y = height + _TILT * radius * math.sin(phi) + size * spread * np.sin(turn)
    return x, y, np.full(90, mass / 90.0), np.clip(0.85 + spread * np.sin(turn) * 0.3, 0, 1)


def _joined(parts: list[Cloud]) -> Cloud:
    x, y, mass, light = (np.concatenate([part[k] for part in parts]) for k in range(4))
    return x, y, mass, light


def _soften(grid: NDArray) -> NDArray:
    """Texels from the fine grid: each the mean of its places and of a soft rim around them."""
    for _ in range(2):  # along the columns, then, turned, along the rows
        padded = np.pad(grid, ((_FINE, _FINE), (0, 0)))
        total = np.zeros((SIZE, grid.shape[1]))
        for k, weight in enumerate(_WEIGHTS):
            total += weight * padded[k : k + SIZE * _FINE : _FINE]
        grid = total.T
    return grid


def _picture(water: NDArray, light: NDArray) -> NDArray[np.uint8]:
    both = np.stack([water, light], axis=2)
    return np.round(np.clip(both, 0.0, 1.0) * 255.0).astype(np.uint8)


def _polar() -> tuple[NDArray, NDArray]:
    side = (np.arange(SIZE) + 0.5) / SIZE * 2.0 - 1.0
    x, y = np.meshgrid(side, side)
    return np.hypot(x, y), np.arctan2(y, x)


def _between(phi: NDArray, at: NDArray) -> NDArray:
    """Angles between points (n,) and jets (m,), (n, m), in [-pi, pi]."""
    return (phi[:, None] - at + math.pi) % (2.0 * math.pi) - math.pi


def _arc(age: float, top: float) -> float:
    """Thrown up and fallen back: 0 at 0, 1 at `top`, 0 again at 1 and after."""
    x = age / top * 0.5 if age < top else 0.5 + 0.5 * (age - top) / (1.0 - top)
    return max(4.0 * x * (1.0 - x), 0.0)


def _smooth(low: float, high: float, x: NDArray | float) -> NDArray:
    t = np.clip((np.asarray(x) - low) / (high - low), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)
