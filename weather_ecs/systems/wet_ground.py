"""`WetGround`: how wet level ground lies under the open sky, in cells of a few metres.

Part of the weather's state: it does not know observers, drawing or shelter, so that a game and its
server have the same. It is brought up to date once a second of weather at most, and where nothing
changes, in one leap whenever somebody asks: the law of `physics.wetness` has a closed form.
"""

from __future__ import annotations

import itertools
import math
from typing import Any

import numpy as np
from numpy.typing import NDArray

from weather_ecs.clock import STEP
from weather_ecs.components import RainArea
from weather_ecs.errors import InvalidValueError
from weather_ecs.frame import AREA_DTYPE, WetnessData, WetTileData, empty
from weather_ecs.physics.rain_field import RainField, plain_rows
from weather_ecs.physics.wetness import FILM, MM_PER_S, settle_one
from weather_ecs.systems.wet_tiles import WetTiles, level_of

TICK = 1.0  # s of weather between two looks at what the areas do
STEPS = round(TICK / STEP)
LONGEST = 60.0  # s that one leap spans at most
SHIFT = 1.5  # cells that an area moves before its rain is entered
CHANGE = 0.02  # of a rain rate, before its rain is entered

_numbers = itertools.count(1)


class WetGround:
    """Water on the ground in mm: tiles as they were at `since`, and the rain that fell after."""

    def __init__(self) -> None:
        self.number = next(_numbers)  # another one for another ground: a snapshot was restored
        self.steps = 0  # fixed steps since the last tick
        self.ticks = 0  # seconds of weather done
        self.since = 0  # the tick the tiles are of
        self.rows = empty(AREA_DTYPE)  # the rain areas since then, those without rain left out
        self.tiles: dict[int, WetTiles] = {}  # by level
        self._field = RainField(self.rows)
        self._levels: tuple[WetTileData, ...] | None = None
        self._data: WetnessData | None = None

    def step(self) -> bool:
        """A fixed step has passed; whether it ends a second, and `tick` is due."""
        self.steps = (self.steps + 1) % STEPS
        return self.steps == 0

    def tick(self, rows: NDArray) -> None:
        """A second has passed, at whose end the areas were these rows of AREA_DTYPE."""
        self.ticks += 1
        rows = rows[rows["rain_rate"] > 0.0]
        pending = self.ticks - self.since
        if alike(self.rows, rows) and pending * TICK < LONGEST:
            return
        self._levels = None
        if not len(self.rows) and not len(rows) and not self.tiles:
            self.since = self.ticks
            return
        gradual = alike(self.rows, rows, 4.0)
        if alike(self.rows, rows) or (gradual and pending <= 4):
            self._enter(_between(self.rows, rows), pending * TICK)
        else:
            if pending > 1:
                self._enter([self.rows], (pending - 1) * TICK)
            self._enter(_between(self.rows, rows) if gradual else [rows], TICK)
        self.since, self.rows = self.ticks, rows
        self._field = RainField(rows)

    def _enter(self, moments: list[NDArray], seconds: float) -> None:
        """Let the mean rain of some moments fall for some seconds."""
        levels = [[level_of(*radii) for radii in rows["radii"].tolist()] for rows in moments]
        for level in sorted({level for found in levels for level in found} | set(self.tiles)):
            tiles = self.tiles.get(level)
            if tiles is None:
                tiles = self.tiles[level] = WetTiles(level)
            for rows, found in zip(moments, levels, strict=True):
                tiles.rain(rows[[k == level for k in found]], 1.0 / len(moments))
            tiles.settle(seconds)
            if not len(tiles):
                del self.tiles[level]

    def at(self, x: float, y: float, z: float, rate: float, time: float) -> float:
        """mm at a place at the clock's `time`, where it rains at `rate` mm/h now."""
        water = 0.0
        for tiles in self.tiles.values():
            more = tiles.at(x, z)
            water += more - min(water, FILM) * min(more, FILM) / FILM
        waited = (self.ticks - self.since) * TICK
        if waited > 0.0 and (water > 0.0 or self._field):
            before = self._field.rate(x, y, z) * MM_PER_S
            water = settle_one(water, before, FILM, waited)
        rest = time - self.ticks * TICK
        if rest > 0.0 and (water > 0.0 or rate > 0.0):
            water = settle_one(water, rate * MM_PER_S, FILM, rest)
        return water

    def data(self) -> WetnessData:
        """What the GPU's own map begins with; the same object within one second."""
        if self._data is None or self._data.ticks != self.ticks:
            if self._levels is None:
                self._levels = tuple(tiles.data() for tiles in self.tiles.values())
            waited = (self.ticks - self.since) * TICK
            self._data = WetnessData(self.number, self.ticks, self._levels, waited, self.rows)
        return self._data

    # For snapshots

    def state(self) -> dict[str, Any]:
        """All there is to it, as plain values."""
        return {
            "rows": [list(row) for row in plain_rows(self.rows)],
            "since": self.since,
            "steps": self.steps,
            "ticks": self.ticks,
            "tiles": [tiles.state() for _, tiles in sorted(self.tiles.items())],
        }

    @classmethod
    def from_state(cls, state: Any) -> WetGround:
        """The ground that `state` was taken of. Raises InvalidValueError for anything else."""
        fields = ["rows", "since", "steps", "ticks", "tiles"]
        if not isinstance(state, dict) or sorted(state) != fields:
            raise InvalidValueError("wetness", state, f"the fields {fields}")
        ground = cls()
        ground.steps = _count("wetness.steps", state["steps"], STEPS - 1)
        ground.ticks = _count("wetness.ticks", state["ticks"], 2**53)
        ground.since = _count("wetness.since", state["since"], ground.ticks)
        ground.rows = _rows(state["rows"])
        ground._field = RainField(ground.rows)
        if not isinstance(state["tiles"], list):
            raise InvalidValueError("wetness.tiles", state["tiles"], "a list")
        for each in state["tiles"]:
            tiles = WetTiles.from_state(each)
            if ground.tiles and tiles.level <= max(ground.tiles):
                raise InvalidValueError("wetness.level", tiles.level, "levels in order, each once")
            ground.tiles[tiles.level] = tiles
        return ground


