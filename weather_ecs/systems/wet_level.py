"""`WetLevel`: the ground under areas of about one size, and what has rained on it since."""

from __future__ import annotations

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
from weather_ecs.systems.wet_path import Stretch, begin
from weather_ecs.systems.wet_tiles import WetTiles

TICK = 1.0  # s of weather between two looks at what the areas do
LONGEST = 60  # ticks that one leap spans at most
LEAP = 16  # the same where areas move or change
MOST_STRETCHES = 6  # in one leap
FASTEST_MELT = 1.0  # mm/s
NO_AREAS = empty(AREA_DTYPE)


class WetLevel:
    """Water on the ground in mm: tiles as they were at `since`, and the rain that fell after.

    Or snow, by its law: the law's melt, too, is that since then.
    """

    def __init__(self, level: int, since: int, law: GroundLaw = WATER) -> None:
        self.tiles = WetTiles(level, law)
        self.since = since  # the tick the tiles are of
        self.rows = NO_AREAS  # the raining areas as the last tick left them
        self.stretches: list[Stretch] = []  # what they did since then
        self._field: RainField | None = None
        self._now: WetTiles | None = None
        self._data: WetTileData | None = None

    def tick(self, rows: NDArray, ticks: int, law: GroundLaw = WATER) -> None:
        """A tick has passed, at whose end the areas were these rows of AREA_DTYPE."""
        if not self.tiles.law.alike(law):
            self._enter()
            self.tiles.law, self._data = law, None
        stretches, cell = self.stretches, self.tiles.cell
        if not (stretches and stretches[-1].goes_on(rows, cell)):
            if stretches and self._pending > LEAP:
                self._enter()
            stretches.append(begin(rows, self.rows, cell))
        if rows is not self.rows:
            self.rows, self._field = rows, None
        if not self._stood:
            self._now = self._data = None
        pending = self._pending
        if pending >= (LONGEST if self._stood else LEAP) or len(stretches) > MOST_STRETCHES:
            self._enter()

    @property
    def _pending(self) -> int:
        """Ticks that have not been entered."""
        return sum([stretch.ticks for stretch in self.stretches])

    @property
    def _stood(self) -> bool:
        """Whether the areas have stood since the last entry."""
        return not self.stretches or (len(self.stretches) == 1 and self.stretches[0].still)

    @property
    def is_dry(self) -> bool:
        """Whether there is neither water nor rain."""
        rained = any(len(stretch.last) for stretch in self.stretches)
        return not rained and not len(self.tiles) and not len(self.rows)

    def _enter(self) -> None:
        """Bring the tiles up to date."""
        if self.stretches:
            self._let_fall(self.tiles)
            self.tiles.next_round()
            self.since += self._pending
            self.stretches.clear()
            self._now = self._data = None

    def _let_fall(self, tiles: WetTiles) -> None:
        """Let what has not been entered fall on tiles."""
        left = seconds = self._pending * TICK
        mean = tiles.law.kept_mean(seconds) * seconds
        for stretch in self.stretches:
            then = left - stretch.ticks * TICK
            if stretch.still:
                # What of it is left at the end, as the law has it.
                share = tiles.law.kept_mean(left) * left
                share -= tiles.law.kept_mean(then) * then if then > 0.0 else 0.0
                tiles.rain(stretch.last, share / mean)
            else:
                tiles.rain_along(stretch.first, stretch.last, left, then, 1.0 / mean)
            left = then
        tiles.settle(seconds)

    def at(self, x: float, y: float, z: float, ticks: int) -> float:
        """mm at a place at a tick."""
        if self._now is not None:
            return self._now.at(x, z)
        if not self._stood:
            return self._current().at(x, z)
        if self._field is None:
            self._field = RainField(self.rows)
        water = self.tiles.at(x, z)
        if ticks > self.since:
            rate = self._field.rate(x, y, z) * MM_PER_S
            water = self.tiles.law.settle_one(water, rate, (ticks - self.since) * TICK)
        return water

    def many(self, x: NDArray, y: NDArray, z: NDArray, ticks: int) -> NDArray[np.float64]:
        """`at` for many places (n,)."""
        if not self._stood:
            return self._current().many(x, z)
        if self._field is None:
            self._field = RainField(self.rows)
        water = self.tiles.many(x, z)
        if ticks > self.since:
            rate = self._field.many(x, y, z) * MM_PER_S
            water = self.tiles.law.settle(water, rate, (ticks - self.since) * TICK)
        return water

    def _current(self) -> WetTiles:
        """The tiles as they are now; made for whoever asks, and no part of the state."""
        if self._now is None:
            self._now = self.tiles.copy()
            self._let_fall(self._now)
        return self._now

    def data(self) -> WetTileData:
        """The same as plain arrays; the same object as long as nothing was entered."""
        if self._data is None:
            tiles, since = self.tiles, self.since
            if not self._stood:
                tiles, since = self._current(), since + self._pending
            self._data = WetTileData(*tiles.arrays(), since, self.rows, tiles.law.melt)
        return self._data

    # For snapshots

    def state(self) -> dict[str, Any]:
        """All there is to it, as plain values."""
        way = [
            [stretch.ticks, _plain(stretch.last), *([] if stretch.still else [_moved(stretch)])]
            for stretch in self.stretches
        ]
        law = self.tiles.law
        rows = [] if self.stretches else _plain(self.rows)
        return {
            "melt": law.melt, "rows": rows, "since": self.since, "way": way, **self.tiles.state(),
        }  # fmt: skip

    @classmethod
    def from_state(cls, state: Any, ticks: int, law: Callable[[float], GroundLaw]) -> WetLevel:
        """The level that `state` was taken of; `law` gives one for a melt in mm/s.

        Raises InvalidValueError for anything else.
        """
        fields = ["codes", "level", "melt", "places", "resting", "rows", "since", "way"]
        if not isinstance(state, dict) or sorted(state) != fields:
            raise InvalidValueError("wetness.levels", state, f"the fields {fields}")
        if type(state["melt"]) is not float or not 0.0 <= state["melt"] <= FASTEST_MELT:
            raise InvalidValueError("wetness.melt", state["melt"], "0 to 1 mm/s")
        kept = {name: state[name] for name in ("codes", "level", "places", "resting")}
        tiles = WetTiles.from_state(kept, law(state["melt"]))
        found = cls(tiles.level, whole("wetness.since", state["since"], ticks))
        found.tiles = tiles
        found.rows = _rows(state["rows"])
        found.stretches = _way(state["way"], ticks - found.since)
        if found.stretches:
            if len(found.rows):
                raise InvalidValueError("wetness.rows", state["rows"], "none beside a way")
            found.rows = found.stretches[-1].last
        if found.is_dry:
            raise InvalidValueError("wetness.levels", state, "levels with water or rain")
        return found


