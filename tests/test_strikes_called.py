"""Strikes that a game calls, their thunder and their light."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import esper
import numpy as np
import pytest

from tests.strike_listener import Listener
from tests.worlds import fresh_world, let_pass
from weather_ecs import Weather
from weather_ecs.components import Observer, Occluder
from weather_ecs.errors import ClosedError, InvalidValueError
from weather_ecs.physics import lightning
from weather_ecs.systems.strikes import Strike


@pytest.fixture
def weather() -> Iterator[Weather]:
    with fresh_world(), Weather(seed=11) as it:
        yield it


# Strikes that the game calls


def test_a_called_strike_comes_in_the_next_step(weather: Weather) -> None:
    told = Listener()
    esper.process(0.07)
    weather.paused = True
    weather.strike((10.0, 3.0, -400.0), origin=(0.0, 1000.0, -500.0), current=80.0)
    esper.process(1.0)
    assert told.log == []
    weather.paused = False
    esper.process(0.05)
    (strike,) = told.strikes
    assert (strike.step, strike.origin, strike.target) == (2, (0, 1000, -500), (10, 3, -400))
    assert (strike.current, strike.ground) == (80.0, True)
    assert strike.energy == pytest.approx(80.0 / 30.0 * 1e9)


def test_without_a_beginning_it_comes_from_above(weather: Weather) -> None:
    told = Listener()
    weather.strike((10.0, 30.0, -400.0))
    esper.process(0.05)
    (strike,) = told.strikes
    assert strike.target == (10.0, 30.0, -400.0)
    assert strike.origin[1] == 1530.0
    assert math.dist(strike.origin[::2], strike.target[::2]) < 400.0


def test_without_an_end_it_looks_for_one(weather: Weather) -> None:
    mast = np.array([(-0.1, 0, 0), (0.1, 0, 0), (0, 25, 0)], np.float32)
    place = np.eye(4)
    place[:3, 3] = (20.0, 2.0, -5.0)
    entity = esper.create_entity(Occluder(mast, np.array([0, 1, 2]), place))
    told = Listener()
    weather.strike(origin=(0.0, 900.0, 0.0), current=30.0)
    weather.strike(origin=(600.0, 900.0, 0.0), current=30.0)
    esper.process(0.05)
    assert [strike.target for strike in told.strikes] == [(20.0, 27.0, -5.0), (600.0, 0.0, 0.0)]
    esper.delete_entity(entity)
    weather.strike(origin=(0.0, 900.0, 0.0), current=30.0)
    esper.process(0.05)
    assert told.strikes[-1].target == (0.0, 0.0, 0.0)


@pytest.mark.parametrize(
    "given",
    [
        {}, {"target": (0, 0)}, {"target": (0, math.nan, 0)}, {"target": "here"},
        {"origin": (0, 0, 1e8)}, {"target": (0, 0, 0), "current": 0.0},
        {"target": (0, 0, 0), "current": math.inf}, {"target": (0, 0, 0), "current": "much"},
    ],
)  # fmt: skip
def test_bad_strikes_are_refused(weather: Weather, given: dict[str, Any]) -> None:
    told = Listener()
    with pytest.raises(InvalidValueError):
        weather.strike(**given)
    esper.process(0.1)
    assert told.log == []


def test_a_closed_weather_strikes_no_more() -> None:
    with fresh_world():
        weather = Weather()
        weather.close()
        with pytest.raises(ClosedError):
            weather.strike((0, 0, 0))


def test_thousands_at_once_are_kept_in_bounds(weather: Weather) -> None:
    for k in range(3000):
        weather.strike((float(k), 0.0, 0.0))
    let_pass(1.0, 0.1)
    assert len(weather.snapshot()) < 200_000
    assert math.isfinite(weather.sample((0, 0, 0)).light)


# Thunder


def test_thunder_comes_later_by_the_distance_and_in_order(weather: Weather) -> None:
    near = esper.create_entity(Observer((0.0, 0.0, 0.0)))
    far = esper.create_entity(Observer((0.0, 0.0, 3400.0)))
    beyond = esper.create_entity(Observer((0.0, 0.0, 30_000.0)))
    told = Listener()
    times: list[tuple[int, float]] = []

    def hear(observer: int, strike: Strike, distance: float) -> None:
        times.append((observer, weather.stats.time))

    esper.set_handler("thunder", hear)
    weather.strike((0.0, 0.0, -680.0), origin=(0.0, 1000.0, -680.0))
    let_pass(40.0, 0.05)
    (strike,) = told.strikes
    heard = {each.observer: each for each in told.log[0][2]}
    assert heard[near].delay == pytest.approx(2.0)
    assert heard[far].distance == pytest.approx(4080.0)
    assert strike.delay((0.0, 0.0, 3400.0)) == pytest.approx(12.0)
    assert [observer for observer, _ in times] == [near, far]
    assert beyond in heard  # who is told of the distance, but hears nothing
    for observer, time in times:
        assert time - strike.time == pytest.approx(heard[observer].delay, abs=0.051)


def test_a_strike_on_an_observer_is_heard_at_once(weather: Weather) -> None:
    place = (5.0, 1.7, -3.0)
    observer = esper.create_entity(Observer(place))
    told = Listener()
    weather.strike(place)
    esper.process(0.05)
    assert [entry[0] for entry in told.log] == ["strike", "thunder"]
    assert told.log[0][2][0] == (observer, 0.0, 0.0)
    assert told.log[1] == ("thunder", observer, 0, 0.0)
    assert math.isfinite(weather.sample(place).light)
    told.log.clear()
    let_pass(5.0, 1.0)
    assert told.log == []


def test_an_observer_who_has_gone_hears_nothing(weather: Weather) -> None:
    observer = esper.create_entity(Observer((0.0, 0.0, 0.0)))
    told = Listener()
    weather.strike((0.0, 0.0, -680.0))
    esper.process(0.05)
    esper.delete_entity(observer, immediate=True)
    let_pass(5.0, 1.0)
    assert [entry[0] for entry in told.log] == ["strike"]


def test_a_handler_that_raises_keeps_no_event_back(weather: Weather) -> None:
    told = Listener()

    def fail(strike: Strike, heard: tuple[Any, ...]) -> None:
        if strike.number == 0:
            raise RuntimeError("the game's own")

    esper.set_handler("strike", fail)
    weather.strike((0, 0, 0))
    weather.strike((9, 0, 0))
    with pytest.raises(RuntimeError):
        esper.process(0.1)
    esper.process(0.1)
    assert {strike.number for strike in told.strikes} >= {1}


# Light


def test_samples_know_the_flash(weather: Weather) -> None:
    place = (0.0, 0.0, 0.0)
    dark = weather.sample(place).light
    weather.strike((0.0, 0.0, -900.0), origin=(0.0, 1000.0, -900.0), current=30.0)
    esper.process(0.05)
    flash = lightning.course(weather._state.strikes.struck[0].word, True)
    seen = []
    for _ in range(60):
        esper.process(0.01)
        age = weather.stats.time - 0.05
        share = lightning.on_surface((0.0, 400.0, -900.0), place, (0.0, 1.0, 0.0))
        color = 0.2126 * 0.80 + 0.7152 * 0.88 + 0.0722 * 1.0
        wanted = 4.0 * lightning.intensity(flash, age) * color * share
        seen.append(weather.sample(place).light - dark)
        assert seen[-1] == pytest.approx(wanted, abs=1e-9)
    assert max(seen) > 1.0
    assert weather.sample((0.0, 0.0, 20_000.0)).light == pytest.approx(dark, abs=0.05)
    let_pass(3.0, 1.0)
    assert weather.sample(place).light == dark
