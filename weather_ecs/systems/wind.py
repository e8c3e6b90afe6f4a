"""`WindSystem`: the sum of all winds."""

from __future__ import annotations

from weather_ecs.components import Wind
from weather_ecs.systems.queries import alive
from weather_ecs.systems.state import WeatherState


def total_wind(state: WeatherState) -> tuple[float, float, float]:
    """Sum of the `Wind` components, m/s, world axes."""
    x = z = 0.0
    for _, wind in alive(Wind, state.uids):
        x += wind.direction[0] * wind.speed
        z += wind.direction[1] * wind.speed
    return x, 0.0, z


class WindSystem:
    """Sums the winds into one vector for the systems after it."""

    def run(self, state: WeatherState) -> None:
        """Set `state.wind`."""
        state.wind = total_wind(state)
