"""Light of lamps and flashes at points, in plain numbers and for many points at once."""

from __future__ import annotations

import math
from collections.abc import Sequence

import numpy as np
from numpy.typing import NDArray

_CELL = 8.0  # m, of the grid by which lamps are found
_OVER_CELL = 1.0 / _CELL
_KEPT = 16384  # cells whose lamps are remembered

Lamp = tuple[float, float, float, float, float]  # x, y, z, reach in m, luminance


class Lamps:
    """Point lights; each falls off as (1 - (d / reach)^2)^2 and ends at its reach."""

    def __init__(self, lamps: Sequence[Lamp]) -> None:
        self._lamps = [(x, y, z, reach * reach, light) for x, y, z, reach, light in lamps]
        self._reaches = [lamp[3] for lamp in lamps]
        self._near: dict[tuple[int, int], list[Lamp]] = {}

    def at(self, x: float, y: float, z: float) -> float:
        """Luminance at a point."""
        if not self._lamps:
            return 0.0
        place = math.floor(x * _OVER_CELL), math.floor(z * _OVER_CELL)
        near = self._near.get(place)
        if near is None:
            near = self._gather(place)
        total = 0.0
        for lx, ly, lz, reach2, light in near:
            dx, dy, dz = x - lx, y - ly, z - lz
            left = 1.0 - (dx * dx + dy * dy + dz * dz) / reach2
            if left > 0.0:
                total += light * left * left
        return total

    def many(self, x: NDArray, y: NDArray, z: NDArray) -> NDArray[np.float64]:
        """`at` for many points (n,)."""
        total = np.zeros(len(x))
        for (lx, ly, lz, reach2, light), reach in zip(self._lamps, self._reaches, strict=True):
            here = np.flatnonzero((np.abs(x - lx) < reach) & (np.abs(z - lz) < reach))
            if len(here):
                dx, dy, dz = x[here] - lx, y[here] - ly, z[here] - lz
                left = 1.0 - (dx * dx + dy * dy + dz * dz) / reach2
                total[here] += light * np.square(np.maximum(left, 0.0))
        return total

    def _gather(self, place: tuple[int, int]) -> list[Lamp]:
        """The lamps whose light reaches into a cell."""
        if len(self._near) > _KEPT:
            self._near.clear()
        x, z = (place[0] + 0.5) * _CELL, (place[1] + 0.5) * _CELL
        found = [
            lamp
            for lamp, reach in zip(self._lamps, self._reaches, strict=True)
            if abs(lamp[0] - x) <= reach + _CELL and abs(lamp[2] - z) <= reach + _CELL
        ]
        self._near[place] = found
        return found
