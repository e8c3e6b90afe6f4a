"""`Resting`: tiles on which no rain falls any more and nothing runs off: all that they do is dry.

A film dries by the same share in the same time, so that a tile is put down once, in small codes,
with the time it was put down, and not touched again until it rains on it or it is dry.
"""

from __future__ import annotations

import math
from collections.abc import Iterable
from typing import Any, NamedTuple

import numpy as np
from numpy.typing import NDArray

from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.wetness import DRYING, FILM
from weather_ecs.systems.wet_codes import Place, expected, surprises

TRACE = 1e-2  # mm, less is dry
FINENESS = 0.025  # of the logarithm of mm, of one code: 1.3 % either way
DRIEST = 0.5 * TRACE  # mm, of code 1
LARGEST_CODE = 1 + math.ceil(math.log(FILM / DRIEST) / FINENESS)
LONGEST = math.ceil(DRYING * math.log(2.0 * FILM / TRACE)) + 1  # s after which all of it is dry

# mm by code.
_WATER = DRIEST * np.exp(FINENESS * (np.arange(256) - 1.0))
_WATER[0] = 0.0


class Tile(NamedTuple):
    """One tile as it was put down."""

    codes: NDArray[np.uint8]  # (8, 8)
    since: float  # s
    dry: float  # s, when there is only a trace left


class Resting:
    """Tiles by place, (i, j), and the time in s that has passed over them."""

    def __init__(self) -> None:
        self.now = 0.0
        self.tiles: dict[Place, Tile] = {}

    def copy(self) -> Resting:
        """Another one with the same tiles."""
        other = Resting()
        other.now, other.tiles = self.now, self.tiles.copy()
        return other

    def put(self, places: list[Place], water: NDArray[np.float64]) -> None:
        """Put tiles down; water (n, 8, 8) in mm, at most a film."""
        with np.errstate(divide="ignore"):
            codes = np.round(np.log(water / DRIEST) / FINENESS) + 1.0
        codes = np.clip(codes, 0.0, LARGEST_CODE).astype(np.uint8)
        for place, each in zip(places, codes, strict=True):
            self._add(place, each, self.now)

    def _add(self, place: Place, codes: NDArray[np.uint8], since: float) -> None:
        most = float(_WATER[codes.max()])
        if most > TRACE:
            lasts = math.ceil(DRYING * math.log(most / TRACE))
            self.tiles[place] = Tile(codes, since, since + lasts)

    def take(self, place: Place) -> NDArray[np.float64] | None:
        """Take a tile up again: mm (8, 8)."""
        tile = self.tiles.pop(place, None)
        return None if tile is None else _WATER[tile.codes] * self._left(tile)

    def _left(self, tile: Tile) -> float:
        return math.exp((tile.since - self.now) / DRYING)

    def tile(self, place: Place) -> NDArray[np.float64]:
        """mm (8, 8) of a tile, rows along z; 0 where none rests."""
        tile = self.tiles.get(place)
        return np.zeros((8, 8)) if tile is None else _WATER[tile.codes] * self._left(tile)

    def water(self) -> NDArray[np.float64]:
        """mm (n, 8, 8) of all tiles, in the order they are in."""
        if not self.tiles:
            return np.zeros((0, 8, 8))
        codes = np.array([tile.codes for tile in self.tiles.values()])
        left = np.array([self._left(tile) for tile in self.tiles.values()])
        return _WATER[codes] * left[:, None, None]

    def pass_time(self, seconds: float, most: int) -> None:
        """Let time pass; what is dry goes, and beyond `most` tiles those that dry first."""
        self.now += seconds
        gone = [place for place, tile in self.tiles.items() if tile.dry <= self.now]
        for place in gone:
            del self.tiles[place]
        if len(self.tiles) > most:
            order = sorted(self.tiles, key=lambda place: (self.tiles[place].dry, place))
            for place in order[: len(order) - most]:
                del self.tiles[place]

    # For snapshots

    def state(self) -> dict[str, Any]:
        """All there is to it, as plain values."""
        order = sorted(self.tiles)
        tiles = [self.tiles[place] for place in order]
        ages = [round(self.now - tile.since) for tile in tiles]
        codes = np.array([tile.codes for tile in tiles], np.uint8).reshape(-1, 8, 8)
        return {
            "ages": steps(ages),
            "codes": surprises(order, codes, 1).hex(),
            "places": packed(order),
        }

    @classmethod
    def from_state(cls, state: Any, most: int) -> Resting:
        """What `state` was taken of. Raises InvalidValueError for anything else."""
        fields = ["ages", "codes", "places"]
        if not isinstance(state, dict) or sorted(state) != fields:
            raise InvalidValueError("wetness.resting", state, f"the fields {fields}")
        found = cls()
        places = unpacked("wetness.resting", state["places"], most)
        ages = state["ages"]
        good = isinstance(ages, list) and all(type(age) is int for age in ages)
        if not good or len(ages) != len(places):
            raise InvalidValueError("wetness.ages", ages, "a whole number for each tile")
        ages = np.cumsum(np.clip(ages, -LONGEST, LONGEST)).tolist()
        if not all(0 <= age <= LONGEST for age in ages):
            raise InvalidValueError("wetness.ages", state["ages"], f"ages of 0 to {LONGEST} s")
        codes = expected(places, raw_bytes(state["codes"], 64 * len(places)), 1)
        if int(codes.max(initial=0)) > LARGEST_CODE:
            raise InvalidValueError("wetness.codes", int(codes.max()), f"0 to {LARGEST_CODE}")
        for place, each, age in zip(places, codes, ages, strict=True):
            found._add(place, each.astype(np.uint8), -float(age))
            if place not in found.tiles or found.tiles[place].dry <= 0.0:
                raise InvalidValueError("wetness.resting", list(place), "tiles that are wet")
        return found


def steps(values: Iterable[int]) -> list[int]:
    """Differences of neighbours, which are what compresses."""
    return np.diff(np.array(list(values), np.int64), prepend=0).tolist()


def packed(places: list[Place]) -> list[list[int]]:
    """Places in order as two lists of differences."""
    return [steps(i for i, _ in places), steps(j for _, j in places)]


def unpacked(field: str, value: Any, most: int) -> list[Place]:
    """The inverse of `packed`, checked."""
    allowed = f"two lists of up to {most} whole numbers"
    if not isinstance(value, list) or len(value) != 2:
        raise InvalidValueError(field, value, allowed)
    for each in value:
        good = isinstance(each, list) and len(each) <= most
        if not good or not all(type(n) is int and abs(n) <= 2**32 for n in each):
            raise InvalidValueError(field, value, allowed)
    first, second = (np.cumsum(np.array(each, np.int64)).tolist() for each in value)
    if len(first) != len(second):
        raise InvalidValueError(field, value, "two lists of the same length")
    places = list(zip(first, second, strict=True))
    if any(one >= other for one, other in zip(places, places[1:], strict=False)):
        raise InvalidValueError(field, value, "tiles in order, each once")
    if any(not -(2**31) <= n < 2**31 for place in places for n in place):
        raise InvalidValueError(field, value, "tiles of this world")
    return places


def raw_bytes(value: Any, count: int) -> NDArray[np.uint8]:
    """`count` bytes out of hexadecimal digits."""
    try:
        raw = np.frombuffer(bytes.fromhex(value), np.uint8)
    except (TypeError, ValueError):
        raise InvalidValueError("wetness.codes", value, "hexadecimal digits") from None
    if len(raw) != count:
        raise InvalidValueError("wetness.codes", value, f"{2 * count} hexadecimal digits")
    return raw
