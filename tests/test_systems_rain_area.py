"""`RainAreaSystem`: areas move by themselves and with the wind."""

from __future__ import annotations

import esper
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.worlds import fresh_world
from weather_ecs.clock import STEP
from weather_ecs.components import RainArea
from weather_ecs.components._base import FAR
from weather_ecs.frame import WindProfile
from weather_ecs.systems import RainAreaSystem, WeatherState
from weather_ecs.systems.rain_area import area_rows, drift_velocity, dry_spells
from weather_ecs.systems.rain_fronts import RainFronts

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


# The functions that others use


def test_the_wind_at_the_ceiling_carries_an_area() -> None:
    area = RainArea((0, 0), (20, 10), velocity=(1, -2), drift=0.5, ceiling=100.0)
    even = WindProfile(reference=10.0)
    assert drift_velocity(area, (4.0, 0.0, 8.0), even) == (3.0, 2.0)
    grows = WindProfile(reference=10.0, exponent=1 / 7, ground=-100.0)
    more = (200.0 / 10.0) ** (1 / 7)
    assert drift_velocity(area, (4.0, 0.0, 8.0), grows) == pytest.approx(
        (1.0 + 2.0 * more, -2.0 + 4.0 * more)
    )


def test_rows_have_what_falls_and_a_soft_edge_that_fits() -> None:
    fronts = RainFronts()
    area = RainArea((3, 4), (20, 10), 8.0, 0.3, 900.0, 400.0, onset=1.0)
    for _ in range(3):
        fronts.step([(7, area)])
    (row,) = area_rows([(7, area)], fronts)
    assert (row["key"], *row["center"], *row["radii"]) == (7, 3.0, 4.0, 20.0, 10.0)
    assert (row["rain_rate"], row["soft_edge"], row["ceiling"]) == (8.0, 10.0, 400.0)
    with pytest.raises(ValueError, match="read-only"):
        row["rain_rate"] = 1.0
    assert dry_spells([(7, area)], fronts, 0.0) == {}
    area.rain_rate = 0.0  # what fell before is still in the air
    fronts.step([(7, area)])
    assert area_rows([(7, area)], fronts)["rain_rate"] == [8.0]
    assert dry_spells([(7, area)], fronts, 0.02) == {7: (-1.0, pytest.approx(0.07), 0.0, 0.0)}


@settings(deadline=None, max_examples=40)
@given(st.floats(0.0, 400.0), st.floats(-150.0, 150.0), st.floats(-150.0, 150.0))
def test_near_the_end_of_the_world_no_step_is_left_out(gap, vx, vz):
    """Where it is far no step asks whether it is the last: that must not lead beyond."""
    area = RainArea((FAR - gap, -FAR + gap), (20, 10), velocity=(vx, vz))
    wanted = [FAR - gap, -FAR + gap]
    system, state = RainAreaSystem(), WeatherState(0)
    with fresh_world():
        esper.create_entity(area)
        for _ in range(80):
            system.run(state)
            wanted = [
                min(max(at + v * STEP, -FAR), FAR) for at, v in zip(wanted, (vx, vz), strict=True)
            ]
            assert list(area.center) == wanted


def test_an_area_that_is_about_to_go_stands_and_one_that_was_put_elsewhere_goes_on():
    areas = [RainArea((k, 0), (20, 10), velocity=(1, 0)) for k in (0, 100)]
    entities = [esper.create_entity(area) for area in areas]
    system, state = RainAreaSystem(), WeatherState(0)

    def step() -> None:
        state.uids.commit()
        system.run(state)

    step()
    esper.delete_entity(entities[0])
    areas[1].center = (500.0, 9.0)
    step()
    assert areas[0].center == (STEP, 0.0)
    assert areas[1].center == (500.0 + STEP, 9.0)
