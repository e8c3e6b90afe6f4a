"""`WindSystem`: winds add up, follow their laws, and are the same wherever they are asked for."""

from __future__ import annotations

import math

import esper
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.worlds import fresh_world
from weather_ecs import Weather
from weather_ecs.clock import STEP
from weather_ecs.components import RainArea, Wind
from weather_ecs.frame import WindProfile
from weather_ecs.physics import gusts, wind
from weather_ecs.systems import WeatherState, WindSystem
from weather_ecs.systems.wind import strength, varies, winds_at

pytestmark = pytest.mark.usefixtures("world")


def summed() -> tuple[float, float, float]:
    state = WeatherState(0)
    WindSystem().run(state)
    return state.wind


def blown(*winds: Wind, time: float = 0.0, seed: int = 0) -> tuple[np.ndarray, WindProfile]:
    velocity, profile = winds_at(list(enumerate(winds)), seed, time)
    return np.array(velocity), profile


def speeds(one: Wind, times: np.ndarray, seed: int = 0, uid: int = 0) -> np.ndarray:
    return np.array([np.hypot(*winds_at([(uid, one)], seed, t)[0][::2]) for t in times.tolist()])


def numbers(of: WindProfile) -> tuple[float, ...]:
    return (of.reference, of.exponent, of.ground, of.turbulence, of.scale)


# The sum


def test_without_wind_the_air_is_still():
    assert summed() == (0.0, 0.0, 0.0)
    assert blown()[1].turbulence == 0.0


def test_winds_add_up_and_stay_level():
    esper.create_entity(Wind((1, 0), 6.0))
    esper.create_entity(Wind((0, -2), 3.0))
    esper.create_entity(Wind((1, 0), 0.0))
    assert summed() == (6.0, 0.0, -3.0)


def test_opposite_winds_cancel():
    esper.create_entity(Wind((3, 4), 5.0))
    esper.create_entity(Wind((-3, -4), 5.0))
    assert summed() == pytest.approx((0.0, 0.0, 0.0), abs=1e-12)


def test_a_wind_whose_deletion_is_pending_has_died_down():
    esper.create_entity(Wind((1, 0), 6.0))
    gone = esper.create_entity(Wind((0, 1), 6.0))
    esper.delete_entity(gone)
    assert summed() == (6.0, 0.0, 0.0)


def test_the_sum_does_not_depend_on_the_order_of_esper():
    strengths = [1e-9, 150.0, 0.1, 33.3, 1e-7, 77.7]
    entities = [esper.create_entity() for _ in range(200)]
    for entity, speed in zip(entities[::37], strengths, strict=True):
        esper.add_component(entity, Wind((1, 0), speed))
    expected = 0.0
    for speed in strengths:
        expected += speed
    assert summed()[0] == expected


def test_profiles_are_mixed_by_the_winds_speeds():
    one = Wind((1, 0), 6.0, exponent=0.1, ground=2.0, turbulence=0.5, scale=4.0)
    two = Wind((0, 1), 2.0, exponent=0.3, ground=-2.0, turbulence=2.0 / 2.0, scale=8.0)
    assert numbers(blown(one)[1]) == pytest.approx((10.0, 0.1, 2.0, 3.0, 4.0))
    mixed = (10.0, 0.15, 1.0, math.hypot(3.0, 2.0), 5.0)
    assert numbers(blown(one, two)[1]) == pytest.approx(mixed)
    calm = Wind((1, 0), 0.0, exponent=0.1, turbulence=0.5)
    assert numbers(blown(calm)[1]) == pytest.approx((10.0, 0.1, 0.0, 0.0, 6.0))


# Its laws


TIMES = np.linspace(-5.0, 80.0, 2000)


@settings(deadline=None, max_examples=60)
@given(
    st.floats(0.1, 20.0), st.floats(0.1, 20.0), st.floats(0.1, 20.0),
    st.tuples(*[st.floats(-2.0, 3.0)] * 6),
)  # fmt: skip
def test_one_moment_is_what_the_law_says_of_many(rise, hold, die, factors):
    times = (rise, rise + hold, rise + hold + die)
    a, b, c, d, e, f = factors
    t = np.linspace(-1.0, times[2] + 1.0, 300)
    one = [gusts.gust_now(x, times[0], times[2], a, b, c, d) for x in t.tolist()]
    assert one == pytest.approx(wind.gust(t, times[0], times[2], a=a, b=b, c=c, d=d), abs=1e-9)
    one = [gusts.steady_now(x, times, factors) for x in t.tolist()]
    many = wind.steady(t, *times, a=a, b=b, c=c, d=d, e=e, f=f)
    assert one == pytest.approx(many, abs=1e-9)


