"""Skies in snapshots: small, exact, the same everywhere, and never half applied."""

from __future__ import annotations

import copy
import gc
import math
import random
import tracemalloc
from pathlib import Path
from typing import Any

import esper
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.cloud_worlds import drawn, four_skies, layer, model, places, record, seconds, sky
from tests.snapshots import in_another_process
from tests.worlds import fresh_world
from weather_ecs import Weather, snapshot
from weather_ecs.components import Climate, Cloud, RainArea, Sky, SkyLayer, Wind
from weather_ecs.errors import SnapshotError
from weather_ecs.systems.cloud_field import CloudField

pytestmark = pytest.mark.usefixtures("world")

ROOT = Path(__file__).resolve().parent.parent
TIMES = [0.016, 0.4, 7.0, 2.7, 1 / 3, 9.0, 0.05, 10.0]


def build() -> None:
    """Layers in wind and in calm, half-way from one sky to another, with rain."""
    rainy = (model("rainy", rain_rate=9.0), "cumulus")
    esper.create_entity(Wind((3, 1), 9.0, gustiness=0.5, exponent=0.15))
    esper.create_entity(Climate(duration=40.0))
    esper.create_entity(layer((*four_skies()[:3], Sky(1.0, rainy, count=20)), turnover=60.0))
    calm = layer(four_skies(15), base=4000.0, velocity=(0.0, 0.0), drift=0.0)
    esper.create_entity(calm, Climate(initial=1.0, final=0.0, duration=25.0))
    esper.create_entity(Cloud(rainy[0], (5.0, 900.0, 0.0), drift=0.4))


def halfway() -> tuple[Weather, bytes]:
    weather = Weather(seed=11)
    build()
    seconds(30.3, 1.01)
    return weather, weather.snapshot()


def test_halfway_through_a_change_it_goes_on_alike():
    weather, data = halfway()
    array = record(weather, 1).array
    assert (array.dying >= 0).any()
    assert weather._state.clouds.rain
    expected, rows = [], []
    for dt in TIMES:
        esper.process(dt)
        expected.append(weather.snapshot())
        rows.append(drawn(weather).clouds)
    with fresh_world(), Weather(seed=99) as twin:
        esper.create_entity(layer(four_skies()))  # goes
        esper.process(1.0)
        twin.restore(data)
        assert twin.snapshot() == data
        for dt, bytes_then, rows_then in zip(TIMES, expected, rows, strict=True):
            esper.process(dt)
            assert twin.snapshot() == bytes_then
            mine = drawn(twin).clouds
            assert sorted(mine["key"]) == sorted(rows_then["key"])
            assert mine["position"] == pytest.approx(rows_then["position"], abs=1e-9)
            assert mine["growth"] == pytest.approx(rows_then["growth"])


def test_another_process_without_opengl_gets_the_same_bytes():
    weather, start = halfway()
    for dt in TIMES:
        esper.process(dt)
        drawn(weather)  # looking changes nothing
    assert in_another_process(start, TIMES) == weather.snapshot()


def test_the_frames_do_not_show():
    ends = []
    for dts in ([0.05] * 400, [1 / 3] * 60, [5.0] * 4, [0.01] * 1000 + [10.0]):
        with fresh_world(), Weather(seed=2) as weather:
            build()
            for dt in dts:
                esper.process(dt)
            weather._state.clock.remainder = 0.0
            ends.append(weather.snapshot())
    assert len(set(ends)) == 1


def test_a_thousand_clouds_take_a_few_kilobytes():
    weather = Weather(seed=4)
    bare = len(weather.snapshot())
    skies = tuple([sky(state, 1000, "a", "b", generated=10) for state in (0.0, 0.5, 1.0)])
    esper.create_entity(Climate(duration=200.0))
    size = (20_000.0, 20_000.0)
    esper.create_entity(layer(skies, size=size, velocity=(60.0, 25.0)))
    seconds(150.0)
    assert record(weather).array.standing == pytest.approx(1000, abs=30)
    assert len(weather.snapshot()) - bare < 7000


def test_restoring_in_the_middle_of_a_picture_shows_the_other_sky_at_once():
    weather, data = halfway()
    then = drawn(weather).clouds
    seconds(60.0)
    drawn(weather)
    weather.restore(data)
    now = drawn(weather).clouds
    assert sorted(now["key"]) == sorted(then["key"])


# Nothing in a snapshot is trusted


def document() -> dict[str, Any]:
    with fresh_world():
        weather, _ = halfway()
        found = snapshot.capture(weather._state)
        weather.close()
        return found["clouds"]


CLOUDS = document()


def test_the_document_comes_back_as_it_was():
    assert CloudField.from_state(copy.deepcopy(CLOUDS), 11).state() == CLOUDS


def changed(path: list[Any], value: Any) -> dict[str, Any]:
    other = copy.deepcopy(CLOUDS)
    place: Any = other
    for step in path[:-1]:
        place = place[step]
    place[path[-1]] = value
    return other


