"""Ripples: the eight-neighbour scheme of Liu and Tong (2015), 2.1 (3), with its slips put right.

Notation: amplitudes a(t) on a grid, one step from t to t + 1; S the sum over the eight neighbours.

    a(t + 1) = (S a(t) / 4 - a(t - 1)) (1 - 2^-n),   0 where its size is below the threshold

A wave of wave number k (rad a cell) turns by w a step, where 2 cos w = l(k) and

    l(k) = (cos kx + cos ky + 2 cos kx cos ky) / 2

never leaves [-2, 2]: the scheme is stable. Long waves cover COURANT cells a step.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ..errors import InvalidValueError
from .checks import count, number
from .words import hash_unit, hash_word

LEAST_DAMPING, MOST_DAMPING = 5, 9  # n; a larger one damps less
UNIT = 30.0  # mm, the amplitude's: the threshold is a fifteenth of the least crater
THRESHOLD = 0.01 * UNIT  # mm
COURANT = math.sqrt(0.75)  # cells that a long wave covers in a step

# What a drop does to the grid; also in shaders/ripple_source.vert.
WIDTH = 1.25  # cells, of the crater: its radius over sqrt(2)
SPREAD = 4.0 * WIDTH  # cells, beyond which a source is nothing
DEPTH = 0.12  # mm of crater per unit of mm^1.5 m/s, for one real drop
SHALLOWEST, DEEPEST = 5.0, 10.0  # mm
COMMON = 6.0  # mm, of the craters that a drop makes which stands for many
MOST_CRATERS = 5  # of one impact
SCATTER = 0.5  # m, that all but the first lie off it at most
ROUGHEST = 0.08  # at 25 mm/h
ON_SURFACE = 0.05  # m, height within which an impact is one on the water


def step(
    current: Any, previous: Any, n: int = 6, threshold: float = 0.01, *, periodic: bool = False
) -> NDArray:
    """The amplitudes a step later, (rows, columns); the border is held at 0.

    With `periodic` there is no border: what leaves on one side comes in on the other. The arrays
    are left as they are; float32 stays float32. Raises InvalidValueError for arrays of different
    or other than two dimensions, values that are not finite, n outside 5 to 9, threshold below 0.
    """
    now, before = _grid("current", current), _grid("previous", previous)
    if now.shape != before.shape:
        raise InvalidValueError("previous", before.shape, f"the shape of current, {now.shape}")
    keep = kept_share(n)
    least = number("threshold", threshold, 0.0)
    if periodic:
        return _advance(np.pad(now, 1, mode="wrap"), before, keep, least)
    following = np.zeros_like(now)
    inner = slice(1, -1)
    following[inner, inner] = _advance(now, before[inner, inner], keep, least)
    return following


def _advance(now: NDArray, before: NDArray, keep: float, least: float) -> NDArray:
    """The step for all cells of `before`; `now` has one more on every side."""
    new = (_around(now) * now.dtype.type(0.25) - before) * now.dtype.type(keep)
    new[np.abs(new) < least] = 0.0
    return new


def _around(a: NDArray) -> NDArray:
    """Sums over the eight neighbours of every cell that has eight; in the shader's order."""
    low = a[:-2, :-2] + a[:-2, 1:-1] + a[:-2, 2:]
    level = a[1:-1, :-2] + a[1:-1, 2:]
    high = a[2:, :-2] + a[2:, 1:-1] + a[2:, 2:]
    return low + level + high


def kept_share(n: int) -> float:
    """1 - 2^-n, what a step leaves of an amplitude. Raises InvalidValueError outside 5 to 9."""
    allowed = f"a whole number from {LEAST_DAMPING} to {MOST_DAMPING}"
    try:
        whole = count("n", n)
    except InvalidValueError:
        raise InvalidValueError("n", n, allowed) from None
    if not LEAST_DAMPING <= whole <= MOST_DAMPING:
        raise InvalidValueError("n", n, allowed)
    return 1.0 - 0.5**whole


def energy(current: Any, previous: Any, n: int = 6) -> float:
    """What every step without a threshold makes smaller by the factor 1 - 2^-n; never below 0.

    For grids whose border is 0. With s the kept share: |a|^2 + s |b|^2 - s a . S b / 4.
    """
    now = _grid("current", current).astype(np.float64)
    before = _grid("previous", previous).astype(np.float64)
    share = kept_share(n)
    squares = (now * now).sum() + share * (before * before).sum()
    return float(squares - share * 0.25 * (now * _around(np.pad(before, 1))).sum())