def test_a_gust_begins_at_its_start_and_is_over_after_its_duration():
    one = Wind((1, 0), 10.0, law="gust", start=12.0, times=(3.0, 5.0, 15.0))
    v = speeds(one, TIMES)
    assert not v[(TIMES <= 12.0) | (TIMES >= 27.0)].any()
    assert v.max() == pytest.approx(10.0, rel=0.02)
    assert TIMES[v.argmax()] == pytest.approx(15.0, abs=0.05)
    assert np.abs(np.diff(v)).max() < 0.2


def test_a_steady_wind_holds_with_a_slight_variation():
    one = Wind((1, 0), 10.0, law="steady", start=0.0, times=(2.0, 40.0, 60.0))
    v = speeds(one, TIMES)
    held = v[(TIMES > 6.0) & (TIMES < 36.0)]
    assert 6.9 < held.min() < 8.0 and 12.0 < held.max() < 13.1
    assert not v[(TIMES <= 0.0) | (TIMES >= 60.0)].any()


def test_periods_repeat_and_never_cut_a_wind_off():
    one = Wind((1, 0), 10.0, law="gust", times=(1.0, 2.0, 4.0), period=10.0)
    assert speeds(one, np.array([1.0, 11.0, 1001.0])) == pytest.approx([10.0] * 3)
    assert speeds(one, np.array([-9.0, 5.0, 15.0])) == pytest.approx([0.0] * 3)
    one.period = 3.0
    assert strength(one, 3.5) > 0.0
    assert strength(one, 5.0) == pytest.approx(1.0)


@pytest.mark.parametrize("speed", [0.0, 100.0, 150.0])
@pytest.mark.parametrize("law", ["constant", "gust", "steady"])
def test_any_speed_at_any_time_is_finite(law, speed):
    one = Wind((1, 0), speed, law=law, gustiness=1.0, veer=math.pi, turbulence=1.0, exponent=1.0)
    for time in (0.0, 1e-9, 59.999, 60.0, 1e6, 2.0**53 * STEP):
        velocity, profile = blown(one, time=time)
        assert np.isfinite(velocity).all() and np.hypot(*velocity[::2]) <= 2.6 * speed + 1e-9
        assert math.isfinite(profile.turbulence)
        assert profile.turbulence == pytest.approx(np.hypot(*velocity[::2]))


# Chance


def test_gusts_come_by_chance_about_the_mean_speed():
    one = Wind((1, 0), 8.0, gustiness=0.5, interval=20.0)
    v = speeds(one, np.arange(0.0, 20_000.0, 0.25))
    assert v.mean() == pytest.approx(8.0, rel=0.01)
    assert v.min() == pytest.approx(8.0 * (1.0 - 0.5 * 0.309), rel=0.01)
    assert 11.7 < v.max() <= 12.0
    assert np.abs(np.diff(v)).max() < 1.7  # no jumps
    gusty = (v > 9.0).reshape(-1, 80)  # a row an interval
    assert gusty.any(axis=1).mean() > 0.95
    starts = gusty.argmax(axis=1)
    assert len(np.unique(starts)) > 25


def test_the_mean_of_a_train_is_what_it_is_taken_for():
    values = [gusts.train(t, 10.0, 5) for t in np.arange(0.0, 50_000.0, 0.5).tolist()]
    assert np.mean(values) == pytest.approx(gusts.TRAIN_MEAN, rel=0.02)
    assert min(values) >= 0.0 and max(values) <= 1.0


def test_other_seeds_and_entities_have_other_gusts():
    one, times = Wind((1, 0), 8.0, gustiness=0.5), np.arange(0.0, 400.0, 0.5)
    v = speeds(one, times)
    assert np.array_equal(v, speeds(one, times))
    for other in (speeds(one, times, seed=1), speeds(one, times, uid=1)):
        assert abs(np.corrcoef(v, other)[0, 1]) < 0.5


def test_the_direction_veers_smoothly_within_its_amplitude():
    one = Wind((0, 1), 5.0, veer=0.4, veer_period=60.0)
    found = [winds_at([(0, one)], 3, t)[0] for t in np.arange(0.0, 6000.0, 0.5).tolist()]
    off = np.array([math.atan2(x, z) for x, _, z in found])  # counter-clockwise from above
    assert np.abs(off).max() <= 0.4 and np.abs(off).max() > 0.35
    assert abs(off.mean()) < 0.04
    assert np.abs(np.diff(off)).max() < 0.025
    assert np.hypot(*np.array(found)[:, ::2].T) == pytest.approx(5.0)


def test_veering_to_a_positive_angle_is_counter_clockwise_seen_from_above():
    one = Wind((1, 0), 5.0, veer=1.0, veer_period=60.0)
    key = gusts.key_of(3, 0)
    time = next(t for t in range(600) if gusts.veer_now(t, 60.0, key) > 0.5)
    (x, _, z), _ = winds_at([(0, one)], 3, float(time))
    assert math.atan2(-z, x) == pytest.approx(gusts.veer_now(time, 60.0, key))


