"""Layers of clouds: what stands in them, comes in, leaves and changes."""

from __future__ import annotations

import math
from collections import Counter

import esper
import numpy as np
import pytest

from tests.cloud_worlds import (
    drawn,
    four_skies,
    layer,
    places,
    record,
    seconds,
    skies_of,
    sky,
)
from tests.worlds import fresh_world
from weather_ecs import Weather
from weather_ecs.components import Climate, Cloud, Sky, SkyLayer, Wind
from weather_ecs.physics.chance import uniform, uniforms
from weather_ecs.physics.wind import height_share
from weather_ecs.systems.cloud_layer import FORMING
from weather_ecs.systems.cloud_mix import Chooser, Mix, mix_at, nearest_mix
from weather_ecs.systems.cloud_place import scattered

pytestmark = pytest.mark.usefixtures("world")


# Chance


def test_chance_is_the_same_in_any_order_and_uniform():
    numbers = np.arange(20_000)
    values = uniforms(numbers, 7, 3)
    assert [uniform(7, 3, n) for n in (0, 5, 19_999)] == values[[0, 5, 19_999]].tolist()
    assert np.array_equal(uniforms(numbers[::-1], 7, 3), values[::-1])
    counts = np.histogram(values, 20, (0.0, 1.0))[0]
    assert ((counts - 1000.0) ** 2 / 1000.0).sum() < 50.0  # chi squared, 19 degrees: p < 1e-4
    assert abs(np.corrcoef(values, uniforms(numbers, 7, 4))[0, 1]) < 0.03


@pytest.mark.parametrize(("count", "width", "depth"), [(1, 5, 5), (97, 4000, 900), (1000, 1, 1e7)])
def test_scattered_places_fill_a_rectangle_evenly(count, width, depth):
    found = scattered(count, width, depth, 3)
    assert found.shape == (count, 2)
    assert (np.abs(found) <= (0.5 * width, 0.5 * depth)).all()
    if count > 50:
        halves = np.count_nonzero(found < 0.0, axis=0)
        assert (np.abs(halves - count / 2) <= 0.15 * count).all()
    assert not np.array_equal(found, scattered(count, width, depth, 4))


# Shares


def test_the_worked_example_shares_what_comes_in_by_halves():
    mix = mix_at(four_skies(), 0.5)
    assert [(part.sky, part.share) for part in mix.parts] == [(0.25, 0.5), (0.75, 0.5)]
    chooser = Chooser()
    drawn_from = [chooser.take(mix).sky for _ in range(1000)]
    assert Counter(drawn_from) == {0.25: 500, 0.75: 500}


@pytest.mark.parametrize("state", [0.0, 0.03, 0.25, 0.4, 0.6, 0.98, 1.0])
def test_whatever_has_come_in_has_its_share_to_within_one(state):
    mix = mix_at(four_skies(), state)
    chooser, counts = Chooser(), Counter()
    for number in range(1, 200):
        counts[chooser.take(mix).sky] += 1
        for part in mix.parts:
            assert abs(counts[part.sky] - number * part.share) < 1.0
    assert set(counts) == {part.sky for part in mix.parts}


def test_models_and_numbers_have_their_shares_too():
    mix = mix_at([sky(0.5, 10, "a", "b", weights=(3, 1), generated=5)], 0.5)
    chooser = Chooser()
    kinds = [chooser.take(mix) for _ in range(400)]
    assert Counter(kind.model for kind in kinds) == {"a": 300, "b": 100}
    assert Counter(kind.number for kind in kinds if kind.model == "a") == dict.fromkeys(
        range(5), 60
    )


def test_a_model_that_is_named_twice_has_both_shares():
    mix = mix_at([Sky(0.5, ["cumulus", "stratus", "cumulus"], count=10)], 0.5)
    chooser = Chooser()
    drawn_names = Counter(chooser.take(mix).model for _ in range(3000))
    assert drawn_names == {"cumulus": 2000, "stratus": 1000}
    assert Chooser.from_state(chooser.state()).state() == chooser.state()


