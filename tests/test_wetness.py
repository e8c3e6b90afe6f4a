"""Water on the ground: the weather's own coarse field of it, without OpenGL."""

from __future__ import annotations

import json
import math

import esper
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.rain_frames import area
from tests.worlds import fresh_world, let_pass
from weather_ecs import Weather
from weather_ecs.components import RainArea
from weather_ecs.frame import AREA_DTYPE
from weather_ecs.physics.ellipse import edge_factor
from weather_ecs.physics.ground_law import WATER
from weather_ecs.physics.rain_field import area_shares
from weather_ecs.physics.wet_field import open_water
from weather_ecs.physics.wetness import DRYING, FILM, settle, settle_one
from weather_ecs.systems.wet_tiles import MOST_TILES, WetTiles, level_of

pytestmark = pytest.mark.usefixtures("world")


def test_a_minute_of_heavy_rain():
    weather = Weather()
    heavy = RainArea((0, 0), (70, 45), 25.0, soft_edge=12.0, onset=0.0)
    esper.create_entity(heavy)
    let_pass(60)
    expected = settle_one(0.0, 25.0 / 3600.0, FILM, 60.0)
    assert expected == pytest.approx(0.354, abs=1e-3)
    assert weather.sample((0, 0, 0)).wetness == pytest.approx(expected, rel=1e-4)
    assert weather.sample((40, 10.0, 5)).wetness == pytest.approx(expected, rel=1e-4)
    assert 0.0 < weather.sample((67, 0, 0)).wetness < 0.5 * expected
    assert weather.sample((76, 0, 0)).wetness == 0.0
    heavy.rain_rate = 0.0
    let_pass(DRYING)
    assert weather.sample((0, 0, 0)).wetness == pytest.approx(expected / math.e, rel=0.02)
    let_pass(3600.0, 10.0)
    assert weather.sample((0, 0, 0)).wetness == 0.0
    assert not weather._state.wet_ground.levels


def test_wetness_of_a_point_follows_the_law_through_changing_rain():
    weather = Weather()
    it = RainArea((0, 0), (60, 60), 5.0, onset=0.0)
    esper.create_entity(it)
    expected = 0.0
    for rate, seconds in ((5.0, 30), (80.0, 47), (0.0, 20), (300.0, 65), (0.0, 130), (1.0, 13)):
        it.rain_rate = rate
        let_pass(seconds)
        expected = settle_one(expected, rate / 3600.0, FILM, seconds)
        assert weather.sample((1, 0, 2)).wetness == pytest.approx(expected, rel=0.02, abs=2e-3)


def test_between_two_ticks_the_wetness_goes_on():
    weather = Weather()
    esper.create_entity(RainArea((0, 0), (60, 60), 25.0))
    before = 0.0
    for k in range(1, 60):
        esper.process(0.11)
        now = weather.sample((0, 0, 0)).wetness
        assert now == pytest.approx(settle_one(0.0, 25 / 3600, FILM, 0.11 * k), rel=1e-3)
        assert now > before
        before = now


def test_a_shower_that_passes_leaves_wet_ground_that_dries():
    weather = Weather()
    shower = RainArea((0, 0), (40, 40), 60.0, soft_edge=20.0, velocity=(5.0, 0.0))
    esper.create_entity(shower)
    seen = []
    for _ in range(100):
        let_pass(1)
        seen.append(weather.sample((150, 0, 0)).wetness)
    # It comes at 22 s and is gone at 38 s.
    assert max(seen[:20]) == 0.0
    assert np.argmax(seen) in range(36, 41)
    arrived = np.array([5.0 * t for t in np.arange(0.0, 60.0, 0.1)])
    depth = np.maximum(40.0 - np.abs(150.0 - arrived), 0.0)
    share = np.clip(depth / 20.0, 0, 1)
    total = float((share**2 * (3 - 2 * share)).sum() * 0.1 * 60.0 / 3600.0)
    assert max(seen) == pytest.approx(total, rel=0.08)
    assert seen[-1] == pytest.approx(max(seen) * math.exp(-61 / DRYING), rel=0.03)