def test_what_varies():
    assert not varies([(0, Wind((1, 0), 5.0, exponent=0.2, turbulence=0.2))])
    assert not varies([(0, Wind((1, 0), 0.0, gustiness=0.2))])
    for change in ({"law": "gust"}, {"gustiness": 0.1}, {"veer": 0.1}):
        assert varies([(0, Wind((1, 0), 5.0)), (1, Wind((1, 0), 5.0, **change))])


# In the weather

GUSTY = {"gustiness": 0.6, "interval": 8.0, "veer": 0.5, "veer_period": 20.0}


def test_frames_of_any_length_meet_the_same_wind_and_carry_areas_alike():
    ends = []
    for dt in (0.05, 0.35, 2.8):
        with fresh_world(), Weather(seed=4) as weather:
            area = RainArea((0, 0), (50, 40), drift=1.0, ceiling=80.0)
            esper.create_entity(area)
            esper.create_entity(Wind((1, 0), 6.0, **GUSTY))
            esper.create_entity(Wind((0, 1), 4.0, law="gust", start=2.0))
            for _ in range(round(5.6 / dt)):
                esper.process(dt)
            ends.append((area.center, weather._state.wind, weather.sample((0, 10, 0)).wind))
    assert ends[0] == ends[1] == ends[2]
    assert ends[0][1] == ends[0][2]


def test_client_and_server_agree_after_a_snapshot():
    with Weather(seed=9) as server:
        esper.create_entity(RainArea((0, 0), (50, 40), drift=0.5))
        gusty = esper.create_entity(Wind((1, 0), 6.0, turbulence=0.2, exponent=0.14, **GUSTY))
        esper.process(7.0)
        data = server.snapshot()
        assert len(data) < 1500
        with fresh_world(), Weather(seed=1) as client:
            client.restore(data)
            for _ in range(100):
                esper.process(0.05)
            theirs, copy = client.sample((3, 2, 1)).wind, client.snapshot()
        for _ in range(20):
            esper.process(0.25)
        assert server.sample((3, 2, 1)).wind == theirs
        assert server.snapshot() == copy
        assert esper.component_for_entity(gusty, Wind).times == (4.0, 40.0, 60.0)


def test_the_frame_has_the_wind_of_its_moment():
    with Weather(seed=2) as weather:
        one = Wind((1, 0), 6.0, law="gust", times=(2.0, 3.0, 10.0), turbulence=0.2)
        esper.create_entity(one)
        esper.process(1.03)
        frame = weather._frame()
        assert frame.wind[0] == pytest.approx(6.0 * 1.03 / 2.0)
        assert frame.profile.turbulence == pytest.approx(0.2 * frame.wind[0])
        esper.process(0.01)
        assert weather._frame().wind[0] == pytest.approx(6.0 * 1.04 / 2.0)
        assert weather._frame() is weather._frame()


def test_areas_on_a_varying_wind_move_without_jumps():
    with Weather(seed=2) as weather:
        area = RainArea((0, 0), (50, 40), drift=1.0)
        esper.create_entity(area)
        esper.create_entity(RainArea((0, 0), (9, 9)))
        esper.create_entity(Wind((1, 0), 10.0, law="gust", times=(2.0, 3.0, 6.0)))
        places = []
        for _ in range(500):
            esper.process(0.013)
            places.append(weather._frame().areas["center"][0, 0])
        moved = np.diff(places) / 0.013
        assert moved.min() >= -1e-9 and moved.max() == pytest.approx(10.0, rel=0.03)
        assert np.abs(np.diff(moved)).max() < 0.3
        assert weather._frame().areas["center"][1, 0] == 0.0


def test_areas_go_with_the_wind_at_their_ceiling():
    with Weather():
        low, high = (RainArea((0, 0), (5, 4), drift=1.0, ceiling=h) for h in (10.0, 1000.0))
        esper.create_entity(low)
        esper.create_entity(high)
        esper.create_entity(Wind((1, 0), 5.0, exponent=0.2))
        esper.process(1.0)
        assert low.center[0] == pytest.approx(5.0)
        assert high.center[0] == pytest.approx(5.0 * 30.0**0.2)  # as at 300 m


def test_a_sample_has_the_wind_of_its_height_without_turbulence():
    with Weather() as weather:
        esper.create_entity(Wind((1, 0), 5.0, exponent=1 / 7, ground=2.0, turbulence=0.5))
        esper.process(0.1)
        assert weather.sample((0, 12, 0)).wind == (5.0, 0.0, 0.0)
        assert weather.sample((9, 3, 4)).wind[0] == pytest.approx(5.0 * 0.1 ** (1 / 7))
        assert weather.sample((0, -50, 0)).wind[0] == pytest.approx(5.0 * 0.003 ** (1 / 7))
