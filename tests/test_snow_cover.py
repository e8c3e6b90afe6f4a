"""Snow that lies: its law, its coarse ground, what samples say of it, and snapshots of it."""

from __future__ import annotations

import json

import esper
import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from tests.worlds import fresh_world, let_pass
from weather_ecs import Weather
from weather_ecs.components import Air, Occluder, RainArea, SnowFlakes
from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.ground_law import SnowLaw
from weather_ecs.physics.snow_cover import (
    DEGREE_DAY,
    DENSITY,
    QUICKER,
    SOAKED,
    collect,
    cover,
    depth,
    melt_rate,
    stays,
)
from weather_ecs.physics.wetness import FILM
from weather_ecs.systems.wet_ground import WetGround

COLD, WARM = -5.0, 8.0
FALL = 10.0 / 3600.0  # mm/s at 10 mm/h


def test_four_millimetres_melt_in_a_day_and_a_degree_sped_up_as_drying_is():
    assert melt_rate(1.0) * 86_400.0 / QUICKER == pytest.approx(4.0)
    assert melt_rate([-40.0, 0.0]).tolist() == [0.0, 0.0]
    assert melt_rate(5.0) == pytest.approx(5.0 * DEGREE_DAY)


def test_fresh_snow_is_ten_times_as_deep_as_its_water():
    assert depth(1.0) == pytest.approx(0.01)
    assert cover(0.0) == 0.0 and cover(0.003) == pytest.approx(0.632, abs=1e-3)
    assert stays([0.4, 0.65, 0.9]).tolist() == pytest.approx([0.0, 0.5, 1.0])


@given(st.floats(0, 50), st.floats(0, 1e-2), st.floats(0, 1e-2), st.floats(0, 900), st.floats(0, 1))
def test_two_spans_are_one(snow, inflow, melt, seconds, share):
    at_once = collect(snow, inflow, melt, seconds)
    first = collect(snow, inflow, melt, share * seconds)
    assert collect(first, inflow, melt, (1.0 - share) * seconds) == pytest.approx(at_once, abs=1e-9)
    assert at_once >= 0.0


@pytest.mark.usefixtures("world")
def test_snow_collects_as_it_falls_and_melts_to_wet_ground():
    air = Air(COLD, 0.9)
    area = RainArea((0, 0), (60, 60), 10.0, onset=0.0)
    esper.create_entity(air)
    esper.create_entity(area)
    with Weather() as weather:
        let_pass(120.5)
        here = weather.sample((0, 0, 0))
        assert here.snow_rate == pytest.approx(10.0) and here.rain_rate == pytest.approx(0.0)
        assert here.snow_depth == pytest.approx(FALL * 120.5 / DENSITY, rel=0.01)
        assert here.wetness == 0.0
        assert weather.sample((300, 0, 0)).snow_depth == 0.0
        area.rain_rate = 0.0
        let_pass(60.0)
        assert weather.sample((0, 0, 0)).snow_depth == pytest.approx(here.snow_depth, rel=0.01)
        air.temperature = WARM
        thaw = float(melt_rate(weather._frame().air.wet_bulb))
        let_pass(8.0)
        left = FALL * 120.5 - thaw * 8.0
        here = weather.sample((0, 0, 0))
        assert here.snow_depth == pytest.approx(left / DENSITY, rel=0.1)
        assert here.wetness == pytest.approx(here.snow_depth * DENSITY / SOAKED * FILM)
        let_pass(120.0)
        assert weather.sample((0, 0, 0)).snow_depth == 0.0
        assert not weather._state.snow_ground.levels


@pytest.mark.usefixtures("world")
def test_rain_leaves_no_snow_and_sleet_leaves_some_of_both():
    air = Air(15.0, 0.8)
    esper.create_entity(air)
    esper.create_entity(RainArea((0, 0), (60, 60), 10.0))
    with Weather() as weather:
        let_pass(30.0)
        assert weather.sample((0, 0, 0)).snow_depth == 0.0
        assert not weather._state.snow_ground.levels
        air.temperature, air.humidity = 0.9, 0.95
        share = weather._frame().air.snow_share
        assert 0.2 < share < 0.9
        let_pass(30.0)
        grown = (10.0 / 3600.0 * share - melt_rate(weather._frame().air.wet_bulb)) * 30.0
        assert weather.sample((0, 0, 0)).snow_depth * DENSITY == pytest.approx(grown, rel=0.05)


