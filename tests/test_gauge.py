"""Rain gauges without OpenGL: component, physics, board, server."""

from __future__ import annotations

import math
from types import SimpleNamespace
from typing import Any

import esper
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.boxes import CORNERS, TRIANGLES, placed
from weather_ecs import Weather
from weather_ecs.components import Occluder, RainArea, RainGauge
from weather_ecs.errors import InvalidValueError
from weather_ecs.frame import GaugeData, GaugeReading
from weather_ecs.physics.container import births
from weather_ecs.physics.drops import drop_density, sample_diameters
from weather_ecs.physics.gauge import WATCHED, WIDEST, catch_middle, catch_radius, landing_water
from weather_ecs.physics.lod import rim_fade, weight_shape
from weather_ecs.physics.rain_step import diameters, fall_speeds, law_of
from weather_ecs.systems.gauge import PARTS, GaugeBoard

pytestmark = pytest.mark.usefixtures("world")

RATE = 25.0


# The component


def test_the_reading_is_the_weathers_to_set():
    gauge = RainGauge((1, 2, 3), 0.5)
    assert gauge.rate == 0.0
    with pytest.raises(AttributeError):
        gauge.rate = 5.0  # type: ignore[misc]
    for area in (0, 0.0, -1.0, math.nan, math.inf):
        with pytest.raises(InvalidValueError, match="area"):
            RainGauge(area=area)
        with pytest.raises(InvalidValueError, match="area"):
            gauge.area = area
    assert gauge.area == 0.5


# The physics


@pytest.mark.parametrize("rate", [0.5, 5.0, 25.0, 100.0])
def test_the_water_that_a_landing_drop_carries(rate):
    landed = sample_diameters(200_000, rate, np.random.default_rng(0), flux=True)
    assert landing_water(rate) == pytest.approx((math.pi / 6.0 * landed**3).mean(), rel=0.03)


def test_a_catch_is_wider_where_drops_are_few_and_never_smaller_than_the_opening():
    rest = {"window": 30.0, "reach": (30.0, 30.0), "height": 20.0, "fall_speed": 6.0}
    radii = [catch_radius(0.5, distance=d, count=14_000, **rest) for d in np.linspace(0, 0.9, 30)]
    assert (np.diff(radii) >= 0.0).all()
    assert 1.0 < radii[2] < 5.0 and radii[-1] == WIDEST * 30.0
    assert catch_radius(0.5, distance=0.5, count=1, **rest) == WIDEST * 30.0
    assert catch_radius(0.5, distance=0.5, count=1e9, **rest) == 0.5
    assert catch_radius(50.0, distance=0.5, count=14_000, **rest) == 50.0


@settings(deadline=None)
@given(st.floats(0.0, 1.0), st.floats(-1.0, 1.0), st.floats(0.01, WIDEST))
def test_a_catch_lies_where_drops_are_counted_and_around_its_gauge_where_it_can(x, z, radius):
    forward, lateral = catch_middle(x, z, radius)
    if math.hypot(x, z) >= 1.0:
        assert (forward, lateral) == (x, z)
        return
    assert math.hypot(forward, lateral) <= WATCHED - radius + 1e-9 and forward >= radius - 1e-9
    if x >= radius and math.hypot(x, z) <= WATCHED - radius:
        assert (forward, lateral) == (x, z)
    assert catch_middle(-0.01, z, radius) == (-0.01, z)


@pytest.mark.parametrize("count", [3_000, 14_000, 50_000])
def test_the_drawn_drops_carry_the_rain_at_every_distance(count):
    """Reach and size are a drop's for good: no time would mend too many or too few large ones."""
    record = births(50_000, np.random.default_rng(4))[:count]
    s, law = record[:, 2].astype(float), law_of(RATE)
    size = diameters(record[:, 3], law)
    carried = size.astype(float) ** 3 * fall_speeds(size) * math.pi / 6.0 * 3600e-6
    for d in np.array([2.0, 4.0, 8.0, 14.0, 20.0]) / 30.0:
        inside = s > d
        shares = d / weight_shape(d) * rim_fade(d / s[inside]) * 2.0 / (math.pi * s[inside] ** 2)
        rate = (shares * carried[inside]).sum() * float(drop_density(RATE)) * math.pi / 2.0 / count
        assert rate == pytest.approx(RATE, rel=6.0 / math.sqrt(count))


# The board


def rain(**rates: float) -> Any:
    table = {int(name[1:]): rate for name, rate in rates.items() if name != "covered"}
    covered = bool(rates.get("covered"))
    return SimpleNamespace(rain_rates=lambda *_: table, sheltered=lambda *_: covered)


DATA = (GaugeData(7, (0.0, 0.0, 0.0), 1.0, 30.0),)


def reading(
    time: float, *areas: tuple[int, float, float, float], exposure: float = 1.0
) -> GaugeReading:
    return GaugeReading(7, time, 0.1, exposure, areas)


def board(seconds: float, sky: Any, *, step: float = 0.1, start: float = 0.0) -> Any:
    gauge, made = RainGauge(), GaugeBoard()
    for k in range(round(seconds / step) + 1):
        made.process(DATA, {7: gauge}, sky, start + k * step)
    return SimpleNamespace(gauge=gauge, board=made)


