"""The map of wetness as the observer walks, things move and the ground changes."""

from __future__ import annotations

from collections.abc import Iterator

import moderngl
import numpy as np
import pytest

from tests.boxes import box, placed
from tests.rain_frames import area, frame
from tests.wetness_stage import LEVEL, Maps, dry_ground, scene, walk
from weather_ecs.frame import FrameData
from weather_ecs.gpu.wetness_pass import DRY_AFTER
from weather_ecs.physics.wetness import DRYING, FILM, settle_one
from weather_ecs.systems.wet_ground import WetGround


@pytest.fixture
def maps(ctx: moderngl.Context) -> Iterator[Maps]:
    made = Maps(ctx)
    yield made
    made.release()


def test_what_moves_keeps_the_rain_off_and_leaves_the_ground_as_it_was(maps: Maps) -> None:
    def data(time: float) -> FrameData:
        x = 0.0 if 20.0 < time <= 40.0 else 60.0
        return scene(time, LEVEL, box(2, placed((x, 1.5, 0), (3, 0.5, 3)), True))

    walk(maps, 20.0, data)
    before = maps.at(0.0, 0.0, 0.0)
    walk(maps, 19.0, data, start=21.0)
    under = maps.at(0.0, 0.0, 0.0)
    assert under == pytest.approx(before * np.exp(-19.5 / DRYING), rel=0.03)
    assert maps.at(5.0, 0.0, 0.0) > 1.8 * before
    walk(maps, 19.0, data, start=41.0)
    assert maps.at(0.0, 0.0, 0.0) > 1.7 * before


def test_what_was_wet_stays_wet_at_its_place_as_the_observer_walks(maps: Maps) -> None:
    walk(maps, 40.0, lambda t: scene(t, LEVEL))
    place, before = maps.seen.place, maps.read()
    dry = [area(0, (8.0, 0.0), (25.0, 20.0), 0.0)]
    steps = 0
    for k in range(1, 60):
        maps.update(scene(40.0 + 0.02 * k, LEVEL, rows=dry), (0.25 * k, 1.7, 0.0))
        steps += maps.seen.place != place
    assert steps > 0
    moved = maps.seen.place
    shift = round((moved.center[0] - place.center[0]) / place.texel)
    assert shift == pytest.approx((moved.center[0] - place.center[0]) / place.texel)
    after = maps.read()
    # Nothing has been smeared: every texel is where it was, but for what has dried.
    share = np.exp(-1.18 / DRYING)
    np.testing.assert_allclose(
        after[:, :-shift, 0], before[:, shift:, 0] * share, rtol=0.01, atol=1e-5
    )


def test_ground_that_comes_into_the_map_begins_as_the_weather_has_it(maps: Maps) -> None:
    ground = WetGround()
    rows = [area(0, (0, 0), (150, 150), 25.0)]
    for _ in range(40):
        ground.tick(frame(*rows).areas)
    here = scene(40.0, LEVEL, rows=rows, wetness=ground.data())
    maps.update(here)
    expected = settle_one(0.0, 25.0 / 3600.0, FILM, 40.0)
    assert maps.at(2.0, 0.0, 3.0) == pytest.approx(expected, rel=0.02)
    maps.update(here, (90.0, 1.7, 0.0))
    assert maps.at(100.0, 0.0, 3.0) == pytest.approx(expected, rel=0.02)


def test_another_ground_a_long_pause_and_a_jump_back_begin_anew(maps: Maps) -> None:
    walk(maps, 30.0, lambda t: scene(t, LEVEL))
    maps.update(scene(30.1, LEVEL))
    assert maps.at(5.0, 0.0, 3.0) > 0.2
    maps.update(scene(30.2, LEVEL, wetness=dry_ground(30.2, 2)))
    assert maps.at(5.0, 0.0, 3.0) < 0.01
    for later in (500.0, 3.0):
        maps.update(scene(later, LEVEL))
        assert maps.at(5.0, 0.0, 3.0) < 0.01
        walk(maps, 20.0, lambda t: scene(t, LEVEL), start=later)
        assert maps.at(5.0, 0.0, 3.0) > 0.15


def test_it_is_needed_where_it_is_wet_or_rains(maps: Maps) -> None:
    wetness, here = maps.wetness, (0.0, 1.7, 0.0)
    dry = scene(0.0, LEVEL, rows=[area(0, (0, 0), (25, 20), 0.0)])
    assert not wetness.needs_map(maps.view(dry, here))
    assert not wetness.needs_update(maps.view(dry, here))
    wet = scene(0.0, LEVEL)
    assert wetness.needs_map(maps.view(wet, here))
    off = maps.view(wet, (200.0, 1.7, 0.0))
    assert not wetness.needs_map(off) and wetness.needs_update(off)
    nowhere = maps.view(wet, (3000.0, 1.7, 0.0))
    assert not wetness.needs_map(nowhere) and not wetness.needs_update(nowhere)
    maps.update(wet)
    later = scene(DRY_AFTER - 1.0, LEVEL, rows=[area(0, (0, 0), (25, 20), 0.0)])
    assert wetness.needs_map(maps.view(later, here))
    later = scene(DRY_AFTER + 1.0, LEVEL, rows=[area(0, (0, 0), (25, 20), 0.0)])
    assert not wetness.needs_map(maps.view(later, here))


def test_without_occluders_there_is_the_far_field(maps: Maps) -> None:
    ground = WetGround()
    rows = [area(0, (0, 0), (150, 150), 25.0)]
    for _ in range(30):
        ground.tick(frame(*rows).areas)
    maps.update(scene(30.0, rows=rows, wetness=ground.data()))
    assert maps.seen.place is None
    points = np.array([(0.0, 0.0), (100.0, 20.0)])
    expected = settle_one(0.0, 25.0 / 3600.0, FILM, 30.0)
    np.testing.assert_allclose(maps.far(points)[:, 0], expected, rtol=0.02)


def test_a_forgotten_observer_leaves_nothing(ctx: moderngl.Context, maps: Maps) -> None:
    maps.update(scene(0.0, LEVEL))
    maps.wetness.forget(0)
    maps.wetness.forget(0)
    assert not maps.wetness._observed
