"""Layers of clouds: how they start, drift, come in and leave."""

from __future__ import annotations

from collections import Counter

import esper
import numpy as np
import pytest

from tests.cloud_worlds import drawn, four_skies, layer, places, record, seconds, skies_of, sky
from tests.worlds import fresh_world
from weather_ecs import Weather
from weather_ecs.components import Climate, Sky, Wind
from weather_ecs.physics.wind import height_share

pytestmark = pytest.mark.usefixtures("world")


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
