"""`WetLevel`: the ground under areas of about one size, and what has rained on it since."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from weather_ecs.components import RainArea
from weather_ecs.errors import InvalidValueError
from weather_ecs.frame import AREA_DTYPE, WetTileData, empty
from weather_ecs.physics.ground_law import WATER, GroundLaw
from weather_ecs.physics.rain_field import RainField, plain_rows
from weather_ecs.physics.wetness import MM_PER_S
from weather_ecs.systems.wet_tiles import WetTiles

TICK = 1.0  # s of weather between two looks at what the areas do
LONGEST = 60  # ticks that one leap spans at most
GRADUAL = 4  # ticks over which a change counts as a steady one
SHIFT = 2.0  # cells that an area moves before its rain is entered
CHANGE = 0.02  # of a rain rate, before its rain is entered
FASTEST_MELT = 1.0  # mm/s
NO_AREAS = empty(AREA_DTYPE)


class WetLevel:
    """Water on the ground in mm: tiles as they were at `since`, and the rain that fell after.

    Or snow, by its law: the law's melt, too, is that since then.
    """

    def __init__(self, level: int, since: int, law: GroundLaw = WATER) -> None:
        self.tiles = WetTiles(level, law)
        self.since = since  # the tick the tiles are of
        self.rows = NO_AREAS  # the raining areas since then
        self._field = RainField(NO_AREAS)
        self._data: WetTileData | None = None

    def tick(self, rows: NDArray, ticks: int, law: GroundLaw = WATER) -> None:
        """A tick has passed, at whose end the areas were these rows of AREA_DTYPE."""
        pending = ticks - self.since
        if not self.tiles.law.alike(law):
            if pending > 1:
                self._enter([self.rows], pending - 1)
                pending, self.since = 1, ticks - 1
            self.tiles.law, self._data = law, None
        same = rows is self.rows or self._alike(rows)
        if same and pending < LONGEST:
            return
        gradual = same or self._alike(rows, 4.0)
        if same or (gradual and pending <= GRADUAL):
            self._enter(self._until(rows), pending)
        else:
            if pending > 1:
                self._enter([self.rows], pending - 1)
            self._enter(self._until(rows) if gradual else [rows], 1)
        self.since, self.rows = ticks, rows
        self._field = RainField(rows)
        self._data = None

    @property
    def is_dry(self) -> bool:
        """Whether there is neither water nor rain."""
        return not len(self.tiles) and not len(self.rows)

    def _enter(self, moments: list[NDArray], ticks: int) -> None:
        """Let the mean rain of some moments fall for some ticks."""
        for rows in moments:
            self.tiles.rain(rows, 1.0 / len(moments))
        self.tiles.settle(ticks * TICK)

    def _until(self, rows: NDArray) -> list[NDArray]:
        """The moments that stand for the time until `rows`: one where nothing has moved."""
        still = rows is self.rows or np.array_equal(rows, self.rows)
        return [rows] if still else [self.rows, rows]

    def _alike(self, rows: NDArray, tolerance: float = 1.0) -> bool:
        """Whether the ground can hardly tell these areas from those it knows."""
        if len(rows) != len(self.rows):
            return False
        for one, other in zip(plain_rows(rows), plain_rows(self.rows), strict=True):
            key, (x, z), radii, heading, rate, *shape = one
            other_key, (u, w), other_radii, other_heading, other_rate, *other_shape = other
            if (key, radii, heading, shape) != (other_key, other_radii, other_heading, other_shape):
                return False
            if math.hypot(x - u, z - w) > tolerance * SHIFT * self.tiles.cell:
                return False
            if abs(rate - other_rate) > tolerance * CHANGE * max(rate, other_rate):
                return False
        return True

    def at(self, x: float, y: float, z: float, ticks: int) -> float:
        """mm at a place at a tick."""
        water = self.tiles.at(x, z)
        if ticks > self.since and (water > 0.0 or self._field):
            rate = self._field.rate(x, y, z) * MM_PER_S
            water = self.tiles.law.settle_one(water, rate, (ticks - self.since) * TICK)
        return water

    def data(self) -> WetTileData:
        """The same as plain arrays; the same object as long as nothing was entered."""
        if self._data is None:
            melt = self.tiles.law.melt
            self._data = WetTileData(*self.tiles.arrays(), self.since, self.rows, melt)
        return self._data

    # For snapshots

    def state(self) -> dict[str, Any]:
        """All there is to it, as plain values."""
        rows = [list(row) for row in plain_rows(self.rows)]
        law = self.tiles.law
        return {"melt": law.melt, "rows": rows, "since": self.since, **self.tiles.state()}

    @classmethod
    def from_state(cls, state: Any, ticks: int, law: Callable[[float], GroundLaw]) -> WetLevel:
        """The level that `state` was taken of; `law` gives one for a melt in mm/s.

        Raises InvalidValueError for anything else.
        """
        fields = ["codes", "level", "melt", "places", "rows", "since"]
        if not isinstance(state, dict) or sorted(state) != fields:
            raise InvalidValueError("wetness.levels", state, f"the fields {fields}")
        if type(state["melt"]) is not float or not 0.0 <= state["melt"] <= FASTEST_MELT:
            raise InvalidValueError("wetness.melt", state["melt"], "0 to 1 mm/s")
        kept = {name: state[name] for name in ("codes", "level", "places")}
        tiles = WetTiles.from_state(kept, law(state["melt"]))
        found = cls(tiles.level, whole("wetness.since", state["since"], ticks))
        found.tiles, found.rows = tiles, _rows(state["rows"])
        found._field = RainField(found.rows)
        if found.is_dry:
            raise InvalidValueError("wetness.levels", state, "levels with water or rain")
        return found


def whole(field: str, value: Any, most: int) -> int:
    """`value`, a whole number in [0, most]."""
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
        whole("wetness.rows", key, 2**53)
        found.append((key, a.center, a.radii, a.heading, a.rain_rate, a.soft_edge, a.ceiling))
    rows = np.array(found, AREA_DTYPE)
    if not (np.all(rows["rain_rate"] > 0.0) and np.all(np.diff(rows["key"]) > 0)):
        raise InvalidValueError("wetness.rows", values, "raining areas in order, each once")
    rows.setflags(write=False)
    return rows
