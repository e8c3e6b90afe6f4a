"""`WetTiles`: the cells of one size on which water or snow lies, in tiles of 8 by 8.

They exist only where there is any, and those on which no rain falls are put to rest.
"""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.ground_law import WATER, GroundLaw
from weather_ecs.physics.rain_field import plain_rows
from weather_ecs.physics.wetness import FILM, MM_PER_S
from weather_ecs.systems.wet_codes import expected, surprises
from weather_ecs.systems.wet_rest import TRACE, Resting, packed, raw_bytes, unpacked
from weather_ecs.systems.wet_shares import SIDE, Fallen, Patterns, Shape, moments

FINEST, COARSEST = -2, 40  # levels; a cell is 2**level m wide
MOST_TILES = 1024
_CELLS = 256  # of an area, about
_PATCH = SIDE + 1


def level_of(a: float, b: float) -> int:
    """Level of the cells that an area of these radii wets: some hundreds of them."""
    cell = max(math.sqrt(math.pi * a * b / _CELLS), a / 128.0)
    return min(max(round(math.log2(cell)), FINEST), COARSEST)


class WetTiles:
    """Water in mm on cells of 2**level metres; tile (i, j) begins at (8 i, 8 j) cells.

    `law` says what becomes of it, and how exactly it is kept; a later one replaces it.
    """

    def __init__(self, level: int, law: GroundLaw = WATER) -> None:
        self.law = law
        self._steps = 2 ** (8 * law.planes - 2) - 1
        self.level = level
        self.cell = 2.0**level
        self._places: list[tuple[int, int]] = []
        self._rows: dict[tuple[int, int], int] = {}
        self._codes = np.zeros((0, SIDE, SIDE), np.uint32)  # (tile, along z, along x)
        self._inflow = np.zeros((0, SIDE, SIDE))  # mm/s
        self._patterns = Patterns(self.cell)
        self._resting = Resting()
        self._patches: dict[tuple[int, int], list[float]] = {}  # that somebody has asked about

    def __len__(self) -> int:
        return len(self._places) + len(self._resting.tiles)

    def rain(self, areas: NDArray, weight: float = 1.0) -> None:
        """Add the rain of standing areas (AREA_DTYPE) to what the next `settle` lets fall."""
        for _, center, radii, heading, rate, edge, _ in plain_rows(areas):
            fallen = self._patterns.standing(center, Shape(radii, heading, edge))
            self._add(fallen, rate * MM_PER_S * weight)

    def rain_along(
        self, first: NDArray, last: NDArray, since: float, until: float, weight: float
    ) -> None:
        """The same of areas on their way; the times are seconds before the next settle ends.

        What has fallen long ago counts less, as the law has it.
        """
        pairs = zip(plain_rows(first), plain_rows(last), strict=True)
        for (_, start, radii, heading, rate, edge, _), (_, end, _, _, then, *_) in pairs:
            way = math.dist(start, end)
            count = moments(way, self.cell, edge)
            at = (np.arange(count) + 0.5) / count
            amounts = (rate + (then - rate) * at) * self.law.kept(since + (until - since) * at)
            points = np.array(start) + np.subtract(end, start) * at[:, None]
            weights = amounts * (MM_PER_S * weight * (since - until) / count)
            self._add(self._patterns.swept(Shape(radii, heading, edge), points, weights), 1.0)

    def _add(self, fallen: Fallen, factor: float) -> None:
        rows = [self._row(place) for place in fallen.places]
        self._inflow[rows] += fallen.amounts * factor

    def copy(self) -> WetTiles:
        """Another one of the same water; patterns are shared."""
        tiles = WetTiles(self.level, self.law)
        tiles._patterns = self._patterns
        tiles._take(list(self._places), self._codes[: len(self._places)].copy())
        tiles._resting = self._resting.copy()
        return tiles

    def _row(self, place: tuple[int, int]) -> int:
        row = self._rows.get(place)
        if row is None:
            row = self._rows[place] = len(self._places)
            self._places.append(place)
            if row >= len(self._codes):
                more = np.zeros((max(row, 16), SIDE, SIDE))
                self._codes = np.concatenate([self._codes, more.astype(np.uint32)])
                self._inflow = np.concatenate([self._inflow, more])
            lain = self._resting.take(place)
            if lain is not None:
                self._codes[row] = self._encode(lain)
        return row

    def settle(self, seconds: float) -> None:
        """Let what was added fall for so long, and the rest run off and dry."""
        count = len(self._places)
        inflow = self._inflow[:count]
        rained = inflow.any(axis=(1, 2))
        before = self._decode(self._codes[:count])
        water, falls = self.law.rest(before, seconds)
        falls |= rained
        if falls.any():
            water[falls] = self.law.settle(before[falls], inflow[falls], seconds)
        self._resting.pass_time(seconds, MOST_TILES)
        wettest = water.max(axis=(1, 2), initial=0.0)
        kept = (wettest > TRACE) | rained
        if self.law.rests:
            rests = kept & ~rained & (wettest <= FILM)
            self._resting.put([self._places[k] for k in np.flatnonzero(rests)], water[rests])
            kept &= ~rests
        codes = self._encode(water)
        if np.count_nonzero(kept) > MOST_TILES:
            order = sorted(np.flatnonzero(kept), key=lambda k: (wettest[k], self._places[k]))
            kept[order[:-MOST_TILES]] = False
        self._take([p for p, keep in zip(self._places, kept, strict=True) if keep], codes[kept])

    def next_round(self) -> None:
        """Forget the patterns of areas that are no more."""
        self._patterns.next_round()

    def _take(self, places: list[tuple[int, int]], codes: NDArray[np.uint32]) -> None:
        self._places, self._codes = places, codes
        self._rows = {place: row for row, place in enumerate(places)}
        self._inflow = np.zeros(codes.shape)
        self._patches = {}

    def at(self, x: float, z: float) -> float:
        """mm at a place, between the middles of the four cells around it."""
        u, w = x / self.cell - 0.5, z / self.cell - 0.5
        i, j = math.floor(u), math.floor(w)
        place = i >> 3, j >> 3
        patch = self._patches.get(place)
        if patch is None:
            patch = self._patch(place)
        if not patch:
            return 0.0
        u, w, k = u - i, w - j, (j & 7) * _PATCH + (i & 7)
        low = patch[k] * (1.0 - u) + patch[k + 1] * u
        high = patch[k + _PATCH] * (1.0 - u) + patch[k + _PATCH + 1] * u
        return low * (1.0 - w) + high * w

    def many(self, x: NDArray, z: NDArray) -> NDArray[np.float64]:
        """`at` for many places (n,)."""
        u, w = x / self.cell - 0.5, z / self.cell - 0.5
        i, j = np.floor(u).astype(np.int64), np.floor(w).astype(np.int64)
        places, patch_of = np.unique(((i >> 3) << 32) + (j >> 3) + (1 << 31), return_inverse=True)
        table = np.zeros((len(places), _PATCH * _PATCH))
        for row, place in zip(table, places.tolist(), strict=True):
            patch = self._patch((place >> 32, (place & (1 << 32) - 1) - (1 << 31)))
            if patch:
                row[:] = patch
        u, w, k = u - i, w - j, (j & 7) * _PATCH + (i & 7)
        low = table[patch_of, k] * (1.0 - u) + table[patch_of, k + 1] * u
        k += _PATCH
        high = table[patch_of, k] * (1.0 - u) + table[patch_of, k + 1] * u
        return np.asarray(low * (1.0 - w) + high * w)

    def _patch(self, place: tuple[int, int]) -> list[float]:
        """mm on the cells of a tile and the first ones beyond, rows along z; of a dry one none."""
        patch = self._patches.get(place)
        if patch is None:
            if len(self._patches) > MOST_TILES:
                self._patches.clear()
            i, j = place
            water = np.zeros((_PATCH, _PATCH))
            water[:SIDE, :SIDE] = self._tile((i, j))
            water[:SIDE, SIDE] = self._tile((i + 1, j))[:, 0]
            water[SIDE, :SIDE] = self._tile((i, j + 1))[0]
            water[SIDE, SIDE] = self._tile((i + 1, j + 1))[0, 0]
            patch = self._patches[place] = water.ravel().tolist() if water.any() else []
        return patch

    def _tile(self, place: tuple[int, int]) -> NDArray[np.float64]:
        row = self._rows.get(place)
        return self._resting.tile(place) if row is None else self._decode(self._codes[row])

    def arrays(self) -> tuple[float, NDArray[np.int64], NDArray[np.float32]]:
        """(cell in m, tiles (n, 2), water (n, 8, 8) in mm, rows along z)."""
        places = np.array([*self._places, *self._resting.tiles], np.int64).reshape(-1, 2)
        water = self._decode(self._codes[: len(self._places)])
        both = np.concatenate([water, self._resting.water()])
        return self.cell, places, both.astype(np.float32)

    def _encode(self, water: NDArray) -> NDArray[np.uint32]:
        share = np.clip(water / self.law.most, 0.0, 1.0)
        return np.round(np.sqrt(share) * self._steps).astype(np.uint32)

    def _decode(self, codes: NDArray[np.uint32]) -> NDArray[np.float64]:
        root = codes.astype(np.float64) / self._steps
        return root * root * self.law.most

    # For snapshots

    def state(self) -> dict[str, Any]:
        """All there is to it, as plain values."""
        order = sorted(range(len(self._places)), key=self._places.__getitem__)
        places = [self._places[k] for k in order]
        return {
            "codes": surprises(places, self._codes[order], self.law.planes).hex(),
            "level": self.level,
            "places": packed(places),
            "resting": self._resting.state(),
        }

    @classmethod
    def from_state(cls, state: Any, law: GroundLaw = WATER) -> WetTiles:
        """The tiles that `state` was taken of. Raises InvalidValueError for anything else."""
        fields = ["codes", "level", "places", "resting"]
        if not isinstance(state, dict) or sorted(state) != fields:
            raise InvalidValueError("wetness.tiles", state, f"the fields {fields}")
        level = state["level"]
        if type(level) is not int or not FINEST <= level <= COARSEST:
            raise InvalidValueError("wetness.level", level, f"{FINEST} to {COARSEST}")
        places = unpacked("wetness.places", state["places"], MOST_TILES)
        raw = raw_bytes(state["codes"], law.planes * len(places) * SIDE * SIDE)
        codes = expected(places, raw, law.planes)
        tiles = cls(level, law)
        if int(codes.max(initial=0)) > tiles._steps:
            raise InvalidValueError("wetness.codes", int(codes.max()), f"0 to {tiles._steps}")
        tiles._take(places, codes)
        tiles._resting = Resting.from_state(state["resting"], MOST_TILES)
        if (not law.rests and tiles._resting.tiles) or tiles._rows.keys() & tiles._resting.tiles:
            raise InvalidValueError("wetness.resting", state["resting"], "other tiles, of water")
        return tiles