def test_ground_under_moving_areas_follows_the_law():
    """Against the law itself in steps of 0.1 s: within 5 % of W, or a cell's width of the place."""
    rng = np.random.default_rng(4)
    points = np.array([(x, z) for x in range(-150, 500, 25) for z in range(-120, 121, 40)], float)
    for speed, rate, edge in ((3.0, 12.0, 20.0), (9.0, 60.0, 30.0), (20.0, 90.0, 10.0)):
        with fresh_world(), Weather() as weather:
            heading = float(rng.uniform(0, 3))
            it = RainArea(
                (-60, 0), (70, 45), rate, heading, soft_edge=edge, velocity=(speed, 0.1 * speed)
            )
            esper.create_entity(it)
            law, center = np.zeros(len(points)), np.array(it.center)
            for _ in range(3):
                for _ in range(133):
                    center = center + np.array(it.velocity) * 0.1
                    at = points - center
                    share = area_shares(at[:, 0], at[:, 1], (0, 0), it.radii, heading, edge)
                    law = settle(law, share * rate / 3600.0, FILM, 0.1)
                let_pass(13.3, 0.1)
                near = []
                for x, z in points.tolist():
                    round_it = [(x + dx, 0, z + dz) for dx in (-4, 0, 4) for dz in (-4, 0, 4)]
                    near.append([weather.sample(p).wetness for p in round_it])
                low, high = np.min(near, axis=1), np.max(near, axis=1)
                assert (low <= 1.05 * law + 2e-3).all() and (high >= 0.95 * law - 2e-3).all()
                assert law.max() > 0.01


def test_overlapping_areas_add_up_and_never_hold_more_than_a_film():
    weather = Weather()
    for size in (20, 80, 400):
        esper.create_entity(RainArea((0, 0), (size, size), 10.0))
    let_pass(40)
    expected = settle_one(0.0, 30 / 3600, FILM, 40.0)
    assert weather.sample((0, 0, 0)).wetness == pytest.approx(expected, rel=0.02)
    let_pass(1200, 10.0)
    steady = settle_one(0.0, 30 / 3600, FILM, 1e5)
    assert weather.sample((0, 0, 0)).wetness == pytest.approx(steady, rel=0.1)


def test_how_time_is_cut_into_frames_does_not_matter():
    states = []
    for cuts in ((0.05,) * 1000, (0.25,) * 200, (10.0,) * 5, (0.07, 0.13, 0.3) * 100):
        with fresh_world(), Weather(seed=3) as weather:
            it = RainArea((0, 0), (50, 20), 12.0, velocity=(3, 1))
            esper.create_entity(it)
            for dt in cuts:
                esper.process(dt)
            assert weather.stats.time == pytest.approx(50.0)
            states.append(json.dumps(weather._state.wet_ground.state()))
    assert len(set(states)) == 1


def test_paused_weather_neither_wets_nor_dries():
    weather = Weather()
    esper.create_entity(RainArea((0, 0), (60, 60), 25.0))
    let_pass(30)
    weather.paused = True
    before = weather.sample((0, 0, 0)).wetness
    let_pass(30)
    assert weather.sample((0, 0, 0)).wetness == before > 0.0


@pytest.mark.parametrize(
    "radii", [(1e6, 1e6), (1e6, 1e-3), (1e-3, 1e-3), (0.5, 0.4), (5000, 3), (300, 200)]
)
def test_any_size_of_area_takes_a_bounded_number_of_tiles(radii):
    weather = Weather()
    esper.create_entity(RainArea((123.0, -77.0), radii, 25.0, heading=0.7, velocity=(1, 0)))
    let_pass(20)
    tiles = sum(len(level.tiles) for level in weather._state.wet_ground.levels.values())
    assert tiles < 300
    if min(radii) >= 0.4 and max(radii) < 100 * min(radii):
        assert weather.sample((123.0 + 20.0 - 0.1, 0, -77.0)).wetness > 0.0


