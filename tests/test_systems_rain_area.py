"""`RainAreaSystem`: areas move by themselves and with the wind."""

from __future__ import annotations

import esper
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.worlds import fresh_world
from weather_ecs.components import RainArea
from weather_ecs.systems import RainAreaSystem, WeatherState

pytestmark = pytest.mark.usefixtures("world")


def steps(area: RainArea, count: int, wind: tuple[float, float, float]) -> RainArea:
    with fresh_world():
        esper.create_entity(area)
        state, system = WeatherState(0), RainAreaSystem()
        state.wind = wind
        for _ in range(count):
            system.run(state)
    return area


@settings(deadline=None)
@given(
    st.tuples(st.floats(-150, 150), st.floats(-150, 150)),
    st.floats(0, 1),
    st.tuples(st.floats(-100, 100), st.just(0.0), st.floats(-100, 100)),
)
def test_an_area_goes_by_its_velocity_and_its_share_of_the_wind(velocity, drift, wind):
    area = RainArea((3, -4), (20, 10), velocity=velocity, drift=drift)
    steps(area, 20, wind)
    assert area.center == pytest.approx(
        (3 + velocity[0] + drift * wind[0], -4 + velocity[1] + drift * wind[2]), abs=1e-9
    )


def test_a_still_area_is_not_touched():
    area = RainArea((3, -4), (20, 10))
    center, before = area.center, RainArea.revision()
    steps(area, 5, (9.0, 0.0, 9.0))
    assert area.center is center
    assert RainArea.revision() == before


def test_at_the_end_of_the_world_areas_stop():
    area = RainArea((1e7 - 1, 0), (20, 10), velocity=(150, -150))
    steps(area, 100, (0.0, 0.0, 0.0))
    assert area.center[0] == 1e7
    assert RainArea(area.center, (2, 1)).center == area.center


def test_an_area_that_dies_stays_where_it_is():
    area = RainArea((0, 0), (20, 10), velocity=(1, 0))
    entity = esper.create_entity(area)
    esper.delete_entity(entity)
    RainAreaSystem().run(WeatherState(0))
    assert area.center == (0.0, 0.0)