def _plain(rows: NDArray) -> list[list[Any]]:
    return [list(row) for row in plain_rows(rows)]


def _moved(stretch: Stretch) -> list[list[float]]:
    """Where the areas of a stretch came from: (x, z, rate) of each."""
    first = stretch.first
    return [
        [*c, r] for c, r in zip(first["center"].tolist(), first["rain_rate"].tolist(), strict=True)
    ]


def _way(values: Any, pending: int) -> list[Stretch]:
    if not isinstance(values, list) or len(values) > MOST_STRETCHES:
        raise InvalidValueError("wetness.way", values, f"up to {MOST_STRETCHES} stretches")
    found = []
    for value in values:
        if not isinstance(value, list) or len(value) not in (2, 3):
            raise InvalidValueError("wetness.way", value, "ticks, areas, where they came from")
        count = whole("wetness.way", value[0], LONGEST)
        last = first = _rows(value[1])
        if len(value) == 3:
            starts = value[2]
            if not isinstance(starts, list) or len(starts) != len(last):
                raise InvalidValueError("wetness.way", starts, "one start for each area")
            rows = []
            for row, start in zip(value[1], starts, strict=True):
                if not isinstance(start, list) or len(start) != 3:
                    raise InvalidValueError("wetness.way", start, "three numbers")
                rows.append([row[0], start[:2], *row[2:4], start[2], *row[5:]])
            first = _rows(rows)
        found.append(Stretch(first, last, count))
    if any(not each.ticks for each in found) or sum(each.ticks for each in found) != pending:
        raise InvalidValueError("wetness.way", values, f"stretches of {pending} ticks in all")
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