def test_crowded_ground_forgets_the_driest():
    tiles = WetTiles(0)
    rows = [area(k, (k * 300.0, 0.0), (60.0, 60.0), 1.0 + k) for k in range(30)]
    tiles.rain(np.array(rows, AREA_DTYPE), 1.0)
    tiles.settle(10.0)
    assert len(tiles) == MOST_TILES
    tiles.settle(1.0)
    assert tiles.at(29 * 300.0, 0.0) > 0.0
    assert tiles.at(0.0, 0.0) == 0.0


@settings(deadline=None, max_examples=100)
@given(
    st.floats(-60, 60), st.floats(-60, 60), st.floats(0.1, 50), st.floats(0.1, 50),
    st.floats(-4, 4), st.one_of(st.just(0.0), st.floats(1e-3, 100)),
)  # fmt: skip
def test_shares_are_the_ellipses_edge_factor(x, z, p, q, heading, edge):
    radii = (max(p, q), min(p, q))
    points = np.random.default_rng(0).uniform(-80, 80, (50, 2))
    got = area_shares(points[:, 0], points[:, 1], (x, z), radii, heading, edge)
    expected = edge_factor(points, (x, z), radii, heading, edge)
    np.testing.assert_allclose(got, expected, atol=1e-9)


@given(st.floats(1e-3, 1e6), st.floats(1e-3, 1e6))
def test_cells_are_as_fine_as_the_area_needs(p, q):
    a, b = max(p, q), min(p, q)
    cell = 2.0 ** level_of(a, b)
    assert math.pi * a * b / cell**2 <= 800.0001
    assert a / cell <= 181.02
    assert level_of(2 * a, 2 * b) >= level_of(a, b)


def test_what_the_gpu_begins_with_is_what_samples_say():
    weather = Weather()
    for k, (x, size, speed) in enumerate(((0, 60, 2.0), (120, 40, 0.0), (60, 300, -4.0))):
        moving = RainArea((x, 0), (size, 0.7 * size), 5.0 + 9 * k, velocity=(speed, 1))
        esper.create_entity(moving)
    let_pass(33.5, 0.1)
    moving.rain_rate = 2.0
    let_pass(0.4, 0.1)
    frame = weather._frame()
    wet = frame.wetness
    points = np.random.default_rng(0).uniform(-250, 350, (500, 2))
    levels = [(t.cell, t.places, t.water, wet.ticks - t.since, t.rows, WATER) for t in wet.levels]
    got = open_water(points, levels, frame.time - wet.ticks, frame.areas)
    expected = [weather.sample((x, 0, z)).wetness for x, z in points.tolist()]
    np.testing.assert_allclose(got, expected, atol=1e-6)
    assert max(expected) > 0.1


@settings(deadline=None, max_examples=30)
@given(st.lists(st.floats(0.0, 10.0), min_size=1, max_size=12), st.integers(0, 99))
def test_any_frame_times_and_areas_keep_it_finite(frames, seed):
    rng = np.random.default_rng(seed)
    with fresh_world(), Weather() as weather:
        areas = [
            RainArea(
                tuple(rng.uniform(-300, 300, 2)),
                sorted(10.0 ** rng.uniform(-1, 4, 2), reverse=True),
                10.0 ** rng.uniform(-2, 4),
                soft_edge=10.0 ** rng.uniform(-3, 3),
                velocity=tuple(rng.uniform(-150, 150, 2)),
            )
            for _ in range(3)
        ]
        for it in areas:
            esper.create_entity(it)
        for dt in frames:
            esper.process(dt)
            areas[0].rain_rate = float(rng.choice([0.0, 5.0, 1e4]))
            for x, z in rng.uniform(-500, 500, (5, 2)).tolist():
                wetness = weather.sample((x, 0.0, z)).wetness
                assert 0.0 <= wetness < 60.0
        assert len(weather.snapshot()) < 400_000
