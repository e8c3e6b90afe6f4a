"""Layers that a game changes, clouds of its own, and wind that bends them."""

from __future__ import annotations

import math

import esper
import numpy as np
import pytest

from tests.cloud_worlds import drawn, four_skies, layer, places, record, seconds, skies_of, sky
from tests.worlds import fresh_world
from weather_ecs import Weather
from weather_ecs.components import Cloud, Sky, SkyLayer, Wind
from weather_ecs.systems.cloud_layer import FORMING

pytestmark = pytest.mark.usefixtures("world")


# Layers and skies that a game changes


def test_layers_do_not_know_of_each_other():
    alone = []
    for others in (0, 3):
        with fresh_world(), Weather(seed=7) as weather:
            esper.create_entity(layer(four_skies()))
            for number in range(others):
                esper.create_entity(layer(four_skies(), base=3000.0 * number))
            seconds(50.0)
            alone.append(places(record(weather)))
            assert weather.stats.clouds == 40 * (1 + others)
    assert np.array_equal(*alone)


def test_other_skies_come_in_place_of_those_there_were():
    weather = Weather()
    sky_layer = layer(four_skies(), velocity=(1.0, 0.0))
    esper.create_entity(sky_layer)
    seconds(3.0)
    drawn(weather)
    old = set(skies_of(record(weather)))
    sky_layer.skies = (sky(0.0, 25, "new"),)
    seconds(2.0)
    of = record(weather)
    assert of.array.standing == 25
    assert not old & set(skies_of(of))
    rows = drawn(weather).clouds
    assert len(rows) > 25  # the old ones are still dissolving
    new = np.isin(rows["key"] & 0xFFFF, of.array.serial)
    assert np.count_nonzero(new) == 25
    assert rows["growth"][new].max() < 0.1
    assert rows["growth"][~new].max() == 1.0
    seconds(2.0)
    assert drawn(weather).clouds["growth"].max() < 1.0
    seconds(FORMING + 2)
    rows = drawn(weather).clouds
    assert len(rows) == 25
    assert rows["growth"].min() == 1.0


def test_a_layer_in_place_of_another_comes_as_that_goes():
    weather = Weather()
    first = esper.create_entity(layer(four_skies()))
    seconds(2.0)
    before = len(drawn(weather).clouds)
    esper.delete_entity(first)
    esper.create_entity(layer((sky(0.0, 30, "new"),)))
    seconds(1.0)
    rows = drawn(weather).clouds
    assert 30 < len(rows) <= before + 30
    assert np.count_nonzero(rows["growth"] == 0.0) == 30
    seconds(3.0)
    rows = drawn(weather).clouds
    assert 0.0 < rows["growth"].min() < rows["growth"].max() < 1.0
    seconds(FORMING + 2)
    assert len(drawn(weather).clouds) == 30
    assert drawn(weather).clouds["growth"].min() == 1.0


def test_a_game_without_layers_has_no_clouds_and_deletion_leaves_nothing():
    weather = Weather()
    assert len(drawn(weather).clouds) == 0
    for number in range(30):
        entity = esper.create_entity(layer((sky(0.0, 3, f"m {number}"),)))
        seconds(1.0)
        drawn(weather)
        esper.delete_entity(entity)
    seconds(FORMING + 2)
    frame = drawn(weather)
    assert len(frame.clouds) == 0
    assert frame.cloud_shapes == ()
    assert not weather._state.clouds.layers
    assert len(weather._state.cloud_shapes) <= 64
    assert weather.stats.clouds == 0


def test_unknown_names_are_left_out_with_one_line(caplog):
    weather = Weather()
    esper.create_entity(SkyLayer(skies=(Sky(0.0, ("no such cloud",), count=5),)))
    esper.create_entity(Cloud("no such cloud", (0, 1000, 0)))
    seconds(3.0)
    assert len(drawn(weather).clouds) == 0
    assert [r.message for r in caplog.records].count(caplog.records[0].message) == 1
    assert "no such cloud" in caplog.text


# Clouds of the game's own


def test_a_cloud_of_the_games_own_stands_beside_those_of_layers():
    weather = Weather()
    esper.create_entity(layer(four_skies(10)))
    cloud = Cloud(
        "at 0", (10.0, 500.0, 20.0), scale=2.0, velocity=(3.0, 0.0), growth=0.5, hollow=1.0
    )
    esper.create_entity(four_skies()[0].models[0])
    entity = esper.create_entity(cloud)
    esper.process(0.05)
    rows = drawn(weather).clouds
    assert len(rows) == 11
    [row] = rows[rows["scale"] == 2.0]
    shape = drawn(weather).cloud_shapes[row["shape"]]
    low = float((shape.centers - 0.5 * shape.sizes)[:, 1].min())
    assert row["position"] == pytest.approx((10.0 + 0.05 * 3.0, 500.0 - 2.0 * low, 20.0))
    assert (row["growth"], row["mode"], row["opacity"]) == (0.5, 1.0, 1.0)
    esper.process(0.5)
    [row] = drawn(weather).clouds[drawn(weather).clouds["scale"] == 2.0]
    assert row["position"][0] == pytest.approx(10.0 + 0.55 * 3.0)
    esper.process(9.45)
    assert cloud.position[0] == pytest.approx(10.0 + 10.0 * 3.0)
    assert weather.stats.clouds == 11
    esper.delete_entity(entity)
    assert len(drawn(weather).clouds) == 10


def test_the_games_clouds_drift_with_the_wind():
    Weather()
    esper.create_entity(Wind((0, 1), 6.0))
    cloud, still = Cloud("cumulus", (0, 900, 0), drift=0.5), Cloud("cumulus", (0, 0, 0), drift=0)
    esper.create_entity(cloud)
    esper.create_entity(still)
    seconds(20.0)
    assert cloud.position == pytest.approx((0.0, 900.0, 60.0))
    assert still.position == (0.0, 0.0, 0.0)


# Shear


def test_wind_that_grows_with_height_bends_clouds():
    weather = Weather()
    wind = Wind((1, 0), 10.0)
    esper.create_entity(wind)
    esper.create_entity(layer(four_skies(), velocity=(0.0, 0.0), base=500.0, shear=(0.0, 0.1)))
    esper.process(1.0)
    assert drawn(weather).clouds["shear"] == pytest.approx(np.array([[0.0, 0.1]] * 40))
    wind.exponent = 0.25
    esper.process(0.05)
    lean, across = drawn(weather).clouds["shear"][0]
    assert across == pytest.approx(0.1)
    assert 0.1 < lean < 0.5
    wind.speed = 150.0
    seconds(100.0)
    assert drawn(weather).clouds["shear"][0, 0] == pytest.approx(0.5)
    assert math.isfinite(float(drawn(weather).clouds["position"].max()))