def test_a_sky_without_clouds_thins_the_other_out():
    skies = (Sky(0.0), sky(1.0, 100))
    assert mix_at(skies, 0.25) == Mix(25, mix_at(skies, 1.0).parts)
    assert mix_at(skies, 0.0) == Mix(0, ())
    assert mix_at((), 0.5) == nearest_mix((), 0.5) == Mix(0, ())
    assert nearest_mix(skies, 0.4).target == 0
    assert nearest_mix(skies, 0.6).target == 100
    assert nearest_mix(skies, 0.5).target == 0  # of two as near the clearer


# The start


def test_the_start_fills_the_rectangle_from_the_nearest_sky():
    weather = Weather(seed=5)
    esper.create_entity(Climate(initial=0.7, running=False))
    esper.create_entity(layer(four_skies(50), base=800.0, center=(300.0, -200.0)))
    frame = drawn(weather)
    x, y, z = frame.clouds["position"].T
    assert len(frame.clouds) == 50
    assert (abs(x - 300.0) <= 1001.0).all()
    assert (abs(z + 200.0) <= 501.0).all()
    shapes = [frame.cloud_shapes[k] for k in frame.clouds["shape"]]
    low = [float((s.centers - 0.5 * s.sizes)[:, 1].min()) for s in shapes]
    assert y + frame.clouds["scale"] * low == pytest.approx(800.0, abs=0.01)
    assert len(frame.cloud_shapes) == 4
    assert Counter(frame.clouds["shape"].tolist()).most_common()[-1][1] >= 12
    esper.process(0.05)  # what was shown before the first step is what the step made
    assert drawn(weather).clouds["key"].tolist() == frame.clouds["key"].tolist()
    assert set(skies_of(record(weather)).values()) == {0.75}
    assert weather.stats.clouds == 50


def test_other_seeds_and_other_layers_have_other_clouds():
    found = []
    for seed in (1, 1, 2):
        with fresh_world(), Weather(seed=seed) as weather:
            esper.create_entity(layer(four_skies()))
            esper.create_entity(layer(four_skies()))
            esper.process(0.05)
            found += [places(record(weather)), places(record(weather, 1))]
    assert np.array_equal(found[0], found[2])
    assert np.array_equal(found[1], found[3])
    assert not np.array_equal(found[0], found[1])
    assert not np.array_equal(found[0], found[4])


# Drift, coming in, leaving


def test_clouds_drift_with_the_wind_at_their_height():
    weather = Weather()
    esper.create_entity(Wind((0, 1), 4.0, exponent=0.2))
    esper.create_entity(layer(four_skies(), velocity=(3.0, 0.0), drift=0.5, base=1000.0))
    seconds(1.0, 0.05)
    before = drawn(weather)
    seconds(1.0, 0.25)
    now = drawn(weather)
    speed = (3.0, 0.0, 0.5 * 4.0 * float(height_share(1000.0, 10.0, 0.2)))
    old = {int(row["key"]): row for row in before.clouds}
    same = [(old[int(row["key"])], row) for row in now.clouds if int(row["key"]) in old]
    assert len(same) > 30
    for one, other in same:
        assert other["position"] - one["position"] == pytest.approx(speed, abs=1e-9)
        assert other["velocity"] == pytest.approx(speed)


def test_between_two_seconds_clouds_move_evenly():
    weather = Weather()
    esper.create_entity(layer(four_skies(), velocity=(7.0, -2.0), size=(9000.0, 9000.0)))
    esper.process(0.05)
    first = drawn(weather).clouds["position"].copy()
    for number in range(1, 200):
        esper.process(1 / 60)
        moved = drawn(weather).clouds["position"] - first
        assert moved == pytest.approx(np.array([[7.0, 0.0, -2.0]]) * number / 60 + 0 * moved)


