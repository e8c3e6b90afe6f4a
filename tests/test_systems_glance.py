"""`Glance` and `look`: what tells that something has changed, by itself."""

from __future__ import annotations

from collections.abc import Callable

import esper
import pytest

from weather_ecs.components import PointLight, RainArea, Wind
from weather_ecs.systems import WeatherState
from weather_ecs.systems.cloud_field import CloudField
from weather_ecs.systems.course import LIMITS, Conditions, Course
from weather_ecs.systems.glance import Glance, look
from weather_ecs.systems.kinds import Kinds
from weather_ecs.systems.rain_fronts import RainFronts

pytestmark = pytest.mark.usefixtures("world")

MIDDLE = Conditions(*[0.5 * (low + high) for low, high in LIMITS.values()])


@pytest.fixture
def state() -> WeatherState:
    esper.create_entity(RainArea((0, 0), (20, 10)))
    esper.create_entity(Wind())
    return WeatherState(0)


def kept(state: WeatherState) -> Glance:
    glance = Glance()
    assert not glance.same(state)  # nothing was kept yet
    glance.keep()
    assert glance.same(state) and glance.same(state)
    return glance


def area() -> RainArea:
    return esper.get_component(RainArea)[0][1]


CHANGES: dict[str, Callable[[WeatherState], object]] = {
    "field": lambda state: setattr(area(), "rain_rate", 3.0),
    "entity": lambda state: esper.create_entity(PointLight()),
    "any entity": lambda state: esper.create_entity(),
    "pending deletion": lambda state: esper.delete_entity(1),
    "deletion": lambda state: esper.delete_entity(1, immediate=True),
    "component": lambda state: esper.remove_component(2, Wind),
    "step": lambda state: state.clock.advance(0.05),
    "remainder": lambda state: state.clock.advance(0.01),
    "fronts": lambda state: setattr(state, "fronts", RainFronts()),
    "clouds": lambda state: setattr(state, "clouds", CloudField()),
    "course": lambda state: setattr(state, "course", Course("fog", MIDDLE, MIDDLE, 0, 9)),
    "drawn": lambda state: setattr(state, "drawn", True),
}


@pytest.mark.parametrize("change", CHANGES.values(), ids=CHANGES)
def test_a_glance_sees_every_change_until_it_is_kept(
    state: WeatherState, change: Callable[[WeatherState], object]
) -> None:
    glance = kept(state)
    change(state)
    assert not glance.same(state)
    glance.keep()
    assert glance.same(state)


def test_what_does_not_show_is_forgotten_by_word(state: WeatherState) -> None:
    glance = kept(state)
    glance.forget()
    assert not glance.same(state)


def test_an_assignment_of_the_same_value_is_one_too(state: WeatherState) -> None:
    """Nobody compares: to say that it may have changed is right, to miss one is not."""
    glance = kept(state)
    area().rain_rate = area().rain_rate
    assert not glance.same(state)


def test_a_look_has_revisions_first_and_what_there_is_last(state: WeatherState) -> None:
    kinds = Kinds((RainArea, Wind))
    first = look(state, kinds)
    assert first == look(state, kinds)
    assert [len(pairs) for pairs in first[-1]] == [1, 1]
    area().rain_rate = 3.0
    second = look(state, kinds)
    assert [a == b for a, b in zip(first[0], second[0], strict=True)] == [False, True]
    assert first[1:] == second[1:]
    esper.delete_entity(1)
    assert look(state, kinds)[1] == 1  # one is about to go, of which the lists say nothing
    assert look(state, kinds)[-1] == first[-1]
