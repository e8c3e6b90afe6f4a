"""`weather.sample`: right to the formulas of the physics, and fast because it is plain Python."""

from __future__ import annotations

import math

import esper
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from weather_ecs import Weather
from weather_ecs.components import PointLight, RainArea, Sun, Wind
from weather_ecs.errors import InvalidValueError
from weather_ecs.frame import AREA_DTYPE, FrameData
from weather_ecs.physics.ellipse import edge_factor, implicit
from weather_ecs.physics.optics import CLEAR_VISIBILITY, visibility_in_rain
from weather_ecs.sampling import SampleField, luminance

pytestmark = pytest.mark.usefixtures("world")


@pytest.fixture
def weather():
    with Weather() as it:
        yield it


areas = st.tuples(
    st.tuples(st.floats(-200, 200), st.floats(-200, 200)),
    st.tuples(st.floats(1e-3, 300), st.floats(1e-3, 300)).map(lambda r: (max(r), min(r))),
    st.floats(-7, 7),
    st.floats(0, 200),
    st.one_of(st.just(0.0), st.floats(1e-6, 400)),
    st.floats(-50, 50),
)
points = st.tuples(st.floats(-300, 300), st.floats(-60, 60), st.floats(-300, 300))


@settings(deadline=None, max_examples=200)
@given(st.lists(areas, max_size=5), st.lists(points, min_size=1, max_size=8))
def test_one_point_at_a_time_equals_the_vectorised_physics(listed, where):
    rows = [(key, *area) for key, area in enumerate(listed)]
    field = SampleField(FrameData(areas=np.array(rows, AREA_DTYPE)))
    ground = np.array([(x, z) for x, _, z in where])
    height = np.array([y for _, y, _ in where])
    rate, near = np.zeros(len(where)), np.zeros(len(where), bool)
    for center, radii, heading, rain, edge, ceiling in listed:
        share = edge_factor(ground, center, radii, heading, edge)
        rate += np.where(height < ceiling, share * rain, 0.0)
        if rain > 0.0:
            f = implicit(ground, center, radii, heading)
            if np.any(np.abs(f - 1.0) < 1e-9):
                return  # on the perimeter rounding decides
            near |= f < 1.0
    got = [field.at(*point) for point in where]
    np.testing.assert_allclose([s.rain_rate for s in got], rate, rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(
        [s.visibility for s in got], visibility_in_rain(rate, CLEAR_VISIBILITY), rtol=1e-6
    )
    rains = any(rain > 0.0 for _, _, _, rain, _, _ in listed)
    for inside, (x, _, z) in zip(near, where, strict=True):
        assert field.mode(x, z) == ("near" if inside else "far" if rains else "none")


def test_the_fields_of_a_sample_in_clear_air(weather):
    got = weather.sample((1, 2, 3))
    assert got._fields == (
        "rain_rate",
        "snow_rate",
        "sheltered",
        "wind",
        "visibility",
        "wetness",
        "snow_depth",
        "temperature",
        "light",
        "humidity",
    )
    assert got.rain_rate == got.snow_rate == got.wetness == got.snow_depth == 0.0
    assert got.sheltered is False
    assert got.wind == (0.0, 0.0, 0.0)
    assert got.visibility == pytest.approx(CLEAR_VISIBILITY)
    assert got.temperature == pytest.approx(15.0 - 2 * 6.5e-3)
    assert got.humidity == 0.8
    assert got.light > 0.5


def test_rates_add_under_overlapping_areas_and_end_at_the_ceiling(weather):
    esper.create_entity(RainArea((0, 0), (60, 40), 25.0, ceiling=300.0))
    esper.create_entity(RainArea((5, 0), (20, 20), 10.0, ceiling=100.0))
    assert weather.sample((0, 0, 0)).rain_rate == 35.0
    assert weather.sample((0, 100.0, 0)).rain_rate == 25.0
    assert weather.sample((0, 300.0, 0)).rain_rate == 0.0
    assert weather.sample((59.9, 0, 0)).rain_rate < 1.0
    assert weather.sample((100, 0, 0)).rain_rate == 0.0


def test_the_heading_turns_the_ellipse_counter_clockwise_seen_from_above(weather):
    esper.create_entity(RainArea((10, 20), (50, 5), 9.0, heading=0.5, soft_edge=0.0))
    for away, expected in ((49.0, 9.0), (51.0, 0.0)):
        at = (10 + away * math.cos(0.5), 0.0, 20 - away * math.sin(0.5))
        assert weather.sample(at).rain_rate == expected


def test_what_was_changed_since_the_last_process_counts(weather):
    entity = esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
    assert weather.sample((0, 0, 0)).rain_rate == 25.0
    area = esper.component_for_entity(entity, RainArea)
    area.rain_rate = 3.0
    assert weather.sample((0, 0, 0)).rain_rate == 3.0
    esper.create_entity(Wind((0, 1), 4.0))
    assert weather.sample((0, 0, 0)).wind == (0.0, 0.0, 4.0)
    esper.delete_entity(entity)
    assert weather.sample((0, 0, 0)).rain_rate == 0.0
    esper.process(0.0)
    assert weather.sample((0, 0, 0)).rain_rate == 0.0


def test_moving_areas_are_where_the_clock_says(weather):
    esper.create_entity(RainArea((0, 0), (10, 10), 5.0, soft_edge=0.0, velocity=(10, 0)))
    esper.process(0.52)
    assert weather.sample((15.19, 0, 0)).rain_rate == 5.0
    assert weather.sample((15.21, 0, 0)).rain_rate == 0.0
    assert weather.sample((-4.81, 0, 0)).rain_rate == 0.0
    assert weather.sample((-4.79, 0, 0)).rain_rate == 5.0


def test_light_of_sun_and_lamps(weather):
    dark = weather.sample((0, 0, 0)).light
    esper.create_entity(PointLight((0, 3, 0), (2, 2, 2), 10.0))
    near, far = weather.sample((0, 0, 0)).light, weather.sample((0, 0, 9)).light
    assert near == pytest.approx(dark + 2.0 * (1 - 0.09) ** 2)
    assert dark < far < near
    assert weather.sample((0, 0, 10)).light == pytest.approx(dark)
    esper.create_entity(Sun((0, -1, 0), (9, 9, 9), (0, 0, 0), (0, 0, 0), (0, 0, 0)))
    assert weather.sample((50, 0, 0)).light == 0.0
    assert luminance((1, 1, 1)) == pytest.approx(1.0)


@pytest.mark.parametrize(
    "position",
    [
        (math.nan, 0, 0),
        (0, math.inf, 0),
        (0, 0),
        (0, 0, 0, 0),
        None,
        5.0,
        "abc",
        (1e9, 0, 0),
        ("1", "2", "3"),
        (True, 0, 0),
        np.zeros((3, 1)),
    ],
)
def test_bad_positions(weather, position):
    with pytest.raises(InvalidValueError, match="position"):
        weather.sample(position)


def test_any_kind_of_vector_will_do(weather):
    from pyglet.math import Vec3

    esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
    for position in ((0, 1, 0), [0.0, 1.0, 0.0], np.array([0, 1, 0]), Vec3(0, 1, 0)):
        assert weather.sample(position).rain_rate == 25.0


def test_asking_changes_nothing(weather):
    esper.create_entity(RainArea((0, 0), (60, 40), 25.0, velocity=(1, 2)))
    esper.process(0.33)
    before = weather.snapshot()
    for x in range(50):
        weather.sample((x, 0, 0))
    assert weather.snapshot() == before
