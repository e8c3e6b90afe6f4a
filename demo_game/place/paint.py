"""Painted maps: the meadow's colours with path and contact shade, and the tiled detail."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

from . import layout, palette
from .noise import Noise, smoothstep
from .terrain import Terrain

SIZE = 1024  # texels
LOW = np.array([-165.0, -220.0])  # (x, z), m, of the meadow's map
HIGH = np.array([165.0, 110.0])
MARGIN = 14.0  # m, over which the map gives way to plain colours
DETAIL = 512


def _mix(color: NDArray, other: NDArray, share: NDArray) -> NDArray:
    return color + (other - color) * share[..., None]


def texel_grid() -> tuple[NDArray, NDArray]:
    """(SIZE, SIZE) x and z of the texels' middles, rows along z."""
    step = (HIGH - LOW) / SIZE
    xs = LOW[0] + (np.arange(SIZE) + 0.5) * step[0]
    zs = LOW[1] + (np.arange(SIZE) + 0.5) * step[1]
    return np.meshgrid(xs, zs)


def _coarse(values: NDArray, step: int) -> NDArray:
    """Values on every `step`-th texel spread over all of them, bilinearly."""
    for axis in (0, 1):
        following = np.roll(values, -1, axis)
        share = np.arange(step) / step
        spread = [values + (following - values) * t for t in share]
        values = np.stack(spread, axis + 1).reshape(
            [n * (step if k == axis else 1) for k, n in enumerate(values.shape)]
        )
    return values


def _near(x: NDArray, z: NDArray, line: NDArray, reach: float) -> NDArray:
    """Distance of every texel from a line, `reach` where it is farther than that."""
    low, high = line.min(0) - reach, line.max(0) + reach
    box = (x > low[0]) & (x < high[0]) & (z > low[1]) & (z < high[1])
    found = np.full(x.shape, reach)
    points = np.stack([x[box], z[box]], 1)
    found[box] = np.minimum(layout.distance_to_line(points, line), reach)
    return found


def meadow(terrain: Terrain, shades: Sequence[tuple[float, float, float, float]]) -> NDArray:
    """(SIZE, SIZE, 4) u1: square root of the albedo times contact shade; alpha is full.

    `shades` are (x, z, radius, strength) of what stands on the grass.
    """
    noise = terrain.noise
    x, z = texel_grid()
    broad = _coarse(noise.fbm(x[::8, ::8] / 34.0, z[::8, ::8] / 34.0, 3), 8)
    fine = _coarse(noise.fbm(x[::2, ::2] / 5.5 + 7, z[::2, ::2] / 5.5, 3), 2)
    grain = noise(x / 0.7, z / 0.7)
    color = np.broadcast_to(palette.GRASS, (*x.shape, 3))
    color = _mix(color, palette.GRASS_DRY, smoothstep(-0.05, 0.55, broad + 0.35 * fine))
    color = _mix(color, palette.GRASS_LUSH, smoothstep(0.02, 0.5, -broad + 0.4 * fine) * 0.9)
    color = color * (1.0 + 0.13 * fine + 0.10 * grain)[..., None]
    path = _near(x, z, terrain.path[::2], 6.0)
    spur = _near(x, z, terrain.spur[::2], 6.0)
    track = _near(x, z, terrain.track[::2], 6.0)
    edge = 0.32 * fine + 0.16 * grain
    worn = np.minimum(path, spur + 0.15) + edge
    color = _mix(color, palette.GRASS_DRY * 0.86, smoothstep(2.7, 1.1, worn) * 0.75)
    earth = smoothstep(1.35, 0.75, worn)
    middle = 0.45 * smoothstep(0.35, 0.1, np.minimum(path, 6.0) + 0.5 * edge) * (spur > 2.0)
    ruts = smoothstep(0.42, 0.18, np.abs(track - 0.75) + 0.5 * edge)
    earth = np.maximum(earth * (1.0 - middle), 0.75 * ruts)
    dx, dz = np.abs(x - layout.CABIN[0]), np.abs(z - layout.CABIN[1] - 1.2)
    yard = smoothstep(1.6, 0.1, np.hypot(np.maximum(dx - 3.2, 0), np.maximum(dz - 4.2, 0)) + edge)
    earth = np.maximum(earth, 0.8 * yard)
    loop = _near(x, z, layout.smooth_line(layout.FIGURE_LOOP, closed=True, step=4), 6.0)
    earth = np.maximum(earth, 0.55 * smoothstep(0.75, 0.2, loop + edge))
    tone = 1.0 + 0.16 * fine + 0.12 * grain
    color = _mix(color, palette.PATH_EARTH * tone[..., None], earth)
    q = terrain.pond_radius(x, z)
    shore = q + 0.05 * fine
    color = _mix(color, palette.GRASS_LUSH * 0.9, smoothstep(1.55, 1.2, shore) * 0.8)
    color = _mix(color, palette.MUD, smoothstep(1.17, 1.05, shore))
    color = _mix(color, palette.BED, smoothstep(1.02, 0.8, q))
    shade = np.ones(x.shape)
    step = (HIGH - LOW) / SIZE
    for cx, cz, radius, strength in shades:
        low = np.floor((np.array([cx, cz]) - radius - LOW) / step).astype(int).clip(0, SIZE)
        high = np.ceil((np.array([cx, cz]) + radius - LOW) / step).astype(int).clip(0, SIZE)
        part = np.s_[low[1] : high[1], low[0] : high[0]]
        away = np.hypot(x[part] - cx, z[part] - cz) / radius
        shade[part] *= 1.0 - strength * (1.0 - smoothstep(0.0, 1.0, away))
    wall = np.hypot(np.maximum(dx - 3.0, 0), np.maximum(np.abs(z - layout.CABIN[1]) - 2.5, 0))
    shade *= 1.0 - 0.5 * smoothstep(1.5, 0.0, wall)
    coded = np.sqrt(np.clip(color * shade[..., None], 0.0, 1.0))
    dither = np.random.default_rng(1).random(coded.shape)
    out = np.full((*x.shape, 4), 255, "u1")
    out[..., :3] = np.clip(coded * 255.0 + dither, 0, 255)
    return out


