"""Strikes of clouds and of the game: when, where, who is told; steps, servers, snapshots."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from typing import Any

import esper
import numpy as np
import pytest

from tests.cloud_worlds import model
from tests.worlds import fresh_world
from weather_ecs import Weather, presets, snapshot
from weather_ecs.components import Climate, Cloud, Lightning, Observer, Occluder, Wind
from weather_ecs.errors import ClosedError, InvalidValueError, SnapshotError
from weather_ecs.physics import lightning
from weather_ecs.systems.strikes import Strike


class Listener:
    """What has been told, in order."""

    def __init__(self) -> None:
        self.log: list[tuple[Any, ...]] = []
        esper.set_handler("strike", self.strike)
        esper.set_handler("thunder", self.thunder)

    def strike(self, strike: Strike, heard: tuple[Any, ...]) -> None:
        self.log.append(("strike", strike, heard))

    def thunder(self, observer: int, strike: Strike, distance: float) -> None:
        self.log.append(("thunder", observer, strike.number, distance))

    @property
    def strikes(self) -> list[Strike]:
        return [entry[1] for entry in self.log if entry[0] == "strike"]


@pytest.fixture
def weather() -> Iterator[Weather]:
    with fresh_world(), Weather(seed=11) as it:
        yield it


def storm(rate: float = 60.0, **fields: Any) -> Cloud:
    """One cloud that flashes `rate` times a minute."""
    cloud = Cloud(
        model("storm", 2000.0, lightning=rate), (0.0, 900.0, -3000.0), drift=0.0, **fields
    )
    esper.create_entity(cloud)
    return cloud


def run(seconds: float, dt: float = 1.0) -> None:
    for _ in range(round(seconds / dt)):
        esper.process(dt)


# How often


def test_flashes_are_a_poisson_process_at_the_model_s_rate(weather: Weather) -> None:
    storm(60.0)
    esper.create_entity(Lightning(most=600.0))
    told = Listener()
    run(1201.0, 10.0)
    times = np.array([strike.time for strike in told.strikes])
    assert abs(len(times) - 1200) < 4.0 * math.sqrt(1200)
    gaps = np.diff(times)
    # Exponential: as wide as it is long, but for the steps it is counted in.
    assert gaps.std() == pytest.approx(gaps.mean(), rel=0.15)
    counts = np.histogram(times, np.arange(1.0, 1201.0, 5.0))[0]
    assert counts.var() == pytest.approx(counts.mean(), rel=0.35)
    assert len({strike.step % 20 for strike in told.strikes}) == 20


def test_the_rate_follows_the_cloud_and_the_component(weather: Weather) -> None:
    cloud = storm(300.0, growth=0.5)
    own = Lightning(most=600.0)
    esper.create_entity(own)
    told = Listener()

    def count(seconds: float = 100.0) -> int:
        before = len(told.strikes)
        run(seconds, 10.0)
        return len(told.strikes) - before

    count(10.0)
    assert abs(count() - 125) < 50  # a quarter of 500
    own.rate = 2.0
    assert abs(count() - 250) < 70
    own.most = 30.0
    assert abs(count() - 50) < 30
    own.rate = 0.0
    count(1.0)
    assert count() == 0
    own.rate, cloud.growth = 1.0, 0.0
    assert count() == 0


def test_a_storm_that_comes_flashes_late(weather: Weather) -> None:
    for layer in presets.sky("storm").layers:
        esper.create_entity(layer)
    climate = Climate(initial=0.3, final=1.0, duration=1e9, running=False)
    esper.create_entity(climate)
    esper.create_entity(Lightning(most=600.0))
    told = Listener()
    run(60.0, 10.0)
    assert len(told.strikes) == 0  # no cumulonimbus is here yet
    climate.initial = 1.0
    esper.create_entity(Wind((1, 0), 0.0))
    run(600.0, 10.0)
    assert len(told.strikes) > 0


def test_the_share_that_comes_down(weather: Weather) -> None:
    storm(600.0)
    own = Lightning(most=600.0, ground_share=0.3)
    esper.create_entity(own)
    esper.create_entity(Wind((1, 0), 0.0, ground=-20.0))
    told = Listener()
    run(101.0, 10.0)
    found = told.strikes
    ground = [strike for strike in found if strike.ground]
    assert len(ground) / len(found) == pytest.approx(0.3, abs=0.06)
    assert {strike.target[1] for strike in ground} == {-20.0}
    for strike in found:
        x, y, z = strike.origin
        assert abs(x) < 5000.0
        assert 700.0 < y < 6000.0
        assert abs(z + 3000.0) < 5000.0
        if not strike.ground:
            assert strike.target[1] > 700.0


# Steps, servers, snapshots


def tale(seed: int, dts: list[float]) -> list[tuple[Any, ...]]:
    with fresh_world(), Weather(seed=seed) as weather:
        storm(40.0)
        esper.create_entity(Lightning(most=600.0))
        esper.create_entity(Observer((0.0, 2.0, 0.0)))
        told = Listener()
        weather.strike((400.0, 0.0, -500.0))
        for dt in dts:
            esper.process(dt)
        return told.log


def test_frames_of_any_length_tell_the_same(weather: Weather) -> None:
    whole = tale(3, [10.0] * 3)
    assert len(whole) > 20
    assert {entry[0] for entry in whole} == {"strike", "thunder"}
    assert tale(3, [0.05] * 600) == whole
    assert tale(3, [0.35, 1.65, 3.0, 0.016, 4.984, 10.0, 10.0]) == whole
    assert tale(4, [10.0] * 3) != whole


def test_a_snapshot_goes_on_to_the_same_strikes_and_thunder() -> None:
    def begin() -> Listener:
        esper.create_entity(Observer((0.0, 2.0, 0.0)))
        return Listener()

    with fresh_world(), Weather(seed=8) as weather:
        told = begin()
        storm(40.0)
        run(12.35, 0.65)
        data, told.log = weather.snapshot(), []
        light = weather.sample((0, 0, 0)).light
        run(20.0, 0.5)
        wanted, after = told.log, weather.snapshot()
    with fresh_world(), Weather(seed=1) as weather:
        told = begin()
        weather.restore(data)
        assert weather.snapshot() == data
        assert weather.sample((0, 0, 0)).light == light
        run(20.0, 2.0)
        assert weather.snapshot() == after
        kept = [entry for entry in wanted if entry[0] == "strike"]
        # Entities have other numbers here.
        assert [e[1] for e in told.log if e[0] == "strike"] == [e[1] for e in kept]
        assert [e[2:] for e in told.log if e[0] == "thunder"] == [
            e[2:] for e in wanted if e[0] == "thunder"
        ]
        assert any(e[0] == "thunder" for e in wanted)


@pytest.mark.parametrize(
    "change",
    [
        lambda it: it.pop("due"),
        lambda it: it.update(following=-1),
        lambda it: it.update(struck={}),
        lambda it: it["struck"].append(it["struck"][0]),
        lambda it: it["struck"][0].pop(),
        lambda it: it["struck"][0].__setitem__(0, 99),
        lambda it: it["struck"][0].__setitem__(2, [0.0, 1e9, 0.0]),
        lambda it: it["struck"][0].__setitem__(4, "strong"),
        lambda it: it["struck"][0].__setitem__(5, 1),
        lambda it: it["struck"][0].__setitem__(6, 2**63),
        lambda it: it.update(due=[it["struck"][0]]),
        lambda it: it.update(struck=it["struck"] * 2000),
    ],
)
def test_a_snapshot_with_bad_strikes_is_refused(weather: Weather, change: Any) -> None:
    weather.strike((0, 0, 0))
    esper.process(0.1)
    document = snapshot.decode(weather.snapshot())
    change(document["lightning"])
    with pytest.raises(SnapshotError):
        weather.restore(snapshot.encode(json.loads(json.dumps(document))))


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
    run(1.0, 0.1)
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
    run(40.0, 0.05)
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
    run(5.0)
    assert told.log == []


def test_an_observer_who_has_gone_hears_nothing(weather: Weather) -> None:
    observer = esper.create_entity(Observer((0.0, 0.0, 0.0)))
    told = Listener()
    weather.strike((0.0, 0.0, -680.0))
    esper.process(0.05)
    esper.delete_entity(observer, immediate=True)
    run(5.0)
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
    run(3.0)
    assert weather.sample(place).light == dark
