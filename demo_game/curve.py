"""Smooth curves through given values, for the camera's way: monotone cubics and a path."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

SPACING = 0.05  # m between the points of a path's table


class Smooth:
    """Cubic through (at, values) that never overshoots (Fritsch and Carlson 1980)."""

    def __init__(self, at: Sequence[float], values: Sequence[float]) -> None:
        self._at = np.asarray(at, np.float64)
        self._values = np.asarray(values, np.float64)
        if len(self._at) < 2 or not (np.diff(self._at) > 0.0).all():
            raise ValueError("at: allowed: two or more values, rising")
        self._slopes = self._monotone_slopes()

    def _monotone_slopes(self) -> NDArray[np.float64]:
        width = np.diff(self._at)
        rise = np.diff(self._values) / width
        slopes = np.zeros(len(self._at))  # at rest at both ends
        left, right = rise[:-1], rise[1:]
        together = left * right > 0.0
        weight_left = 2 * width[1:] + width[:-1]
        weight_right = width[1:] + 2 * width[:-1]
        safe_left = np.where(together, left, 1.0)
        safe_right = np.where(together, right, 1.0)
        mean = (weight_left + weight_right) / (weight_left / safe_left + weight_right / safe_right)
        slopes[1:-1] = np.where(together, mean, 0.0)
        return slopes

    def __call__(self, at: float) -> float:
        """The value at `at`; held at the ends beyond them."""
        at = min(max(at, float(self._at[0])), float(self._at[-1]))
        index = min(int(np.searchsorted(self._at, at, "right")) - 1, len(self._at) - 2)
        index = max(index, 0)
        width = float(self._at[index + 1] - self._at[index])
        t = (at - float(self._at[index])) / width
        p0, p1 = float(self._values[index]), float(self._values[index + 1])
        m0, m1 = float(self._slopes[index]) * width, float(self._slopes[index + 1]) * width
        return (
            (2 * t**3 - 3 * t**2 + 1) * p0
            + (t**3 - 2 * t**2 + t) * m0
            + (3 * t**2 - 2 * t**3) * p1
            + (t**3 - t**2) * m1
        )


class Path:
    """A rounded line through points (x, z), by the length walked along it."""

    def __init__(self, points: Sequence[tuple[float, float]], rounding: float = 1.5) -> None:
        corners = np.asarray(points, np.float64)
        if corners.ndim != 2 or len(corners) < 2:
            raise ValueError("points: allowed: two or more (x, z)")
        lengths = np.hypot(*np.diff(corners, axis=0).T)
        self.corner_lengths = np.concatenate(([0.0], np.cumsum(lengths)))
        self.length = float(self.corner_lengths[-1])
        count = max(2, round(self.length / SPACING) + 1)
        self._at = np.linspace(0.0, self.length, count)
        x = np.interp(self._at, self.corner_lengths, corners[:, 0])
        z = np.interp(self._at, self.corner_lengths, corners[:, 1])
        self._x, self._z = rounded(x, rounding), rounded(z, rounding)

    def __call__(self, along: float) -> tuple[float, float]:
        """(x, z) after `along` metres."""
        x = float(np.interp(along, self._at, self._x))
        return x, float(np.interp(along, self._at, self._z))

    @property
    def table(self) -> NDArray[np.float64]:
        """Points of the path at even lengths: columns length, x, z."""
        return np.stack((self._at, self._x, self._z), axis=1)


def rounded(values: NDArray[np.float64], width: float) -> NDArray[np.float64]:
    """Values at SPACING along a path, averaged over `width` metres, both ends held."""
    half = round(width / SPACING / 2)
    if half < 1:
        return values
    kernel = np.hanning(2 * half + 3)[1:-1]
    kernel /= kernel.sum()
    # Odd reflection keeps the end points where they are.
    head = 2 * values[0] - values[half:0:-1] if len(values) > half else np.full(half, values[0])
    tail = (
        2 * values[-1] - values[-2 : -half - 2 : -1]
        if len(values) > half
        else np.full(half, values[-1])
    )
    return np.convolve(np.concatenate((head, values, tail)), kernel, "valid")
