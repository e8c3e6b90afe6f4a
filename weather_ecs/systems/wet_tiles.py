"""`WetTiles`: the wet cells of one size, in tiles of 8 by 8 that exist only where it is wet."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.rain_field import area_shares, plain_rows
from weather_ecs.physics.wetness import DRYING, FILM, MM_PER_S, settle

SIDE = 8  # cells on a side of a tile
FINEST, COARSEST = -2, 40  # levels; a cell is 2**level m wide
MOST = 16.0  # mm, more is not kept apart
MOST_TILES = 1024
_CODES = 2**14 - 1  # water is kept as the square root of its share of MOST, in so many steps
_TRACE = 1e-2  # mm, less is dry
_CELLS = 400  # of an area, about
_FAR = 2**31


def level_of(a: float, b: float) -> int:
    """Level of the cells that an area of these radii wets: some hundreds of them."""
    cell = max(math.sqrt(math.pi * a * b / _CELLS), a / 128.0)
    return min(max(round(math.log2(cell)), FINEST), COARSEST)


class WetTiles:
    """Water in mm on cells of 2**level metres; tile (i, j) begins at (8 i, 8 j) cells."""

    def __init__(self, level: int) -> None:
        self.level = level
        self.cell = 2.0**level
        self._places: list[tuple[int, int]] = []
        self._rows: dict[tuple[int, int], int] = {}
        self._codes = np.zeros((0, SIDE, SIDE), np.uint16)  # (tile, along z, along x)
        self._inflow = np.zeros((0, SIDE, SIDE))  # mm/s
        # Shares of the rain by the area's geometry, of the last round and of this one.
        self._known: dict[tuple, _Shares] = {}
        self._used: dict[tuple, _Shares] = {}

    def __len__(self) -> int:
        return len(self._places)

    def rain(self, areas: NDArray, weight: float) -> None:
        """Add the rain of areas (rows of AREA_DTYPE) to what the next `settle` lets fall."""
        for _, center, radii, heading, rate, edge, _ in plain_rows(areas):
            geometry = (center, radii, heading, edge)
            shares = self._used.get(geometry) or self._known.get(geometry)
            if shares is None:
                shares = _Shares(self.cell, *geometry)
            self._used[geometry] = shares
            rows = [self._row(place) for place in shares.places]
            self._inflow[rows] += shares.values * (rate * MM_PER_S * weight)

    def _row(self, place: tuple[int, int]) -> int:
        row = self._rows.get(place)
        if row is None:
            row = self._rows[place] = len(self._places)
            self._places.append(place)
            if row >= len(self._codes):
                more = np.zeros((max(row, 16), SIDE, SIDE))
                self._codes = np.concatenate([self._codes, more.astype(np.uint16)])
                self._inflow = np.concatenate([self._inflow, more])
        return row

    def settle(self, seconds: float) -> None:
        """Let what was added fall for so long, and the rest run off and dry."""
        count = len(self._places)
        inflow = self._inflow[:count]
        rained = inflow.any(axis=(1, 2))
        water = _decode(self._codes[:count])
        wet = rained | (water > FILM).any(axis=(1, 2))
        water *= math.exp(-seconds / DRYING)  # what there is to most of them
        if wet.any():
            before = _decode(self._codes[:count][wet])
            water[wet] = settle(before, inflow[wet], FILM, seconds)
        codes = _encode(water)
        wettest = codes.max(axis=(1, 2), initial=0)
        kept = (wettest > _encode(np.array(_TRACE))) | rained
        if np.count_nonzero(kept) > MOST_TILES:
            order = np.argsort(np.where(kept, wettest.astype(int), -1), kind="stable")
            kept[order[:-MOST_TILES]] = False
        self._take([p for p, keep in zip(self._places, kept, strict=True) if keep], codes[kept])
        self._known, self._used = self._used, {}

    def _take(self, places: list[tuple[int, int]], codes: NDArray[np.uint16]) -> None:
        self._places, self._codes = places, codes
        self._rows = {place: row for row, place in enumerate(places)}
        self._inflow = np.zeros(codes.shape)

    def at(self, x: float, z: float) -> float:
        """mm at a place, between the middles of the four cells around it."""
        u, w = x / self.cell - 0.5, z / self.cell - 0.5
        i, j = math.floor(u), math.floor(w)
        u, w = u - i, w - j
        low = self._cell(i, j) * (1.0 - u) + self._cell(i + 1, j) * u
        high = self._cell(i, j + 1) * (1.0 - u) + self._cell(i + 1, j + 1) * u
        return low * (1.0 - w) + high * w

    def _cell(self, i: int, j: int) -> float:
        row = self._rows.get((i >> 3, j >> 3))
        if row is None:
            return 0.0
        root = self._codes.item(row, j & 7, i & 7) / _CODES
        return root * root * MOST

    def arrays(self) -> tuple[float, NDArray[np.int64], NDArray[np.float32]]:
        """(cell in m, tiles (n, 2), water (n, 8, 8) in mm, rows along z)."""
        places = np.array(self._places, np.int64).reshape(-1, 2)
        return self.cell, places, _decode(self._codes[: len(places)]).astype(np.float32)

    # For snapshots

    def state(self) -> dict[str, Any]:
        """All there is to it, as plain values; neighbours' differences are what compresses."""
        order = sorted(range(len(self._places)), key=self._places.__getitem__)
        values = self._codes[order].reshape(-1).astype(np.int32)
        steps = values.copy()
        steps[1:] -= values[:-1]
        low, high = (steps & 0xFF).astype(np.uint8), (steps >> 8 & 0xFF).astype(np.uint8)
        return {
            "codes": (high.tobytes() + low.tobytes()).hex(),
            "level": self.level,
            "places": [list(self._places[k]) for k in order],
        }

    @classmethod
    def from_state(cls, state: Any) -> WetTiles:
        """The tiles that `state` was taken of. Raises InvalidValueError for anything else."""
        fields = ["codes", "level", "places"]
        if not isinstance(state, dict) or sorted(state) != fields:
            raise InvalidValueError("wetness.tiles", state, f"the fields {fields}")
        level, places, codes = state["level"], state["places"], state["codes"]
        if type(level) is not int or not FINEST <= level <= COARSEST:
            raise InvalidValueError("wetness.level", level, f"{FINEST} to {COARSEST}")
        if not isinstance(places, list) or len(places) > 2 * MOST_TILES:
            raise InvalidValueError("wetness.places", places, f"up to {2 * MOST_TILES} tiles")
        named = [_place(place) for place in places]
        if any(one >= other for one, other in zip(named, named[1:], strict=False)):
            raise InvalidValueError("wetness.places", places, "tiles in order, each once")
        count = len(named) * SIDE * SIDE
        try:
            raw = np.frombuffer(bytes.fromhex(codes), np.uint8)
        except (TypeError, ValueError):
            raise InvalidValueError("wetness.codes", codes, "hexadecimal digits") from None
        if len(raw) != 2 * count:
            raise InvalidValueError("wetness.codes", codes, f"{4 * count} hexadecimal digits")
        steps = raw[count:].astype(np.int64) | raw[:count].astype(np.int64) << 8
        values = np.cumsum(steps) & 0xFFFF
        if int(values.max(initial=0)) > _CODES:
            raise InvalidValueError("wetness.codes", int(values.max()), f"0 to {_CODES}")
        tiles = cls(level)
        tiles._take(named, values.astype(np.uint16).reshape(-1, SIDE, SIDE))
        return tiles