def detail() -> NDArray:
    """(512, 512, 4) u1 tiled grey: wood grain along u, stone, leaves and grass; broad patches.

    The first three twice along each side.
    """
    n = DETAIL // 2
    u, v = np.meshgrid(np.arange(n) / n, np.arange(n) / n)

    def tiled(seed: int, across: int, along: int) -> NDArray:
        noise = Noise(seed)  # periods that divide its 256 cells repeat when the lattice is cut
        table = noise.table[:along, :across]
        noise.table = np.tile(table, (256 // along, 256 // across))
        return noise(u * across, v * along)

    wood = 0.55 * tiled(1, 4, 64) + 0.35 * tiled(2, 8, 128) + 0.25 * tiled(3, 2, 16)
    stone = 0.5 * tiled(4, 16, 16) + 0.4 * tiled(5, 32, 32) + 0.35 * tiled(6, 128, 128)
    grass = 0.35 * tiled(7, 8, 8) + 0.5 * tiled(8, 32, 32) + 0.5 * tiled(9, 64, 64)
    grass += 0.45 * tiled(10, 128, 128)
    fine = [np.tile(layer, (2, 2)) for layer in (wood, stone, grass)]
    layers = np.stack([*fine, patches(13, DETAIL)], -1)
    layers /= np.abs(layers).max((0, 1)) * (0.75, 0.8, 0.75, 1.0)
    return np.clip(127.5 + 127.5 * layers, 0, 255).astype("u1")


def patches(seed: int, n: int) -> NDArray:
    """(n, n) tiled noise without a lattice: shores of puddles show every lattice, as steps.

    From 2 to 100 waves across, the longer the stronger.
    """
    wave = np.fft.fftfreq(n, 1.0 / n)
    across = np.hypot(*np.meshgrid(wave, wave))
    strength = np.where((across >= 2.0) & (across < 100.0), np.maximum(across, 3.0) ** -2.1, 0.0)
    white = np.random.default_rng(seed).standard_normal((n, n))
    field = np.fft.ifft2(np.fft.fft2(white) * strength).real
    return np.asarray(np.tanh(field / (2.6 * field.std()) - 0.09))