def test_light_snow_on_deep_snow_still_counts():
    ground = WetGround(SnowLaw())
    with fresh_world(), Weather() as weather:
        area = RainArea((0, 0), (40, 40), 0.2, velocity=(3.0, 0.0))
        esper.create_entity(area)
        esper.process(0.0)
        rows = weather._frame().areas
        deep = rows.copy()
        deep["rain_rate"] = 3600.0 * 100.0  # 100 mm in one second
        ground.tick(deep)
        for k in range(1, 200):
            moving = rows.copy()
            moving["center"][0, 0] = 0.2 * (k % 20)  # entered again and again
            ground.tick(moving)
    assert ground.at(0.0, 0.0, 0.0, 0.0, 200.0) == pytest.approx(100.0 + 0.2 / 3600 * 199, abs=2e-3)


def test_a_snapshot_keeps_the_snow_to_the_bit():
    def lay() -> bytes:
        with fresh_world(), Weather() as weather:
            esper.create_entity(Air(COLD, 0.9))
            esper.create_entity(RainArea((0, 0), (60, 60), 10.0, velocity=(1.0, 0.5)))
            let_pass(70.0)
            return weather.snapshot()

    def go_on(data: bytes) -> tuple[bytes, float]:
        with fresh_world(), Weather() as weather:
            weather.restore(data)
            let_pass(33.0)
            return weather.snapshot(), weather.sample((0, 0, 0)).snow_depth

    half = lay()
    one, other = go_on(half), go_on(half)
    assert one == other and one[1] > 0.001


def test_a_state_comes_back():
    with fresh_world(), Weather() as weather:
        esper.create_entity(Air(1.5, 1.0))
        esper.create_entity(RainArea((0, 0), (60, 60), 50.0))
        let_pass(20.0)
        state = json.loads(json.dumps(weather._state.snow_ground.state()))
    assert state["levels"] and state["melt"] > 0.0
    assert json.loads(json.dumps(WetGround.from_state(state, SnowLaw).state())) == state


# On things that move


def cube() -> tuple[np.ndarray, np.ndarray]:
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (0, 2) for z in (-1, 1)], np.float32)
    faces = "0 1 3 0 3 2 4 6 7 4 7 5 0 4 5 0 5 1 2 3 7 2 7 6 0 2 6 0 6 4 1 5 7 1 7 3"
    return corners, np.array(faces.split(), np.uint32)


def at(x: float, y: float, z: float, lean: float = 0.0) -> np.ndarray:
    c, s = np.cos(lean), np.sin(lean)
    return np.array([[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, z], [0, 0, 0, 1.0]])


@pytest.mark.usefixtures("world")
def test_a_cart_takes_its_snow_along_drops_it_when_it_leans_and_gets_none_under_a_roof():
    esper.create_entity(Air(COLD, 0.9))
    esper.create_entity(RainArea((0, 0), (60, 60), 10.0))
    cart = Occluder(*cube(), at(0, 0, 0), dynamic=True)
    covered = Occluder(*cube(), at(20, 0, 0), dynamic=True)
    vertices, faces = cube()
    roof = Occluder(vertices * (4, 0.1, 4), faces, at(20, 5, 0))
    for thing in (cart, covered, roof):
        esper.create_entity(thing)
    with Weather() as weather:
        esper.process(0.0)
        assert weather.snow_on(cart) == 0.0
        for k in range(120):
            cart.transform = at(0.05 * k, 0, 0)
            esper.process(0.5)
            weather.snow_on(cart), weather.snow_on(covered)
        lies = weather.snow_on(cart)
        assert lies == pytest.approx(FALL * 60.0 / DENSITY, rel=0.02)
        assert weather.snow_on(covered) == 0.0
        cart.transform = at(200.0, 0, 0)  # out of the snow
        esper.process(0.5)
        assert weather.snow_on(cart) == pytest.approx(lies, rel=1e-6)
        cart.transform = at(200.0, 0, 0, 1.4)
        for _ in range(10):
            esper.process(0.5)
            weather.snow_on(cart)
        assert weather.snow_on(cart) < 1e-3 * lies
        with pytest.raises(InvalidValueError, match="thing"):
            weather.snow_on("cart")  # type: ignore[arg-type]


@pytest.mark.usefixtures("world")
def test_snow_may_collect_faster_than_in_nature():
    esper.create_entity(Air(COLD, 0.9))
    esper.create_entity(RainArea((0, 0), (60, 60), 10.0))
    esper.create_entity(SnowFlakes(settling=8.0))
    with Weather() as weather:
        let_pass(60.5)
        here = weather.sample((0, 0, 0))
        assert here.snow_depth == pytest.approx(8.0 * FALL * 60.5 / DENSITY, rel=0.01)
        assert here.snow_rate == pytest.approx(10.0) and here.wetness == 0.0
