"""The rain rate at one point, in plain numbers: a game asks for thousands of points a frame.

The formula is `physics.ellipse.edge_factor` times the area's rate, summed over the areas.
"""

from __future__ import annotations

import math
from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from .front import NO_FRONTS, SETTLED, Dry, water_arrived


class RainField:
    """Rain areas (rows of `frame.AREA_DTYPE`), prepared to answer for any point.

    `fronts`: by the area's key the spells of `physics.front`, where rain begins or ends.
    """

    __slots__ = ("_areas", "_fronts", "_keys")

    def __init__(self, areas: NDArray, fronts: Mapping[int, Dry] = NO_FRONTS) -> None:
        rows = plain_rows(areas[areas["rain_rate"] > 0.0])
        # Of what has not all come down: the spells and the whole rate.
        self._fronts = [(fronts.get(row[0], SETTLED), row[4]) for row in rows] if fronts else []
        self._keys = [row[0] for row in rows]
        self._areas = [
            (*center, math.cos(heading), math.sin(heading), *radii, rate, min(edge, radii[1]), top)
            for _, center, radii, heading, rate, edge, top in rows
        ]

    def __bool__(self) -> bool:
        return bool(self._areas)

    def rate(self, x: float, y: float, z: float) -> float:
        """mm/h at a point in the open: the areas' rates, each falling off over its soft edge."""
        if self._fronts:
            return sum(self._arrived(x, y, z))
        total, hypot = 0.0, math.hypot
        for cx, cz, cos, sin, a, b, rate, edge, top in self._areas:
            dx, dz = x - cx, z - cz
            u, w = (dx * cos - dz * sin) / a, (dx * sin + dz * cos) / b
            rho = hypot(u, w)
            if rho < 1.0 and y < top:
                if edge > 0.0:
                    slope = hypot(u / a, w / b)
                    share = (1.0 - rho) * (rho / slope if slope > 0.0 else b) / edge
                    if share < 1.0:
                        rate *= share * share * (3.0 - 2.0 * share)
                total += rate
        return total

    def many(self, x: NDArray, y: NDArray, z: NDArray) -> NDArray[np.float64]:
        """`rate` at many points (n,)."""
        total = np.zeros(len(x))
        fronts = self._fronts or [(SETTLED, 0.0)] * len(self._areas)
        for area, (dry, full) in zip(self._areas, fronts, strict=True):
            cx, cz, cos, sin, a, b, rate, edge, top = area
            here = np.flatnonzero((np.hypot(x - cx, z - cz) <= 1.000001 * a) & (y < top))
            if not len(here):
                continue
            falls = rate * turned_shares(x[here] - cx, z[here] - cz, (cos, sin), (a, b), edge)
            if dry != SETTLED:
                falls *= water_arrived(top - y[here], dry, full)
            total[here] += falls
        return total

    def rates(self, x: float, y: float, z: float) -> dict[int, float]:
        """The same by area: mm/h under the area's key."""
        rates = self._arrived(x, y, z) if self._fronts else self._rates(x, y, z)
        return dict(zip(self._keys, rates, strict=True))

    def _arrived(self, x: float, y: float, z: float) -> Iterator[float]:
        """The areas' rates, less what has not come down yet or is all down already."""
        each = zip(self._rates(x, y, z), self._fronts, self._areas, strict=True)
        for rate, (dry, full), (*_, top) in each:
            if rate > 0.0 and dry != SETTLED:
                rate *= float(water_arrived(top - y, dry, full))
            yield rate

    def _rates(self, x: float, y: float, z: float) -> Iterator[float]:
        hypot = math.hypot
        for cx, cz, cos, sin, a, b, rate, edge, top in self._areas:
            dx, dz = x - cx, z - cz
            u = (dx * cos - dz * sin) / a
            w = (dx * sin + dz * cos) / b
            rho = hypot(u, w)
            if rho >= 1.0 or y >= top:
                yield 0.0
                continue
            if edge > 0.0:
                slope = hypot(u / a, w / b)
                share = (1.0 - rho) * (rho / slope if slope > 0.0 else b) / edge
                if share < 1.0:
                    rate *= share * share * (3.0 - 2.0 * share)
            yield rate

    def covers(self, x: float, z: float) -> bool:
        """Whether a place lies inside any of the areas (f < 1)."""
        for cx, cz, cos, sin, a, b, *_ in self._areas:
            dx, dz = x - cx, z - cz
            if math.hypot((dx * cos - dz * sin) / a, (dx * sin + dz * cos) / b) < 1.0:
                return True
        return False


def area_shares(
    x: NDArray,
    z: NDArray,
    center: tuple[float, float],
    radii: tuple[float, float],
    heading: float,
    edge: float,
) -> NDArray[np.float64]:
    """Share of an area's rain at many places, x and z broadcast; nothing is checked."""
    turn = math.cos(heading), math.sin(heading)
    return turned_shares(x - center[0], z - center[1], turn, radii, edge)


def turned_shares(
    dx: NDArray, dz: NDArray, turn: tuple[float, float], radii: tuple[float, float], edge: float
) -> NDArray[np.float64]:
    """The same by the way from the centre, and the cosine and sine of the heading."""
    (c, s), (a, b) = turn, radii
    u, w = (dx * c - dz * s) / a, (dx * s + dz * c) / b
    rho = np.hypot(u, w)
    if edge <= 0.0:
        return np.where(rho < 1.0, 1.0, 0.0)
    slope = np.hypot(u / a, w / b)
    with np.errstate(divide="ignore", invalid="ignore", over="ignore"):
        span = np.where(slope > 0.0, rho / slope, b)
        share = np.clip((1.0 - rho) * span / min(edge, b), 0.0, 1.0)
    return share * share * (3.0 - 2.0 * share)


def plain_rows(rows: NDArray) -> list[tuple[Any, ...]]:
    """Rows of a structured array as tuples of plain numbers, and of tuples of them."""
    columns = [rows[name].tolist() for name in rows.dtype.names or ()]
    nested = [[tuple(v) for v in c] if c and isinstance(c[0], list) else c for c in columns]
    return list(zip(*nested, strict=True))
