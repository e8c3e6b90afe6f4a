"""`ClimateSystem`: lets the climates run."""

from __future__ import annotations

import esper

from weather_ecs.clock import STEP
from weather_ecs.components import Climate, SkyLayer
from weather_ecs.components._base import set_unchecked
from weather_ecs.physics.climate import state as state_at
from weather_ecs.systems.queries import alive
from weather_ecs.systems.state import WeatherState


def state_of(climate: Climate) -> float:
    """The state of the skies that a climate is at, 0 to 1."""
    return state_at(climate.initial, climate.final, climate.duration, climate.elapsed)


def oldest_state(state: WeatherState) -> float | None:
    """The state that everybody's climate is at: the oldest that is no layer's own; None without
    any climate.
    """
    climates = alive(Climate, state.uids)
    if len(climates) > 1:
        layers = {uid for uid, _ in alive(SkyLayer, state.uids)}
        for uid, climate in climates:
            if uid not in layers:
                return state_of(climate)
    return state_of(climates[0][1]) if climates else None


class ClimateSystem:
    """Carries the time of every climate that runs on by a fixed step, forwards or backwards."""

    def run(self, state: WeatherState) -> None:
        """One fixed step; at both ends of its way a climate stands still and goes on running."""
        for _, climate in esper.get_component(Climate):
            if climate.running and climate.speed:
                before = climate.elapsed
                # Rounded, so that no error adds up: 300 steps are 15 s.
                passed = round(before + climate.speed * STEP, 12)
                after = min(max(passed, 0.0), climate.duration)
                if after != before:
                    set_unchecked(climate, "elapsed", after)
