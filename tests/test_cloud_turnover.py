"""Clouds that change where they stand, and the rectangles they stand in."""

from __future__ import annotations

from collections import Counter

import esper
import numpy as np
import pytest

from tests.cloud_worlds import drawn, four_skies, layer, places, record, seconds, skies_of, sky
from weather_ecs import Weather
from weather_ecs.components import Climate, Sky
from weather_ecs.systems.cloud_layer import FORMING
from weather_ecs.systems.cloud_mix import mix_at

pytestmark = pytest.mark.usefixtures("world")


# What changes in place


def test_in_calm_air_clouds_form_dissolve_and_turn_into_others_where_they_are():
    weather = Weather(seed=3)
    esper.create_entity(Climate(duration=30.0))
    esper.create_entity(layer((sky(0.0, 20), sky(1.0, 30)), velocity=(0.0, 0.0)))
    esper.process(0.05)
    start = {tuple(place) for place in places(record(weather))}
    growths, modes, here = [], set(), 0
    for _ in range(150):
        esper.process(1.0)
        rows = drawn(weather).clouds
        growths += rows["growth"].tolist()
        modes |= set(rows["mode"][rows["growth"] < 1.0].tolist())
        of = record(weather)
        young = places(of)[of.array.born >= 0]
        here = max(here, sum(tuple(place) in start for place in young))
    assert {0.0, 1.0} == modes
    assert any(0.2 < growth < 0.8 for growth in growths)
    assert here >= 10  # formed where another stood
    of = record(weather)
    seconds(FORMING + 1)
    assert Counter(skies_of(of).values()) == {1.0: 30}
    assert len(of.array) == 30
    assert drawn(weather).clouds["growth"].min() == 1.0


def test_a_calm_sky_that_does_not_change_stands_still():
    weather = Weather()
    esper.create_entity(layer(four_skies(), velocity=(0.0, 0.0)))
    esper.process(0.05)
    before, version = places(record(weather)), record(weather).array.version
    seconds(600.0, 5.0)
    assert np.array_equal(places(record(weather)), before)
    assert record(weather).array.version == version


def test_with_a_turnover_clouds_live_and_die_in_the_wind_too():
    weather = Weather()
    size = (50_000.0, 50_000.0)
    esper.create_entity(layer(four_skies(), velocity=(5.0, 0.0), turnover=100.0, size=size))
    esper.process(0.05)
    start = set(skies_of(record(weather)))
    seconds(130.0)
    of = record(weather)
    assert of.array.standing == 40
    assert len(start & set(skies_of(of))) <= 2
    assert (of.array.dying >= 0).any()
    assert len(of.array) <= 40 + 40 * (FORMING + 2) / 100.0


def test_the_shortest_turnover_there_is_takes_no_longer_and_keeps_the_number():
    weather = Weather()
    esper.create_entity(layer(four_skies(), velocity=(5.0, 0.0), turnover=1e-6))
    seconds(2.0 * FORMING)
    of = record(weather)
    assert of.array.standing == 40
    assert of.serial < 40 + 3 * 40  # and not a million a second


def test_very_many_clouds_come_at_once_without_looking_for_room_one_by_one():
    weather = Weather(seed=2)
    wide = layer((Sky(0.0, ["cumulus"], count=20_000),), velocity=(0.0, 0.0), size=(1e6, 1e6))
    esper.create_entity(wide)
    esper.process(0.05)
    wide.skies = (Sky(0.0, ["stratus"], count=20_000),)
    calls: list[int] = []
    with pytest.MonkeyPatch.context() as patch:
        patch.setattr("weather_ecs.systems.cloud_layer.apart", lambda *_: calls.append(1) or 0)
        seconds(1.0)
    of = record(weather)
    assert of.array.standing == 20_000
    assert {of.array.kinds[k].model for k in of.array.kind[of.array.dying < 0]} == {"stratus"}
    assert len(calls) < 300
    halves = np.count_nonzero(places(of)[of.array.dying < 0] < 0.0, axis=0)
    assert (np.abs(halves - 10_000) < 300).all()


def test_a_layer_is_completed_to_the_number_of_its_mix():
    before, after = sky(0.0, 40, "a"), sky(1.0, 24, "b")
    esper.create_entity(layer((before,), velocity=(0.0, 0.0)))
    weather = Weather()
    seconds(2.0)
    clouds = record(weather)
    assert clouds.array.standing == 40
    clouds.complete(mix_at((before, after), 0.5))  # 32, half of each sky
    assert clouds.array.standing == 32
    assert len(clouds.array) == 40  # eight are dissolving
    clouds.complete(mix_at((after,), 1.0))
    assert clouds.array.standing == 24
    clouds.complete(mix_at((before,), 0.0))
    assert clouds.array.standing == 40 and clouds.array.count_of(0.0) == 40


# Rectangles


def test_the_rectangle_may_follow_an_observer():
    weather = Weather(seed=6)
    sky_layer = layer(four_skies(), velocity=(0.0, 0.0))
    esper.create_entity(sky_layer)
    for second in range(200):
        sky_layer.center = (30.0 * second, -10.0 * second)
        esper.process(1.0)
        at = places(record(weather)) - sky_layer.center
        assert (abs(at) <= (1001.0, 501.0)).all()
    assert record(weather).array.standing == 40
    ahead = np.histogram(at[:, 0], 4, (-1000.0, 1000.0))[0]
    assert ahead.min() >= 3
    sky_layer.center = (1e6, 1e6)  # put elsewhere at once
    esper.process(1.0)
    at = places(record(weather)) - sky_layer.center
    assert len(at) == 40
    assert (abs(at) <= (1001.0, 501.0)).all()
    assert np.ptp(at[:, 0]) > 1500.0


@pytest.mark.parametrize("size", [(200.0, 200.0), (200.0, 1e4), (1e7, 1e7)])
def test_a_rectangle_as_small_as_its_clouds_holds_them(size):
    weather = Weather()
    esper.create_entity(layer(four_skies(), size=size, velocity=(150.0, -150.0)))
    seconds(20.0)
    rows = drawn(weather).clouds
    assert record(weather).array.standing == len(rows) == 40
    assert all(np.isfinite(rows[name]).all() for name in rows.dtype.names)
    assert (rows["opacity"] >= 0.0).all()


def test_clouds_fade_at_the_rectangles_edge():
    weather = Weather(seed=8)
    esper.create_entity(layer(four_skies(400)))
    esper.process(0.05)
    rows = drawn(weather).clouds
    edge = np.minimum(1000.0 - abs(rows["position"][:, 0]), 500.0 - abs(rows["position"][:, 2]))
    assert (rows["opacity"][edge > 70.0] == 1.0).all()
    assert (rows["opacity"][edge < 20.0] < 0.3).all()
    assert np.count_nonzero(edge < 20.0) > 5
