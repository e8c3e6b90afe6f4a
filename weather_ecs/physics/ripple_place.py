"""Where ripples are computed, and for which waters: pure functions of places and sizes.

Own axes of a water: u along its heading, w across, metres from its middle.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

Pair = tuple[float, float]


class GridPlace(NamedTuple):
    """The cells of a water, and whether they end at its border or go round, along and across."""

    cells: tuple[int, int]
    held: tuple[bool, bool]


def grid_of(size: Pair, cell: float, most: int) -> GridPlace:
    """The grid of a water of `size` m: all of it, or `most` cells that go round."""
    wanted = [max(math.ceil(side / cell - 1e-6), 3) for side in size]
    cells = (min(wanted[0], most), min(wanted[1], most))
    return GridPlace(cells, (wanted[0] <= most, wanted[1] <= most))


def window_of(grid: GridPlace, cell: float, size: Pair, ellipse: bool, focus: Pair) -> tuple[
    Pair, Pair
]:  # fmt: skip
    """(middle, half sizes) of the part of the water whose cells are computed, own axes, m.

    About `focus`, but not over the rim: a rectangle wherever that can be, in an ellipse as far as
    its middle may go.
    """
    sides = zip(size, grid.held, grid.cells, strict=True)
    half = [0.5 * (side if held else count * cell) for side, held, count in sides]
    room = [max(0.5 * s - h, 0.0) for s, h in zip(size, half, strict=True)]
    u, w = (0.0 if h else f for f, h in zip(focus, grid.held, strict=True))
    if ellipse:
        far = math.hypot(u / max(room[0], 1e-9), w / max(room[1], 1e-9))
        if far > 1.0:
            u, w = u / far, w / far
    u, w = min(max(u, -room[0]), room[0]), min(max(w, -room[1]), room[1])
    return (u, w), (half[0], half[1])


def to_own(center: tuple[float, float, float], heading: float, x: float, z: float) -> Pair:
    """Own axes of a world place."""
    dx, dz = x - center[0], z - center[2]
    c, s = math.cos(heading), math.sin(heading)
    return dx * c - dz * s, dx * s + dz * c


def corners_of(
    centers: NDArray[np.float64], sizes: NDArray[np.float64], headings: NDArray[np.float64]
) -> NDArray[np.float64]:
    """(n, 4, 3) corners in the world of n waters, from (n, 3), (n, 2), (n,)."""
    u = 0.5 * sizes[:, :1] * (1.0, -1.0, -1.0, 1.0)
    w = 0.5 * sizes[:, 1:] * (1.0, 1.0, -1.0, -1.0)
    c, s = np.cos(headings)[:, None], np.sin(headings)[:, None]
    x, z = u * c + w * s, w * c - u * s
    return centers[:, None, :] + np.stack([x, np.zeros_like(x), z], axis=2)


def in_view(corners: NDArray[np.float64], view_projection: NDArray[np.float64]) -> NDArray:
    """(n,) whether a camera may see anything between the corners (n, k, 3) of each."""
    clip = corners @ view_projection[:, :3].T + view_projection[:, 3]
    inside = np.concatenate([clip[..., 3:] + clip[..., :3], clip[..., 3:] - clip[..., :3]], axis=2)
    return np.all(np.any(inside > 0.0, axis=1), axis=1)


def distances(
    centers: NDArray[np.float64], sizes: NDArray[np.float64], headings: NDArray[np.float64],
    position: tuple[float, float, float],
) -> NDArray[np.float64]:  # fmt: skip
    """(n,) metres from a place to the nearest part of each water."""
    d = np.asarray(position) - centers
    c, s = np.cos(headings), np.sin(headings)
    own = np.stack([d[:, 0] * c - d[:, 2] * s, d[:, 0] * s + d[:, 2] * c], axis=1)
    out = np.maximum(np.abs(own) - 0.5 * sizes, 0.0)
    return np.sqrt((out * out).sum(axis=1) + d[:, 1] ** 2)
