"""`WetGround`: water, or snow, on level ground under the open sky, in cells of a few metres.

Part of the weather's state: it does not know observers, drawing or shelter, so that a game and its
server have the same. Small areas have fine cells and large ones coarse cells, each size in a level
of its own. A level is brought up to date when its areas have moved or changed, and where nothing
changes in leaps of a minute; in between, whoever asks is told what the law (`physics.ground_law`),
which has a closed form, makes of it.
"""

from __future__ import annotations

import itertools
from collections.abc import Callable
from typing import Any

import numpy as np
from numpy.typing import NDArray

from weather_ecs.clock import STEP
from weather_ecs.errors import InvalidValueError
from weather_ecs.frame import WetnessData
from weather_ecs.physics.ground_law import WATER, GroundLaw
from weather_ecs.physics.wetness import MM_PER_S
from weather_ecs.systems.wet_level import FASTEST_MELT, NO_AREAS, TICK, WetLevel, whole
from weather_ecs.systems.wet_tiles import level_of

STEPS = round(TICK / STEP)

_numbers = itertools.count(1)


def _water(melt: float) -> GroundLaw:
    return WATER


class WetGround:
    """Water on the ground in mm, at every tick; a tick is a second of weather."""

    def __init__(self, law: GroundLaw = WATER) -> None:
        self.law = law
        self.number = next(_numbers)  # another one for another ground: a snapshot was restored
        self.steps = 0  # fixed steps since the last tick
        self.ticks = 0
        self.levels: dict[int, WetLevel] = {}
        self._rows = NO_AREAS
        self._groups: dict[int, NDArray] = {}  # the raining ones of these by level
        self._members: tuple[bytes, dict[int, NDArray]] = (b"", {})
        self._data: WetnessData | None = None

    def step(self) -> bool:
        """A fixed step has passed; whether it ends a second, and `tick` is due."""
        self.steps = (self.steps + 1) % STEPS
        return self.steps == 0

    def tick(self, rows: NDArray, law: GroundLaw | None = None) -> None:
        """A second has passed, at whose end the areas were these rows of AREA_DTYPE.

        `law` is the one from here on; another melt of the same layer.
        """
        self.ticks += 1
        if law is not None:
            self.law = law
        if rows is not self._rows:
            self._rows, self._groups = rows, self._grouped(rows)
        if not self._groups and not self.levels:
            return
        for level in sorted(self._groups.keys() | self.levels.keys()):
            known = self.levels.get(level)
            if known is None:
                known = self.levels[level] = WetLevel(level, self.ticks - 1, self.law)
            known.tick(self._groups.get(level, NO_AREAS), self.ticks, self.law)
            if known.is_dry:
                del self.levels[level]

    def _grouped(self, rows: NDArray) -> dict[int, NDArray]:
        """The areas where it rains, by level; read-only."""
        rains = rows["rain_rate"] > 0.0
        name = rains.tobytes() + rows["radii"].tobytes()
        if name != self._members[0]:
            levels = np.array([level_of(*radii) for radii in rows["radii"].tolist()], int)
            found = {
                level: np.flatnonzero(rains & (levels == level))
                for level in sorted(set(levels[rains].tolist()))
            }
            self._members = name, found
        groups = {level: rows[members] for level, members in self._members[1].items()}
        for each in groups.values():
            each.setflags(write=False)
        return groups

    def at(self, x: float, y: float, z: float, rate: float, time: float) -> float:
        """mm at a place at the clock's `time`, where it rains at `rate` mm/h now."""
        water = 0.0
        if not self.levels and rate <= 0.0:
            return water
        for level in self.levels.values():
            lies = level.at(x, y, z, self.ticks)
            water = self.law.merge_one(water, lies) if water > 0.0 else lies
        rest = time - self.ticks * TICK
        if rest > 0.0 and (water > 0.0 or rate > 0.0):
            water = self.law.settle_one(water, rate * MM_PER_S, rest)
        return water

    def many(
        self, x: NDArray, y: NDArray, z: NDArray, rate: NDArray, time: float
    ) -> NDArray[np.float64]:
        """`at` for many places (n,)."""
        water = np.zeros(len(x))
        for level in self.levels.values():
            water = self.law.merge(water, level.many(x, y, z, self.ticks))
        rest = time - self.ticks * TICK
        return self.law.settle(water, rate * MM_PER_S, rest) if rest > 0.0 else water

    def data(self) -> WetnessData:
        """What the GPU's own map begins with; the same object within one second."""
        if self._data is None or self._data.ticks != self.ticks:
            levels = tuple([level.data() for level in self.levels.values()])
            self._data = WetnessData(self.number, self.ticks, levels)
        return self._data

    # For snapshots

    def state(self) -> dict[str, Any]:
        """All there is to it, as plain values."""
        levels = [level.state() for _, level in sorted(self.levels.items())]
        return {
            "levels": levels,
            "melt": self.law.melt,
            "steps": self.steps,
            "ticks": self.ticks,
        }

    @classmethod
    def from_state(cls, state: Any, law: Callable[[float], GroundLaw] = _water) -> WetGround:
        """The ground that `state` was taken of; `law` gives one for a melt in mm/s.

        Raises InvalidValueError for anything else.
        """
        fields = ["levels", "melt", "steps", "ticks"]
        if not isinstance(state, dict) or sorted(state) != fields:
            raise InvalidValueError("wetness", state, f"the fields {fields}")
        if type(state["melt"]) is not float or not 0.0 <= state["melt"] <= FASTEST_MELT:
            raise InvalidValueError("wetness.melt", state["melt"], "0 to 1 mm/s")
        ground = cls(law(state["melt"]))
        ground.steps = whole("wetness.steps", state["steps"], STEPS - 1)
        ground.ticks = whole("wetness.ticks", state["ticks"], 2**53)
        if not isinstance(state["levels"], list):
            raise InvalidValueError("wetness.levels", state["levels"], "a list")
        for each in state["levels"]:
            level = WetLevel.from_state(each, ground.ticks, law)
            name = level.tiles.level
            if ground.levels and name <= max(ground.levels):
                raise InvalidValueError("wetness.level", name, "levels in order, each once")
            ground.levels[name] = level
        return ground
