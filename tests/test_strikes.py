"""Flashes of clouds: how often, whatever the frames, and through snapshots."""

from __future__ import annotations

import json
import math
from collections.abc import Iterator
from typing import Any

import esper
import numpy as np
import pytest

from tests.cloud_worlds import model
from tests.strike_listener import Listener
from tests.worlds import fresh_world, let_pass
from weather_ecs import Weather, presets, snapshot
from weather_ecs.components import Climate, Cloud, Lightning, Observer, Wind
from weather_ecs.errors import SnapshotError


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


# How often


def test_flashes_are_a_poisson_process_at_the_model_s_rate(weather: Weather) -> None:
    storm(60.0)
    esper.create_entity(Lightning(most=600.0))
    told = Listener()
    let_pass(1201.0, 10.0)
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
        let_pass(seconds, 10.0)
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
    let_pass(60.0, 10.0)
    assert len(told.strikes) == 0  # no cumulonimbus is here yet
    climate.initial = 1.0
    esper.create_entity(Wind((1, 0), 0.0))
    let_pass(600.0, 10.0)
    assert len(told.strikes) > 0


def test_the_share_that_comes_down(weather: Weather) -> None:
    storm(600.0)
    own = Lightning(most=600.0, ground_share=0.3)
    esper.create_entity(own)
    esper.create_entity(Wind((1, 0), 0.0, ground=-20.0))
    told = Listener()
    let_pass(101.0, 10.0)
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
        let_pass(12.35, 0.65)
        data, told.log = weather.snapshot(), []
        light = weather.sample((0, 0, 0)).light
        let_pass(20.0, 0.5)
        wanted, after = told.log, weather.snapshot()
    with fresh_world(), Weather(seed=1) as weather:
        told = begin()
        weather.restore(data)
        assert weather.snapshot() == data
        assert weather.sample((0, 0, 0)).light == light
        let_pass(20.0, 2.0)
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
        lambda it: it["struck"][-1].__setitem__(1, 10_000),  # yet to come
        lambda it: it["due"].insert(0, [it["struck"][0], True]),  # long over
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
