"""The shape of a lightning channel: a crooked trunk with branches, by midpoint displacement.

Displacing the middle of every piece at right angles by s of its length (root mean square) makes two
pieces of sqrt(1 + 4 s^2) / 2 of it, and so a curve of the dimension (Mandelbrot 1982)

    D = ln 2 / ln(2 / sqrt(1 + 4 s^2)),  s = sqrt(4^(1 - 1/D) - 1) / 2

Photographed channels have about 1.1 to 1.4, 1.34 with all their branches (Tsonis and Elsner 1987).
"""

from __future__ import annotations

import math
from functools import lru_cache
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from weather_ecs.physics.chance import uniforms

DIMENSION = 1.16
TRUNK, BRANCH, TWIG = 8, 5, 3  # levels: 256, 32 and 8 pieces
SMOOTH = 0.6  # factor on the first two displacements
BRANCHES = 11  # of the trunk, each with TWIGS
TWIGS = 2

Vector = tuple[float, float, float]


class Bolt(NamedTuple):
    """Pieces of a channel, (n, ...)."""

    begin: NDArray  # (n, 3) m
    end: NDArray  # (n, 3) m
    light: NDArray  # (n, 2) 0 to 1, at both ends; 1: of the trunk
    along: NDArray  # (n,) 0 to 1: when the leader comes by
    order: NDArray  # (n,) 0 trunk, 1 branch, 2 twig
    trunk: NDArray  # (257, 3) m, from the origin to the target


def roughness(dimension: float) -> float:
    """s of a curve of that dimension, 1 to 2."""
    return 0.5 * math.sqrt(4.0 ** (1.0 - 1.0 / dimension) - 1.0)


def crooked(
    begin: NDArray, end: NDArray, levels: int, word: int, dimension: float = DIMENSION
) -> NDArray:
    """(b, 2**levels + 1, 3): curves between the points (b, 3) of two arrays."""
    count, pieces = len(begin), 1 << levels
    points = np.zeros((count, pieces + 1, 3))
    points[:, 0], points[:, -1] = begin, end
    # Even in a cube: across the piece the mean square is 2/3.
    off = uniforms(np.arange(3 * count * (pieces - 1)), word).reshape(-1, 3) * 2.0 - 1.0
    off *= roughness(dimension) / math.sqrt(2.0 / 3.0)
    done = 0
    for level in range(levels):
        step = pieces >> level
        left, right = points[:, :-1:step], points[:, step::step]
        chord = right - left
        length2 = np.maximum((chord * chord).sum(-1, keepdims=True), 1e-12)
        some = off[done : done + (count << level)].reshape(chord.shape)
        done += count << level
        if level < 2:
            some = some * SMOOTH  # a channel keeps more to its way than a curve of that dimension
        across = some - chord * ((some * chord).sum(-1, keepdims=True) / length2)
        points[:, step // 2 :: step] = 0.5 * (left + right) + across * np.sqrt(length2)
    return points


@lru_cache(maxsize=64)
def bolt(
    origin: Vector, target: Vector, word: int, *, ground: bool = True, branches: float = 1.0
) -> Bolt:
    """The channel from `origin` to `target`, m; arrays are shared and not to be written to."""
    a, b = np.array([origin], float), np.array([target], float)
    floor = float(b[0, 1]) if ground else -math.inf
    trunk = crooked(a, b, TRUNK, word * 8 + 1)
    parts = [_pieces(trunk, np.zeros(1), np.ones(1), 1.0, 1.0, 0)]
    span = float(np.linalg.norm(b - a))
    count = round(branches * BRANCHES)
    if count and span > 0.0:
        grown, starts = _grow(trunk, count, BRANCH, 0.5 * span, floor, word * 8 + 2)
        spread = np.full(count, 0.4)
        parts.append(_pieces(grown, starts, spread, 0.55, 0.10, 1))
        twigs, at = _grow(grown, TWIGS * count, TWIG, 0.16 * span, floor, word * 8 + 4)
        begun = np.repeat(starts, TWIGS) + 0.4 * at
        parts.append(_pieces(twigs, begun, np.full(len(twigs), 0.15), 0.28, 0.04, 2))
    columns = [np.concatenate(column) for column in zip(*parts, strict=True)]
    for column in (*columns, trunk):
        if ground and column.ndim > 1 and column.shape[-1] == 3:
            np.maximum(column[..., 1], floor, out=column[..., 1])
        column.setflags(write=False)
    begin, end, light, along, order = columns
    return Bolt(begin, end, light, along, order, trunk[0])


def _grow(
    stems: NDArray, count: int, levels: int, longest: float, floor: float, word: int
) -> tuple[NDArray, NDArray]:
    """(curves, where on their stems they begin, 0 to 1): `count` in all, evenly over the stems."""
    owner = np.arange(count) * len(stems) // count
    chance = uniforms(np.arange(6 * count), word).reshape(6, count)
    each = max(count // len(stems), 1)
    share = 0.12 + 0.8 * ((np.arange(count) % each) + chance[0]) / each
    last = stems.shape[1] - 1
    at = np.minimum((share * last).astype(int), last - 1)
    reach = max(last // 16, 1)
    root = stems[owner, at]
    along = stems[owner, np.minimum(at + reach, last)] - stems[owner, np.maximum(at - reach, 0)]
    along = along / np.maximum(np.linalg.norm(along, axis=1, keepdims=True), 1e-9)
    aside = chance[1:4].T * 2.0 - 1.0
    aside -= along * (aside * along).sum(1, keepdims=True)
    aside /= np.maximum(np.linalg.norm(aside, axis=1, keepdims=True), 1e-9)
    # Between some 25 and 55 degrees off the way of what they leave, and rather down than up.
    way = along + aside * (0.45 + 0.95 * chance[4])[:, None]
    if math.isfinite(floor):
        way[:, 1] -= 0.45
    way /= np.linalg.norm(way, axis=1, keepdims=True)
    length = longest * (0.25 + 0.75 * chance[5] ** 1.5) * (1.0 - 0.45 * share)
    if math.isfinite(floor):
        # They end in the air.
        room = 0.85 * np.maximum(root[:, 1] - floor, 0.0) / np.maximum(-way[:, 1], 1e-3)
        length = np.where(way[:, 1] < 0.0, np.minimum(length, room), length)
    return crooked(root, root + way * length[:, None], levels, word + 1), share


def _pieces(
    curves: NDArray, begun: NDArray, spread: NDArray, first: float, last: float, order: int
) -> tuple[NDArray, NDArray, NDArray, NDArray, NDArray]:
    """Columns of a Bolt, of curves (b, m + 1, 3)."""
    count, pieces = len(curves), curves.shape[1] - 1
    share = np.linspace(0.0, 1.0, pieces + 1)
    light = first + (last - first) * share
    ends = np.tile(np.stack([light[:-1], light[1:]], axis=1), (count, 1))
    along = np.minimum(begun[:, None] + spread[:, None] * share[1:], 1.0).ravel()
    return (
        curves[:, :-1].reshape(-1, 3).copy(),
        curves[:, 1:].reshape(-1, 3).copy(),
        ends,
        along,
        np.full(count * pieces, order),
    )