LAYER = ["layers", 0]


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (["layers"], {}),
        ([*LAYER, "box"], [0, 0, 0, 5]),
        ([*LAYER, "box"], [0, 0, 5]),
        ([*LAYER, "box", 0], math.nan),
        ([*LAYER, "change"], -1.0),
        ([*LAYER, "due"], "1"),
        ([*LAYER, "offset"], [1e300, 0]),
        ([*LAYER, "velocity"], [0]),
        ([*LAYER, "wind"], None),
        ([*LAYER, "serial"], 1),
        ([*LAYER, "serial"], -5),
        ([*LAYER, "ticks"], 1.5),
        ([*LAYER, "ticks"], 0),
        ([*LAYER, "uid"], 10**30),
        ([*LAYER, "uid"], 7),
        ([*LAYER, "least"], 2**53),
        ([*LAYER, "known"], [[0.5]]),
        ([*LAYER, "known"], [[5, "a"]]),
        ([*LAYER, "clouds", "count"], 10**9),
        ([*LAYER, "clouds", "count"], 3),
        ([*LAYER, "clouds", "columns"], "?"),
        ([*LAYER, "clouds", "columns"], 5),
        ([*LAYER, "clouds", "kinds"], []),
        ([*LAYER, "clouds", "kinds", 0], [0.5, "a" * 65, 0]),
        ([*LAYER, "clouds", "kinds", 0], [0.5, "a", 10**6]),
        ([*LAYER, "clouds", "low"], [0.5, 1]),
        ([*LAYER, "chooser"], {}),
        ([*LAYER, "chooser", "skies"], [[0.5, math.inf]]),
        ([*LAYER, "chooser", "numbers"], [[0.5, "a"]]),
        ([*LAYER, "more"], 1),
        (["rain"], [[0, 0]]),
        (["rain"], [[5, 0, 1], [4, 0, 2]]),
        (["rain"], [[4, 0, 1], [4, 1, 1]]),
        (["rain"], [[4, -2, 1]]),
    ],
)
def test_what_is_not_sound_is_refused_and_changes_nothing(path, value):
    weather, data = halfway()
    whole = snapshot.decode(data)
    whole["clouds"] = changed(path, value)
    with pytest.raises(SnapshotError):
        weather.restore(_encoded(whole))
    assert weather.snapshot() == data


def _encoded(whole: dict[str, Any]) -> bytes:
    try:
        return snapshot.encode(whole)
    except ValueError:  # not even JSON
        return b"WECS"


def _paths(value: Any, path: tuple[Any, ...] = ()) -> list[tuple[Any, ...]]:
    below: list[tuple[Any, ...]] = [path] if path else []
    if isinstance(value, dict):
        below += [p for key in value for p in _paths(value[key], (*path, key))]
    elif isinstance(value, list):
        below += [p for k, item in enumerate(value) for p in _paths(item, (*path, k))]
    return below


junk = st.one_of(
    st.none(),
    st.integers(-3, 70),
    st.integers(),
    st.floats(allow_nan=False, allow_infinity=False),
    st.text(max_size=5),
    st.lists(st.integers(0, 3), max_size=4),
)


@settings(max_examples=50, deadline=None, suppress_health_check=list(HealthCheck))
@given(st.sampled_from(_paths(CLOUDS)), junk)
def test_any_change_is_refused_or_is_a_sound_sky(path, value):
    with fresh_world(), Weather() as weather:
        build()
        whole = snapshot.capture(weather._state)
        whole["clouds"] = changed(list(path), value)
        try:
            weather.restore(snapshot.encode(whole))
        except SnapshotError:
            return
        for dt in (0.05, 1.0, 3.0):
            esper.process(dt)
            assert len(drawn(weather).clouds) < 500
            snapshot.load(snapshot.decode(weather.snapshot()))


# Soak


def test_any_dt_for_an_hour_keeps_everything_finite():
    weather, chance = Weather(seed=8), random.Random(3)
    build()
    climate = esper.get_component(Climate)[0][1]
    layers = [each for _, each in esper.get_component(SkyLayer)]
    esper.process(0.05)
    for number in range(250):
        esper.process(chance.choice([0.0, 0.001, 0.3, 4.0, 10.0]) * chance.random() * 2.0)
        if number % 12 == 0:
            climate.speed = chance.choice([-3.0, 0.0, 1.0, 50.0])
            layers[0].velocity = (chance.uniform(-60, 60), chance.uniform(-60, 60))
            layers[1].center = (chance.uniform(-300, 300), chance.uniform(-300, 300))
            layers[1].turnover = chance.choice([0.0, 5.0, 500.0])
        rows = drawn(weather).clouds
        assert all(np.isfinite(rows[name]).all() for name in rows.dtype.names)
        assert len(rows) < 300
        assert np.abs(places(record(weather))).max(initial=0.0) < 1500.0
        assert len(esper.get_component(RainArea)) <= 32
    data = weather.snapshot()
    weather.restore(data)
    assert weather.snapshot() == data


def test_memory_stays_where_it_was():
    weather = Weather()
    skies = four_skies()

    def lives(count: int) -> None:
        for number in range(count):
            entity = esper.create_entity(layer(skies, center=(float(number), 0.0)))
            cloud = esper.create_entity(Cloud(skies[0].models[0], (0, 500, 0), number=number % 5))
            seconds(2.0)
            drawn(weather)
            esper.delete_entity(entity)
            esper.delete_entity(cloud)
        seconds(60.0, 10.0)
        drawn(weather)

    lives(30)
    gc.collect()
    tracemalloc.start()
    lives(5)
    gc.collect()
    before = tracemalloc.get_traced_memory()[0]
    lives(60)
    gc.collect()
    grown = tracemalloc.get_traced_memory()[0] - before
    tracemalloc.stop()
    assert grown < 60_000
