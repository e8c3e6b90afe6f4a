"""Pictures of snow flakes, made here: six-fold crystals, needles, clumps, melting flakes.

A picture is (SIZE, SIZE, 2) in 0 to 1: how much of a texel the flake covers, and how bright it is.
Crystals are drawn as distances to shapes in a twelfth of the plane, into which the whole plane is
folded, so each is as regular as only a drawing can be, and no two are alike.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

SIZE = 64  # texels on a side
TEXEL = 2.0 / SIZE  # the picture spans -1 to 1
_AXIS = (np.arange(SIZE) + 0.5) * TEXEL - 1.0
X, Y = (grid.astype(np.float32) for grid in np.meshgrid(_AXIS, _AXIS))
RADIUS = np.hypot(X, Y)


def _folded() -> tuple[NDArray, NDArray]:
    """The plane folded into a twelfth, from an arm half way to the next: along it, beside it."""
    sector = math.pi / 3.0
    angle = np.arctan2(Y, X) % sector
    angle = np.minimum(angle, sector - angle)
    return RADIUS * np.cos(angle), RADIUS * np.sin(angle)


ALONG, BESIDE = _folded()


def covered(distance: NDArray) -> NDArray:
    """Share of each texel inside a shape, from the distance to its edge (negative inside)."""
    return np.clip(0.5 - distance / TEXEL, 0.0, 1.0)


def bar(a: tuple[float, float], b: tuple[float, float], ends: tuple[float, float]) -> NDArray:
    """Distance to a bar from a to b in the folded plane, half as wide as `ends` at its ends."""
    px, py = ALONG - a[0], BESIDE - a[1]
    dx, dy = b[0] - a[0], b[1] - a[1]
    t = np.clip((px * dx + py * dy) / max(dx * dx + dy * dy, 1e-9), 0.0, 1.0)
    return np.hypot(px - t * dx, py - t * dy) - (ends[0] + (ends[1] - ends[0]) * t)


def hexagon(reach: float) -> NDArray:
    """Distance to the hexagon whose corners lie `reach` along the arms."""
    half = math.radians(30.0)
    return ALONG * math.cos(half) + BESIDE * math.sin(half) - reach * math.cos(half)


def _picture(edge: NDArray, thick: NDArray, glassy: float) -> NDArray:
    """A crystal: thick ice is bright, its rim brighter, thin ice lets the ground through."""
    cover = covered(edge) * np.clip(glassy + (1.0 - glassy) * thick, 0.0, 1.0)
    bright = np.clip(0.72 + 0.28 * thick, 0.0, 1.0)
    return np.stack([cover, bright], axis=2)


def plate(rng: np.random.Generator) -> NDArray:
    """A hexagonal plate with ribs, rings and sometimes a sector at each corner."""
    reach = 0.94
    edge = hexagon(reach)
    thick = np.exp(-((edge / 0.045) ** 2))
    thick = np.maximum(thick, 0.85 * covered(bar((0, 0), (0.9, 0), (0.02, 0.05))))
    for ring in rng.uniform(0.25, 0.8, rng.integers(1, 4)):
        thick = np.maximum(thick, rng.uniform(0.4, 0.9) * np.exp(-((hexagon(ring) / 0.03) ** 2)))
    core = rng.uniform(0.15, 0.4)
    thick = np.maximum(thick, rng.uniform(0.3, 0.8) * covered(hexagon(core)))
    if rng.random() < 0.6:  # sectors: notches between the corners
        across = ALONG * 0.5 - BESIDE * 0.866  # from the line half way to the next arm
        edge = np.maximum(edge, np.minimum(rng.uniform(0.015, 0.07) - across, RADIUS - 0.4))
    return _picture(edge, thick, 0.45)


def star(rng: np.random.Generator) -> NDArray:
    """A stellar crystal: six plain arms, perhaps with broad ends, about a small plate."""
    width = rng.uniform(0.025, 0.055)
    edge = bar((0, 0), (0.93, 0), (width * rng.uniform(1.0, 1.8), width))
    edge = np.minimum(edge, hexagon(rng.uniform(0.12, 0.42)))
    if rng.random() < 0.6:  # an end like a spade
        at, out = rng.uniform(0.6, 0.8), rng.uniform(0.1, 0.22)
        edge = np.minimum(edge, bar((at, 0), (0.9, 0), (out, 0.02)))
    for at in rng.uniform(0.3, 0.8, rng.integers(0, 3)):
        edge = np.minimum(edge, _arm(at, rng.uniform(0.08, 0.24), width * 0.8))
    thick = np.exp(-((BESIDE / (0.6 * width + 0.02)) ** 2)) + 0.5 * covered(hexagon(0.15))
    return _picture(edge, thick, 0.6)


def dendrite(rng: np.random.Generator) -> NDArray:
    """A fern-like crystal: arms with side arms at 60 degrees, which may have their own."""
    width = rng.uniform(0.022, 0.04)
    edge = bar((0, 0), (0.95, 0), (1.6 * width, 0.6 * width))
    edge = np.minimum(edge, hexagon(rng.uniform(0.08, 0.26)))
    count = int(rng.integers(4, 9))
    places = np.linspace(0.2, 0.82, count) + rng.uniform(-0.03, 0.03, count)
    shape = rng.uniform(0.3, 0.7)  # where the side arms are longest
    for at in places:
        longest = 0.5 * at + 0.04  # up to the middle between two arms
        length = longest * rng.uniform(0.6, 1.25) * (1.0 - 0.9 * abs(at - shape))
        length = min(length, (1.0 - at) * 1.2)
        edge = np.minimum(edge, _arm(at, length, 0.8 * width))
        if length > 0.2 and rng.random() < 0.7:  # side arms of the second order, along the arm
            half = 0.55 * length
            foot = (at + 0.5 * half, 0.866 * half)
            tip = (foot[0] + 0.45 * half, foot[1])
            edge = np.minimum(edge, bar(foot, tip, (0.7 * width, 0.5 * width)))
    thick = np.exp(-((BESIDE / 0.035) ** 2)) + 0.35
    return _picture(edge, thick, 0.6)


def _arm(at: float, length: float, width: float) -> NDArray:
    """A side arm at 60 degrees from its arm."""
    tip = (at + 0.5 * length, 0.866 * length)
    return bar((at, 0.0), tip, (width, 0.7 * width))


def needle(rng: np.random.Generator) -> NDArray:
    """One to three needles or columns across each other."""
    cover = np.zeros_like(X)
    for turn in rng.uniform(-0.5, 0.5, rng.integers(1, 4)):
        c, s = math.cos(turn), math.sin(turn)
        along, beside = X * c + Y * s, -X * s + Y * c
        width, end = rng.uniform(0.05, 0.12), rng.uniform(0.75, 0.92)
        edge = np.maximum(np.abs(beside) - width, np.abs(along) - end)
        cover = np.maximum(cover, covered(edge) * (0.7 + 0.3 * np.abs(beside) / width))
    return np.stack([cover, 0.8 + 0.2 * cover], axis=2)


def clump(rng: np.random.Generator, crystals: list[NDArray]) -> NDArray:
    """An aggregate: crystals of all sizes and tilts caught in each other, denser in the middle."""
    left, light = np.ones_like(X), np.zeros_like(X)
    count = int(rng.integers(9, 20))
    stretch, lean = rng.uniform(0.65, 1.0), rng.uniform(0.0, math.pi)
    for k in range(count):
        image = crystals[int(rng.integers(len(crystals)))]
        size = rng.uniform(0.3, 0.62)
        away = (1.0 - 0.9 * size) * math.sqrt(rng.random()) * (0.4 + 0.6 * k / count)
        turn = rng.uniform(0.0, 2.0 * math.pi)
        ax, ay = away * math.cos(turn), away * math.sin(turn) * stretch
        cx = ax * math.cos(lean) - ay * math.sin(lean)
        cy = ax * math.sin(lean) + ay * math.cos(lean)
        piece = tilted(image, cx, cy, size, rng.uniform(0.3, 1.0), rng.uniform(0.0, math.pi))
        shade = rng.uniform(0.75, 1.0)
        cover = np.minimum(piece[..., 0] * 1.3, 1.0)
        light += left * cover * piece[..., 1] * shade
        left *= 1.0 - cover
    cover = 1.0 - left
    light /= np.maximum(cover, 1e-3)
    # What is too fine for a texel, between the arms.
    c, s = math.cos(lean), math.sin(lean)
    round_ = np.hypot(X * c + Y * s, (-X * s + Y * c) / stretch)
    haze = 0.6 * np.exp(-((round_ / 0.5) ** 2))
    light = np.where(cover > 0.05, light, 0.75)
    return np.stack([np.maximum(cover, haze), light], axis=2)


def tilted(image: NDArray, cx: float, cy: float, size: float, tilt: float, turn: float) -> NDArray:
    """A picture drawn into another about (cx, cy), turned and foreshortened by `tilt`."""
    c, s = math.cos(turn), math.sin(turn)
    u = ((X - cx) * c + (Y - cy) * s) / size
    v = (-(X - cx) * s + (Y - cy) * c) / (size * tilt)
    inside = (np.abs(u) < 1.0) & (np.abs(v) < 1.0)
    i = np.clip(((u + 1.0) * 0.5 * SIZE).astype(np.int64), 0, SIZE - 1)
    j = np.clip(((v + 1.0) * 0.5 * SIZE).astype(np.int64), 0, SIZE - 1)
    return np.where(inside[..., None], image[j, i], 0.0)


def melting(rng: np.random.Generator) -> NDArray:
    """A wet flake: a lump sunk in on itself, bright where ice is left, glassy around it."""
    edge = RADIUS - 0.7
    angle = np.arctan2(Y, X)
    for k in range(2, 6):
        edge = edge + rng.uniform(0.0, 0.26) / k * np.cos(k * angle + rng.uniform(0.0, 6.3))
    ice = np.zeros_like(X)
    for _ in range(6):
        turn, away = rng.uniform(0.0, 6.3), 0.5 * math.sqrt(rng.random())
        d = np.hypot(X - away * math.cos(turn), Y - away * math.sin(turn))
        ice = np.maximum(ice, np.clip(1.4 - d / rng.uniform(0.2, 0.45), 0.0, 1.0))
    cover = np.clip(0.5 - edge / 0.1, 0.0, 1.0) * (0.35 + 0.6 * ice)
    return np.stack([cover, 0.6 + 0.4 * ice], axis=2)