class _Shares:
    """How much of an area's rain falls on which cells."""

    def __init__(
        self,
        cell: float,
        center: tuple[float, float],
        radii: tuple[float, float],
        heading: float,
        edge: float,
    ) -> None:
        (x, z), (a, b) = center, radii
        c, s = math.cos(heading), math.sin(heading)
        u, w, tile = math.hypot(a * c, b * s), math.hypot(a * s, b * c), cell * SIDE
        first = math.floor((x - u) / tile), math.floor((z - w) / tile)
        last = math.floor((x + u) / tile), math.floor((z + w) / tile)
        wide, deep = last[0] - first[0] + 1, last[1] - first[1] + 1
        across = (np.arange(wide * SIDE) + 0.5) * cell + first[0] * tile
        along = (np.arange(deep * SIDE) + 0.5) * cell + first[1] * tile
        shares = area_shares(across, along[:, None], center, radii, heading, edge)
        values = shares.reshape(deep, SIDE, wide, SIDE).swapaxes(1, 2)
        wet = values.any(axis=(2, 3))
        rows, columns = np.nonzero(wet)
        self.places: list[tuple[int, int]] = list(
            zip((columns + first[0]).tolist(), (rows + first[1]).tolist(), strict=True)
        )
        self.values = values[wet]


def _encode(water: NDArray) -> NDArray[np.uint16]:
    share = np.clip(water / MOST, 0.0, 1.0)
    return np.round(np.sqrt(share) * _CODES).astype(np.uint16)


def _decode(codes: NDArray[np.uint16]) -> NDArray[np.float64]:
    root = codes.astype(np.float64) / _CODES
    return root * root * MOST


def _place(value: Any) -> tuple[int, int]:
    good = isinstance(value, list) and len(value) == 2
    if not good or not all(type(n) is int and -_FAR <= n < _FAR for n in value):
        raise InvalidValueError("wetness.places", value, "two whole numbers")
    return value[0], value[1]
