"""What the editor asks of a weather beyond its public face, all in one place."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager

import esper
import numpy as np
from numpy.typing import NDArray

from weather_ecs import Weather
from weather_ecs.clock import STEP as STEP  # s, of a fixed step
from weather_ecs.components import Wind
from weather_ecs.systems.atmosphere import covered_by as covered_by  # share of the sky
from weather_ecs.systems.wind import strength, velocity_now
from weather_ecs.weathers import heading_of as heading_of  # of a bearing, rad

_SETTLED = 1e-9  # s, a remainder of less is a rounding error


@contextmanager
def in_world(name: str) -> Iterator[None]:
    """Work on one of esper's worlds, which is made if there is none, and come back."""
    before = esper.current_world
    if before == name:
        yield
        return
    esper.switch_world(name)
    try:
        yield
    finally:
        esper.switch_world(before)


def steps_of(weather: Weather) -> int:
    """Fixed steps that the weather has done."""
    return weather.inner_state.clock.steps


def settle(weather: Weather) -> None:
    """Take a rounding error out of the clock, so that equal runs have equal snapshots."""
    clock = weather.inner_state.clock
    if clock.remainder < _SETTLED:
        clock.remainder = 0.0


def entities_by_uid(weather: Weather) -> dict[int, int]:
    """Entities of the weather's world by the numbers that snapshots name them by."""
    return {uid: entity for entity, uid in weather.inner_state.uids.current().items()}


def law_speeds(wind: Wind, times: NDArray[np.float64]) -> NDArray[np.float64]:
    """m/s that a wind's law gives at times of the clock in s, without gusts of chance."""
    return np.array([wind.speed * strength(wind, time) for time in times.tolist()])


def gust_speeds(wind: Wind, times: NDArray[np.float64], key: int = 0) -> NDArray[np.float64]:
    """The same with the gusts that come by chance, for one of many such winds."""
    return np.array([velocity_now(wind, key, time)[0] for time in times.tolist()])
