"""Climates that run, and the skies that follow them."""

from __future__ import annotations

import esper
import pytest

from tests.cloud_worlds import four_skies, layer, record, seconds, skies_of
from weather_ecs import Weather
from weather_ecs.components import Climate
from weather_ecs.systems.climate import state_of
from weather_ecs.systems.clouds import layer_state

pytestmark = pytest.mark.usefixtures("world")


def test_the_worked_example_is_exact():
    weather = Weather()
    climate = Climate(duration=30.0)
    esper.create_entity(climate)
    seconds(15.0, 0.05)
    assert climate.elapsed == 15.0
    assert state_of(climate) == 0.5
    assert weather.stats.state == 0.5


@pytest.mark.parametrize("dt", [0.05, 1 / 60, 0.7, 10.0])
def test_it_ends_where_it_is_to_whatever_the_frames(dt):
    Weather()
    climate = Climate(initial=0.25, final=0.75, duration=20.0)
    esper.create_entity(climate)
    seconds(10.0, dt)
    assert climate.elapsed == pytest.approx(10.0, abs=0.36)
    seconds(20.0, dt)
    assert climate.elapsed == 20.0
    assert state_of(climate) == 0.75


def test_it_can_be_paused_reversed_sped_up_and_put_anywhere():
    weather = Weather()
    climate = Climate(duration=100.0, running=False)
    esper.create_entity(climate)
    seconds(5.0)
    assert climate.elapsed == 0.0
    climate.running = True
    seconds(5.0)
    assert climate.elapsed == 5.0
    climate.speed = 8.0
    seconds(5.0)
    assert climate.elapsed == 45.0
    climate.speed = -2.0
    seconds(10.0)
    assert climate.elapsed == 25.0
    seconds(20.0)
    assert (climate.elapsed, state_of(climate)) == (0.0, 0.0)
    climate.speed = 0.0
    seconds(1.0)
    assert climate.elapsed == 0.0
    climate.elapsed = 80.0
    assert weather.stats.state == pytest.approx(0.8)
    climate.elapsed = 1e9  # beyond the end counts as the end
    climate.speed = -1.0
    seconds(10.0)
    assert climate.elapsed <= 100.0
    weather.paused = True
    before = climate.elapsed
    seconds(3.0)
    assert climate.elapsed == before


def test_a_slow_climate_does_not_stand_still():
    Weather()
    climate = Climate(duration=1e9, speed=1e-6)
    esper.create_entity(climate)
    seconds(100.0)
    assert climate.elapsed == pytest.approx(1e-4)


def test_a_layer_goes_by_its_own_climate_and_else_by_the_oldest():
    weather = Weather()
    esper.create_entity(Climate(initial=0.25, running=False))
    esper.create_entity(Climate(initial=1.0, running=False))
    esper.create_entity(layer(four_skies()), Climate(initial=0.75, running=False))
    esper.create_entity(layer(four_skies()))
    esper.process(0.05)
    state = weather._state
    own, common = record(weather), record(weather, 1)
    assert layer_state(state, own.uid) == 0.75
    assert layer_state(state, common.uid) == 0.25
    assert set(skies_of(own).values()) == {0.75}
    assert set(skies_of(common).values()) == {0.25}
    assert weather.stats.state == 0.25


def test_without_a_climate_the_sky_is_clear():
    weather = Weather()
    esper.create_entity(layer(four_skies()[1:]))
    esper.process(0.05)
    assert set(skies_of(record(weather)).values()) == {0.25}
    assert weather.stats.state == 0.0
