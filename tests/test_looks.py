"""How things look in a frame: the oldest component of a kind says it."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import asdict, fields
from typing import Any

import esper
import pytest

from weather_ecs.components import RainContainer, SnowFlakes, SplashEmitter, Sun
from weather_ecs.components.cloud_shading import CloudShading
from weather_ecs.frame import CloudLook, DropLook, SkyLight, SnowLook
from weather_ecs.systems import looks
from weather_ecs.systems.state import WeatherState

pytestmark = pytest.mark.usefixtures("world")

CASES: list[tuple[Callable[[WeatherState], Any], type, Any]] = [
    (looks.sun_light, Sun, SkyLight()),
    (looks.drop_look, RainContainer, DropLook()),
    (looks.snow_look, SnowFlakes, SnowLook()),
    (looks.cloud_look, CloudShading, CloudLook()),
    (looks.splash_look, SplashEmitter, None),
]


def other(component: Any) -> Any:
    """The component, each of its numbers a little different and each flag turned."""
    for field in fields(component):
        value = getattr(component, field.name)
        if isinstance(value, bool):
            setattr(component, field.name, not value)
        elif isinstance(value, float):
            setattr(component, field.name, 0.97 * value)
    return component


@pytest.mark.parametrize(
    ("look", "kind", "plain"), CASES, ids=[kind.__name__ for _, kind, _ in CASES]
)
def test_the_oldest_says_all_of_it(look: Any, kind: type, plain: Any) -> None:
    state = WeatherState(1)
    assert look(state) == plain
    oldest = other(kind())
    for component in (oldest, kind()):
        esper.create_entity(component)
        state.uids.commit()
    said = asdict(look(state))
    changed = 0
    for name, value in said.items():
        if hasattr(oldest, name):
            assert value == getattr(oldest, name), name
            changed += value != getattr(kind(), name)
    assert changed >= 1 or kind is Sun
