"""Snapshots: exact, the same everywhere, and never half applied."""

from __future__ import annotations

from pathlib import Path

import esper
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.snapshots import build, components, in_another_process
from tests.worlds import fresh_world
from weather_ecs import Weather
from weather_ecs.components import (
    Observer,
    Occluder,
    PointLight,
    RainArea,
    RainContainer,
    Sun,
    Wind,
)

pytestmark = pytest.mark.usefixtures("world")

ROOT = Path(__file__).resolve().parent.parent
TIMES = [0.016, 0.4, 0.0, 2.7, 1 / 3, 11.0, 0.05]


def test_a_snapshot_is_small_and_taking_it_changes_nothing():
    weather = Weather(seed=3)
    build()
    esper.process(0.37)
    first = weather.snapshot()
    assert len(first) < 3000
    assert first[:4] == b"WECS"
    assert weather.snapshot() == first


def test_restored_into_an_empty_world_it_goes_on_alike():
    weather = Weather(seed=3)
    build()
    esper.process(0.37)
    weather.paused, weather.speed = False, 1.7
    data = weather.snapshot()
    with fresh_world(), Weather(seed=99) as twin:
        esper.create_entity()  # ids differ
        esper.create_entity(Observer())
        twin.restore(data)
        assert twin.snapshot() == data
        assert twin.speed == 1.7
        mine = []
        for dt in TIMES:
            esper.process(dt)
            mine.append(twin.snapshot())
        rates = [twin.sample((x, 0, 0)).rain_rate for x in range(20)]
    for dt, expected in zip(TIMES, mine, strict=True):
        esper.process(dt)
        assert weather.snapshot() == expected
    assert [weather.sample((x, 0, 0)).rain_rate for x in range(20)] == rates


def test_another_process_without_opengl_gets_the_same_bytes():
    weather = Weather(seed=3)
    build()
    esper.process(0.37)
    start = weather.snapshot()
    for dt in TIMES:
        esper.process(dt)
        assert weather.stats.frame
    assert in_another_process(start, TIMES) == weather.snapshot()


def test_living_entities_keep_their_components_and_others_come_and_go():
    weather = Weather()
    kept, changed = RainArea((1, 1), (5, 4)), RainArea((2, 2), (5, 4), 8.0)
    esper.create_entity(kept)
    entity = esper.create_entity(changed, Wind((1, 0), 2.0))
    gone = esper.create_entity(RainArea((3, 3), (5, 4), 33.0), Observer())
    lost = esper.create_entity(Sun())
    data = weather.snapshot()
    changed.rain_rate = 99.0
    esper.add_component(entity, PointLight())
    esper.remove_component(entity, Wind)
    esper.remove_component(gone, RainArea)
    esper.delete_entity(lost)
    new = esper.create_entity(RainContainer())
    mixed = esper.create_entity(RainArea((9, 9), (5, 4)), Observer((1, 2, 3)))
    weather.restore(data)
    assert esper.component_for_entity(entity, RainArea) is changed
    assert changed.rain_rate == 8.0
    assert not esper.has_component(entity, PointLight)
    assert esper.component_for_entity(entity, Wind).speed == 2.0
    assert not esper.entity_exists(new)
    assert esper.entity_exists(mixed)
    assert not esper.has_component(mixed, RainArea)
    assert esper.component_for_entity(mixed, Observer).position == (1.0, 2.0, 3.0)
    assert weather.sample((3, 0, 3)).rain_rate == pytest.approx(33.0 + 8.0 + 5.0, rel=0.5)
    assert weather.snapshot() == data
    esper.process(0.0)
    assert weather.snapshot() == data
    assert len(esper.get_component(Sun)) == 1


def test_what_belongs_to_the_game_is_left_alone():
    weather = Weather()
    build()
    empty = weather.snapshot()
    roof = Occluder(np.eye(3), [0, 1, 2])
    esper.create_entity(roof, Observer((7, 8, 9)))
    esper.create_entity("a component of the game")
    assert weather.snapshot() == empty
    weather.restore(empty)
    assert esper.get_component(Occluder)[0][1] is roof
    assert esper.get_component(Observer)[0][1].position == (7.0, 8.0, 9.0)
    assert esper.get_component(str)


def test_the_generator_goes_on_where_it_was():
    weather = Weather(seed=11)
    weather._state.rng.random(5)
    weather._state.rng.integers(0, 7, dtype=np.uint32)
    data = weather.snapshot()
    expected = weather._state.rng.random(4).tolist()
    weather.restore(data)
    assert weather._state.rng.random(4).tolist() == expected
    with fresh_world(), Weather() as other:
        other.restore(data)
        assert other._state.seed == 11
        assert other._state.rng.random(4).tolist() == expected


def test_entities_made_after_a_restore_get_the_same_numbers():
    weather = Weather()
    build()
    data = weather.snapshot()

    def go_on() -> bytes:
        esper.create_entity(RainArea((0, 0), (3, 2), drift=1.0))
        esper.process(0.4)
        esper.delete_entity(esper.create_entity(Wind()))
        esper.process(0.4)
        return weather.snapshot()

    first = go_on()
    weather.restore(data)
    assert go_on() == first


numbers = st.floats(-1e7, 1e7)


@settings(deadline=None, max_examples=60, suppress_health_check=[HealthCheck.too_slow])
@given(
    st.lists(
        st.builds(
            RainArea,
            st.tuples(numbers, numbers),
            st.tuples(st.floats(1e-3, 1e6), st.floats(1e-3, 1e6)).map(lambda r: (max(r), min(r))),
            st.floats(0, 1e4),
            st.floats(allow_nan=False, allow_infinity=False),
            st.floats(0, 1e6),
            st.floats(-1e5, 1e5),
            st.tuples(st.floats(-150, 150), st.floats(-150, 150)),
            st.floats(0, 1),
        ),
        max_size=4,
    ),
    st.lists(st.builds(Wind, st.tuples(numbers, numbers).filter(any), st.floats(0, 150))),
    st.integers(0, 2**63 - 1),
    st.floats(0, 10),
)
def test_every_bit_comes_back(areas, winds, seed, dt):
    with fresh_world(), Weather(seed=seed) as weather:
        for component in [*areas, *winds]:
            esper.create_entity(component)
        esper.process(dt)
        data, before = weather.snapshot(), components()
        esper.process(3.3)
        weather.restore(data)
        assert components() == before
        assert weather.snapshot() == data
    with fresh_world(), Weather() as weather:
        weather.restore(data)
        assert weather.snapshot() == data
