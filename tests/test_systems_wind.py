"""`WindSystem`: winds add up."""

from __future__ import annotations

import esper
import pytest

from tests.worlds import fresh_world
from weather_ecs.components import Wind
from weather_ecs.systems import WeatherState, WindSystem


@pytest.fixture(autouse=True)
def world():
    with fresh_world() as name:
        yield name


def summed() -> tuple[float, float, float]:
    state = WeatherState(0)
    WindSystem().run(state)
    return state.wind


def test_without_wind_the_air_is_still():
    assert summed() == (0.0, 0.0, 0.0)


def test_winds_add_up_and_stay_level():
    esper.create_entity(Wind((1, 0), 6.0))
    esper.create_entity(Wind((0, -2), 3.0))
    esper.create_entity(Wind((1, 0), 0.0))
    assert summed() == (6.0, 0.0, -3.0)


def test_opposite_winds_cancel():
    esper.create_entity(Wind((3, 4), 5.0))
    esper.create_entity(Wind((-3, -4), 5.0))
    assert summed() == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)


def test_a_wind_whose_deletion_is_pending_has_died_down():
    esper.create_entity(Wind((1, 0), 6.0))
    gone = esper.create_entity(Wind((0, 1), 6.0))
    esper.delete_entity(gone)
    assert summed() == (6.0, 0.0, 0.0)


def test_the_sum_does_not_depend_on_the_order_of_esper():
    speeds = [1e-9, 150.0, 0.1, 33.3, 1e-7, 77.7]
    entities = [esper.create_entity() for _ in range(200)]
    for entity, speed in zip(entities[::37], speeds, strict=True):
        esper.add_component(entity, Wind((1, 0), speed))
    expected = 0.0
    for speed in speeds:
        expected += speed
    assert summed()[0] == expected