def alike(rows: NDArray, others: NDArray, tolerance: float = 1.0) -> bool:
    """Whether the ground cannot tell one set of areas from another."""
    if len(rows) != len(others):
        return False
    for name in ("key", "radii", "heading", "soft_edge", "ceiling"):
        if not np.array_equal(rows[name], others[name]):
            return False
    for one, other in zip(plain_rows(rows), plain_rows(others), strict=True):
        (_, (x, z), radii, _, rate, *_), (_, (u, w), _, _, other_rate, *_) = one, other
        if math.hypot(x - u, z - w) > tolerance * SHIFT * 2.0 ** level_of(*radii):
            return False
        if abs(rate - other_rate) > tolerance * CHANGE * max(rate, other_rate):
            return False
    return True


def _between(rows: NDArray, others: NDArray) -> list[NDArray]:
    """The moments that stand for the time between two: one where nothing has moved."""
    if np.array_equal(rows, others):
        return [rows]
    return [rows, others]


def _count(field: str, value: Any, most: int) -> int:
    if type(value) is not int or not 0 <= value <= most:
        raise InvalidValueError(field, value, f"a whole number in [0, {most}]")
    return value


def _rows(values: Any) -> NDArray:
    """Areas out of a snapshot; each is checked as the component checks its own."""
    if not isinstance(values, list):
        raise InvalidValueError("wetness.rows", values, "a list")
    found = []
    for value in values:
        if not isinstance(value, list) or len(value) != len(AREA_DTYPE.names or ()):
            raise InvalidValueError("wetness.rows", value, "seven values each")
        key, center, radii, heading, rate, edge, ceiling = value
        a = RainArea(center, radii, rate, heading, edge, ceiling)
        _count("wetness.rows", key, 2**53)
        found.append((key, a.center, a.radii, a.heading, a.rain_rate, a.soft_edge, a.ceiling))
    rows = np.array(found, AREA_DTYPE) if found else empty(AREA_DTYPE)
    if len(rows) and not (np.all(rows["rain_rate"] > 0.0) and np.all(np.diff(rows["key"]) > 0)):
        raise InvalidValueError("wetness.rows", values, "raining areas in order, each once")
    rows.setflags(write=False)
    return rows
