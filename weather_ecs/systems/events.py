"""`EventSystem`: tells of rain and snow that begin or end at an observer, and of the state."""

from __future__ import annotations

import esper

from weather_ecs.clock import STEP
from weather_ecs.components import Observer, RainArea
from weather_ecs.physics.rain_field import RainField
from weather_ecs.systems.air import air_data
from weather_ecs.systems.climate import oldest_state
from weather_ecs.systems.queries import alive, living
from weather_ecs.systems.rain_area import area_rows, dry_spells
from weather_ecs.systems.state import WeatherState

RAIN_BEGINS, RAIN_ENDS = "rain_begins", "rain_ends"
SNOW_BEGINS, SNOW_ENDS = "snow_begins", "snow_ends"
STATE_CHANGED = "state_changed"

STEPS = round(1.0 / STEP)  # looked at once a second of weather
BEGIN, END = 0.1, 0.05  # mm/h of water: more begins, less ends
STATES = (("clear", 0.0), ("fair", 0.25), ("cloudy", 0.5), ("overcast", 0.75), ("storm", 1.0))
SURE = 0.02  # beyond the middle between two states that one has to be, to be in the other


class EventSystem:
    """Compares every second with the last; what is so at the first look is no event."""

    def __init__(self) -> None:
        self._field: object = None
        self._falls: dict[int, tuple[bool, bool]] = {}  # by observer: rain, snow
        self._state = ""

    def run(self, state: WeatherState) -> None:
        """One fixed step."""
        if state.clouds is not self._field:  # the first step, or a snapshot was restored
            self._field, self._falls, self._state = state.clouds, {}, ""
        if state.step % STEPS:
            return
        observers = living(Observer)
        if observers or self._falls:
            self._rain(state, observers)
        here = oldest_state(state)
        if here is not None:
            name = state_name(here, self._state)
            if self._state and name != self._state:
                state.events.append((STATE_CHANGED, (self._state, name)))
            self._state = name

    def _rain(self, state: WeatherState, observers: list[tuple[int, Observer]]) -> None:
        areas = alive(RainArea, state.uids)
        rows = area_rows(areas, state.fronts) if areas else None
        field = None
        if rows is not None:
            field = RainField(rows, dry_spells(areas, state.fronts, 0.0))
        share = air_data(state).snow_share
        falls = {}
        for entity, observer in observers:
            rate = field.rate(*observer.position) if field is not None else 0.0
            before = self._falls.get(entity)
            now = [
                amount >= (END if before is not None and before[k] else BEGIN)
                for k, amount in enumerate((rate * (1.0 - share), rate * share))
            ]
            falls[entity] = (now[0], now[1])
            if before is None:
                continue
            for k, names in enumerate(((RAIN_BEGINS, RAIN_ENDS), (SNOW_BEGINS, SNOW_ENDS))):
                if now[k] != before[k]:
                    amount = rate * (share if k else 1.0 - share)
                    state.events.append((names[0 if now[k] else 1], (entity, amount)))
        self._falls = {entity: f for entity, f in falls.items() if esper.entity_exists(entity)}


def state_name(state: float, before: str = "") -> str:
    """The named state that is nearest; `before` stays until another is surely nearer."""
    known = dict(STATES)
    name = min(STATES, key=lambda each: abs(each[1] - state))[0]
    if before in known and abs(known[before] - state) < abs(known[name] - state) + 2.0 * SURE:
        return before
    return name