@pytest.mark.parametrize("velocity", [(20.0, 0.0), (-20.0, 0.0), (0.0, 13.0), (9.0, -6.0)])
def test_one_that_leaves_is_gone_and_another_comes_in_upwind(velocity):
    weather = Weather(seed=2)
    esper.create_entity(layer(four_skies(), velocity=velocity))
    esper.process(0.05)
    known, upwind = set(skies_of(record(weather))), np.sign(velocity)
    came = 0
    for _ in range(150):
        esper.process(1.0)
        of = record(weather)
        at, reach = places(of), np.array([1000.0, 500.0])
        assert (abs(at) <= reach + 1.0).all()
        assert of.array.standing == 40
        for serial, place in zip(of.array.serial.tolist(), at, strict=True):
            if serial not in known:
                known.add(serial)
                came += 1
                # In the strip that one second has brought in, on a side that the wind blows from.
                deep = (reach + upwind * place)[upwind != 0]
                assert (deep <= np.abs(velocity)[upwind != 0] + 1.0).any()
    crossings = 150 * (abs(velocity[0]) / 2000.0 + abs(velocity[1]) / 1000.0)
    assert came == pytest.approx(40 * crossings, rel=0.2)


def test_only_what_comes_in_changes():
    weather = Weather(seed=4)
    esper.create_entity(Climate(duration=30.0))
    esper.create_entity(layer(four_skies()))
    esper.process(0.05)
    start = skies_of(record(weather))
    for _ in range(90):
        esper.process(1.0)
        for serial, of in skies_of(record(weather)).items():
            assert start.setdefault(serial, of) == of
    assert not (record(weather).array.dying >= 0).any()
    seconds(60.0)
    assert set(skies_of(record(weather)).values()) == {1.0}


def test_in_the_middle_of_a_run_half_comes_from_each_sky():
    weather = Weather(seed=4)
    esper.create_entity(Climate(initial=0.5, final=1.0, running=False))
    esper.create_entity(layer(four_skies(200)))
    esper.process(0.05)
    start = record(weather).serial
    seconds(120.0)
    came = [of for serial, of in skies_of(record(weather)).items() if serial >= start]
    assert len(came) == 200
    assert abs(came.count(0.25) - 100) <= 1


@pytest.mark.parametrize(("counts", "end"), [((20, 200), 200), ((200, 20), 20), ((0, 60), 60)])
def test_the_number_follows_the_sky_within_one_crossing(counts, end):
    weather = Weather(seed=9)
    skies = tuple([sky(k, count) for k, count in enumerate(counts)])
    esper.create_entity(Climate(duration=1e-9))
    esper.create_entity(layer(skies, velocity=(16.0, 5.0)))
    esper.process(0.05)
    assert record(weather).array.standing in counts
    seconds(130.0)
    assert record(weather).array.standing == pytest.approx(end, rel=0.08)
    seconds(130.0)
    assert record(weather).array.standing == pytest.approx(end, rel=0.03)
    # And they are spread over the whole rectangle, not bunched at its edge.
    x = places(record(weather))[:, 0]
    quarters = np.histogram(x, 4, (-1000.0, 1000.0))[0]
    assert quarters.min() > 0.1 * end


def test_to_a_clear_sky_all_leave():
    weather = Weather()
    esper.create_entity(Climate(initial=1.0, final=0.0, duration=10.0))
    esper.create_entity(layer((Sky(0.0), sky(1.0, 80))))
    seconds(125.0)
    assert record(weather).array.standing == 0
    assert len(drawn(weather).clouds) == 0


def test_the_wind_may_turn_round():
    weather = Weather(seed=1)
    wind = Wind((1, 0), 20.0)
    esper.create_entity(wind)
    esper.create_entity(layer(four_skies(), velocity=(0.0, 0.0)))
    seconds(10.0)
    wind.direction = (-1, 0)
    before = record(weather).serial
    seconds(200.0)
    of = record(weather)
    assert of.velocity[0] == pytest.approx(-20.0, abs=0.1)
    assert of.array.standing == 40
    assert of.serial > before
    seconds(1.0)
    newest = places(of)[-1]
    assert newest[0] > 900.0 or of.serial - before < 10


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