def time_step(cell: float, speed: float) -> float:
    """Seconds a step, so that waves on cells of `cell` m run at `speed` m/s."""
    return COURANT * number("cell", cell, 0.0, above=True) / number("speed", speed, 0.0, above=True)


def settling_steps(n: int) -> int:
    """Steps in which the waves of the deepest crater fall below the threshold."""
    return math.ceil(2.0 * math.log(THRESHOLD / DEEPEST) / math.log(kept_share(n)))


def roughness(rain_rate: Any) -> NDArray[np.float64]:
    """Slope, root of the mean square, that rain at mm/h gives to water, all sizes of waves."""
    rate = np.asarray(rain_rate, np.float64)
    return ROUGHEST * np.minimum(np.sqrt(rate / 25.0), 1.5)


def craters(
    positions: Any, diameters: Any, speeds: Any, weights: Any
) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
    """Craters of each impact: how far off it along the water's own axes, (n, MOST_CRATERS, 2) m,
    and depths, (n, MOST_CRATERS) mm; 0 where there is none.

    Positions (n, 3) m, diameters mm, speeds m/s, weights in real drops. The waves' energy is that
    of the falling drops, so the root of the sum of squared depths grows with that of the weight. A
    crater that could not be seen is left out by lot, or made as deep as can be seen, so often that
    the energy stays right; one that would be too deep is several.
    """
    p = np.ascontiguousarray(positions, np.float32).reshape(-1, 3)
    d, v, w = (np.asarray(a, np.float32) for a in (diameters, speeds, weights))
    deep = np.float32(DEPTH) * d * np.sqrt(d) * v * np.sqrt(w)
    spot = np.floor(p[:, [0, 2]] * np.float32(64.0)).astype(np.int32).view(np.uint32)
    word = hash_word(spot[:, 0]) ^ spot[:, 1]
    share = deep / np.float32(SHALLOWEST)
    drawn = hash_unit(word) < share * share
    number = np.clip(np.floor((deep / np.float32(COMMON)) ** 2), 1, MOST_CRATERS)
    each = np.clip(deep / np.sqrt(number), np.float32(SHALLOWEST), np.float32(DEEPEST))
    k = np.arange(MOST_CRATERS, dtype=np.uint32)
    depths = np.where(drawn[:, None] & (k < number[:, None]), each[:, None], np.float32(0.0))
    own = hash_word(word[:, None] + np.uint32(0x9E3779B9) * k)
    turn = np.float32(2.0 * math.pi) * hash_unit(own ^ np.uint32(0x27D4EB2F))
    off = np.float32(SCATTER) * np.sqrt(hash_unit(own ^ np.uint32(0x85EBCA6B))) * (k > 0)
    return np.stack([off * np.cos(turn), off * np.sin(turn)], 2), depths.astype(np.float32)


def add_sources(grid: NDArray, places: Any, deep: Any, *, periodic: bool = False) -> None:
    """Press craters into a grid, in place: `places` (n, 2) column and row, 0.5 in the first cell.

    -d (1 - q) exp(-q) with q = r^2 / (2 WIDTH^2): a crater and its rim, no water more or less.
    """
    rows, columns = grid.shape
    x, y = np.arange(columns) + 0.5, np.arange(rows) + 0.5
    for (px, py), depth in zip(np.atleast_2d(places), np.atleast_1d(deep), strict=True):
        dx, dy = x - px, y - py
        if periodic:
            dx = (dx + 0.5 * columns) % columns - 0.5 * columns
            dy = (dy + 0.5 * rows) % rows - 0.5 * rows
        near = np.maximum(np.abs(dx)[None, :], np.abs(dy)[:, None]) < SPREAD
        q = (dx[None, :] ** 2 + dy[:, None] ** 2) / (2.0 * WIDTH * WIDTH)
        grid -= (depth * (1.0 - q) * np.exp(-q) * near).astype(grid.dtype)


def _grid(name: str, value: Any) -> NDArray:
    """`value` as a grid of floats."""
    allowed = "finite numbers in rows and columns"
    try:
        array = np.asarray(value)
    except (TypeError, ValueError):
        raise InvalidValueError(name, value, allowed) from None
    if array.ndim != 2 or array.dtype.kind not in "fiub" or not np.isfinite(array).all():
        raise InvalidValueError(name, value, allowed)
    return array if array.dtype.kind == "f" else array.astype(np.float64)
