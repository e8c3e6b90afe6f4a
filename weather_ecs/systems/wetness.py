"""`WetnessSystem`: wets and dries the ground and lays snow on it, once a second of weather."""

from __future__ import annotations

from typing import Any

import esper
from numpy.typing import NDArray

from weather_ecs.components import RainArea, SnowFlakes
from weather_ecs.frame import AREA_DTYPE, SnowLook, empty
from weather_ecs.physics.front import on_level_ground
from weather_ecs.physics.ground_law import SnowLaw
from weather_ecs.physics.snow_cover import melt_rate
from weather_ecs.systems.air import air_data
from weather_ecs.systems.queries import alive
from weather_ecs.systems.rain_area import area_rows, dry_spells
from weather_ecs.systems.state import WeatherState
from weather_ecs.systems.wet_level import NO_AREAS


def settling(state: WeatherState) -> float:
    """Times as fast as in nature that snow collects."""
    for _, flakes in alive(SnowFlakes, state.uids):
        return flakes.settling
    return SnowLook().settling


class WetnessSystem:
    """Shows the areas of every full second to `state.wet_ground` and `state.snow_ground`."""

    def __init__(self) -> None:
        self._list: list[Any] | None = None
        self._revision = -1
        self._entities: list[int] = []
        self._rows = empty(AREA_DTYPE)
        self._changing = False  # rain begins or ends somewhere
        self._parts: dict[str, tuple[NDArray, float, NDArray]] = {}

    def run(self, state: WeatherState) -> None:
        """One fixed step."""
        if not state.wet_ground.step():
            return
        rows, air = self._areas(state), air_data(state)
        state.wet_ground.tick(self._part("rain", rows, 1.0 - air.snow_share))
        melt = float(melt_rate(air.wet_bulb))
        collects = air.snow_share * settling(state) if air.snow_share > 0.0 else 0.0
        state.snow_ground.tick(self._part("snow", rows, collects), SnowLaw(melt))

    def _part(self, name: str, rows: NDArray, share: float) -> NDArray:
        """The areas with a share of what falls; the same array where nothing has changed."""
        if share <= 0.0:
            return NO_AREAS
        known = self._parts.get(name)
        if known is not None and known[0] is rows and known[1] == share:
            return known[2]
        part = rows
        if share != 1.0:
            part = rows.copy()
            part["rain_rate"] *= share
            part.setflags(write=False)
        self._parts[name] = (rows, share, part)
        return part

    def _areas(self, state: WeatherState) -> NDArray:
        """The areas as rows; the same array as before where nothing has changed."""
        found, revision = esper.get_component(RainArea), RainArea.revision()
        same = found is self._list and revision == self._revision and not self._changing
        if not same or not all(map(esper.entity_exists, self._entities)):
            self._list, self._revision = found, revision
            areas = alive(RainArea, state.uids)
            spells = dry_spells(areas, state.fronts, 0.0)
            self._rows = on_level_ground(area_rows(areas, state.fronts), spells)
            self._changing = bool(spells)
            self._entities = [pair[0] for pair in found if esper.entity_exists(pair[0])]
        return self._rows