def test_without_a_gpu_the_areas_rates_are_read():
    assert board(10, rain(a1=5.0, a2=2.5)).gauge.rate == pytest.approx(7.5)
    assert board(10, rain(a1=5.0, covered=1)).gauge.rate == 0.0
    assert board(0, rain(a1=5.0)).gauge.rate == 0.0


def test_the_reading_is_the_mean_over_its_window():
    it = board(30, rain(a1=12.0))
    for k in range(1, 151):
        it.board.process(DATA, {7: it.gauge}, rain(), 30.0 + 0.1 * k)
    assert it.gauge.rate == pytest.approx(6.0, rel=0.05)
    for k in range(151, 320):
        it.board.process(DATA, {7: it.gauge}, rain(), 30.0 + 0.1 * k)
    assert it.gauge.rate == 0.0
    assert all(len(parts) <= PARTS + 1 for parts in it.board._parts.values())


def test_what_the_gpu_has_counted_counts():
    it = board(10, rain(a1=5.0))
    # (caught, watched, possible): 4 mm/h where half of the catch was open, all of the opening.
    readings = [reading(0.1 * k, (1, 4.0 * 50.0, 50.0, 100.0)) for k in range(1, 101)]
    it.board.take(DATA, readings)
    it.board.process(DATA, {7: it.gauge}, rain(a1=5.0), 10.0)
    assert it.gauge.rate == pytest.approx(4.0)
    it.board.take(DATA, [reading(0.1 * k, (1, 0.0, 0.0, 100.0), exposure=0.0) for k in range(100)])
    it.board.process(DATA, {7: it.gauge}, rain(a1=5.0), 10.0)
    assert it.gauge.rate == pytest.approx(2.0, rel=0.02)


def test_areas_whose_drops_say_nothing_are_read_as_they_are():
    it = board(10, rain(a1=5.0, a2=3.0, a3=1.0))
    for k in range(1, 101):
        it.board.take(DATA, [reading(0.1 * k, (1, 60.0, 10.0, 10.0), (2, 9.0, 0.5, 10.0))])
    it.board.process(DATA, {7: it.gauge}, rain(a1=5.0, a2=3.0, a3=1.0), 10.0)
    assert it.gauge.rate == pytest.approx(6.0 + 3.0 + 1.0)


def test_readings_of_gauges_that_are_gone_and_of_long_ago_are_left_out():
    it = board(40, rain(a1=5.0))
    it.board.take(DATA, [reading(1.0, (1, 900.0, 1.0, 1.0))])
    it.board.take((), [reading(39.0, (1, 900.0, 1.0, 1.0))])
    it.board.process(DATA, {7: it.gauge}, rain(a1=5.0), 40.0)
    assert it.gauge.rate == pytest.approx(5.0)
    it.board.process((), {}, rain(a1=5.0), 41.0)
    assert not it.board._parts


def test_time_that_runs_back_begins_anew():
    it = board(20, rain(a1=8.0))
    for k in range(20):
        it.board.process(DATA, {7: it.gauge}, rain(a1=2.0), 0.1 * k)
    assert it.gauge.rate == pytest.approx(2.0)


@settings(deadline=None, max_examples=50)
@given(st.lists(st.floats(0.0, 100.0), max_size=40), st.floats(0.1, 3600.0))
def test_any_times_keep_it_finite(steps, window):
    data, gauge, made = (GaugeData(7, (0.0, 0.0, 0.0), 1.0, window),), RainGauge(), GaugeBoard()
    time = 0.0
    for step in steps:
        time += step
        made.take(data, [reading(time, (1, 5.0, 1.0, 1.0))])
        made.process(data, {7: gauge}, rain(a1=5.0), time)
        assert 0.0 <= gauge.rate <= 5.0 + 1e-9


# Without OpenGL


def test_a_server_reads_its_gauges():
    Weather()
    area = RainArea((0, 0), (60, 40), RATE, onset=0.0)
    esper.create_entity(area)
    open_air, under, beside = (RainGauge((x, 1.0, 0), window=10.0) for x in (0.0, 20.0, 24.0))
    for gauge in (open_air, under, beside):
        esper.create_entity(gauge)
    esper.create_entity(Occluder(CORNERS, TRIANGLES, placed((20, 4, 0), (3, 0.1, 3))))
    for _ in range(100):
        esper.process(0.1)
    assert open_air.rate == pytest.approx(RATE)
    assert under.rate == 0.0
    assert beside.rate == pytest.approx(RATE)
    under.position = (0.0, 2.0, 5.0)
    for _ in range(3):
        esper.process(0.1)
    assert under.rate == pytest.approx(RATE)
    area.rain_rate = 0.0
    for _ in range(150):
        esper.process(0.1)
    assert open_air.rate == 0.0


def test_gauges_may_come_and_go_and_show_in_no_snapshot():
    weather = Weather()
    esper.create_entity(RainArea((0, 0), (60, 40), RATE))
    esper.process(0.1)
    before = weather.snapshot()
    for k in range(300):
        entity = esper.create_entity(RainGauge((k % 7, 0, 0)))
        if k % 3:
            esper.delete_entity(entity, immediate=bool(k % 2))
        esper.process(0.0)
    assert weather.snapshot() == before
    for entity, _ in list(esper.get_component(RainGauge)):
        esper.delete_entity(entity, immediate=True)
    esper.process(0.1)
    weather._frame()
    gone = esper.create_entity(RainGauge())
    esper.delete_entity(gone)
    esper.process(0.1)
    assert weather._frame().gauges == ()
