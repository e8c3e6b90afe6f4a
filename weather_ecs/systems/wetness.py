"""`WetnessSystem`: wets and dries the ground, once a second of weather."""

from __future__ import annotations

from typing import Any

import esper
from numpy.typing import NDArray

from weather_ecs.components import RainArea
from weather_ecs.frame import AREA_DTYPE, empty
from weather_ecs.physics.front import on_level_ground
from weather_ecs.systems.queries import alive
from weather_ecs.systems.rain_area import area_rows, dry_spells
from weather_ecs.systems.state import WeatherState


class WetnessSystem:
    """Shows the areas of every full second to `state.wet_ground`."""

    def __init__(self) -> None:
        self._list: list[Any] | None = None
        self._revision = -1
        self._entities: list[int] = []
        self._rows = empty(AREA_DTYPE)
        self._changing = False  # rain begins or ends somewhere

    def run(self, state: WeatherState) -> None:
        """One fixed step."""
        if state.wet_ground.step():
            state.wet_ground.tick(self._areas(state))

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
