"""A world of esper's own for each test."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count

import esper

from weather_ecs.systems import WeatherProcessor

_numbers = count()


@contextmanager
def fresh_world() -> Iterator[str]:
    """Switch to a new world; afterwards it is gone, and a weather that was left in it too."""
    before = esper.current_world
    name = f"test {next(_numbers)}"
    esper.switch_world(name)
    try:
        yield name
    finally:
        if name in esper.list_worlds():
            esper.switch_world(name)
            esper.remove_processor(WeatherProcessor)
        esper.switch_world(before)
        if name in esper.list_worlds():
            esper.delete_world(name)


def let_pass(seconds: float, step: float = 0.5) -> None:
    """Process the current world for some seconds, in frames of a step."""
    for _ in range(round(seconds / step)):
        esper.process(step)
