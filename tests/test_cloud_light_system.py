"""Shapes of clouds and their light: made once, shared, lit one in a frame and only when needed."""

from __future__ import annotations

import math

import esper
import numpy as np
import pytest

from tests.cloud_worlds import drawn, four_skies, layer, model, seconds, sky
from weather_ecs import Weather
from weather_ecs.components import Atmosphere, Climate, Cloud, CloudRoot, CloudSeed, SkyLayer, Sun
from weather_ecs.frame import SkyLight
from weather_ecs.physics.absorption import absorbed, path_lengths
from weather_ecs.systems import cloud_shapes
from weather_ecs.systems.cloud_light import light_one, moved, sun_direction
from weather_ecs.systems.cloud_shapes import TURNS, ShapeLibrary, local, turn_of

pytestmark = pytest.mark.usefixtures("world")

UP = (0.0, 1.0, 0.0)


def at_angle(degrees: float) -> tuple[float, float, float]:
    """A direction so far from straight up."""
    return math.sin(math.radians(degrees)), math.cos(math.radians(degrees)), 0.0


def sunny(count: int = 60, models: int = 5) -> tuple[Weather, Sun]:
    """Clouds from twenty shapes under a sun overhead."""
    weather, sun = Weather(), Sun(UP)
    esper.create_entity(sun)
    names = [f"m {number}" for number in range(models)]
    esper.create_entity(layer((sky(0.0, count, *names),), velocity=(0.0, 0.0)))
    drawn(weather)
    return weather, sun


def test_light_comes_from_the_sun_or_an_atmosphere():
    weather = Weather()
    state = weather._state
    assert sun_direction(state) == SkyLight().sun_direction
    low = at_angle(70.0)
    esper.create_entity(Sun(low))
    esper.process(0.0)
    assert sun_direction(state) == pytest.approx(low)
    esper.create_entity(Atmosphere("2025-06-21T12:00:00Z", latitude=45.0))
    drawn(weather)
    noon = sun_direction(state)
    assert math.degrees(math.acos(noon[1])) == pytest.approx(45.0 - 23.44, abs=0.1)


def test_clouds_are_lit_before_they_are_first_seen():
    weather, _ = sunny()
    frame = drawn(weather)
    assert len(frame.clouds) == 60
    assert len(frame.cloud_shapes) == 20
    for shape in frame.cloud_shapes:
        assert shape.light == UP
        lengths = path_lengths(shape.centers, shape.sizes, UP)
        assert shape.absorbed == pytest.approx(absorbed(lengths, shape.penetration), abs=1e-6)
        assert shape.absorbed.max() > 0.1
        assert not shape.absorbed.flags.writeable


def test_as_long_as_the_light_stands_nothing_is_computed():
    weather, sun = sunny()
    before = drawn(weather).cloud_shapes
    for _ in range(30):
        esper.process(0.05)
        assert weather.stats.cfa_computed == 0
    sun.direction = at_angle(1.0)  # less than the angle that counts
    for _ in range(5):
        esper.process(0.05)
        assert weather.stats.cfa_computed == 0
    assert drawn(weather).cloud_shapes is before


def test_directions_of_any_length_are_compared_by_their_angle():
    light, limit = (0.35, 0.8, 0.48), math.cos(math.radians(2.0))
    twice = tuple([2.0 * part for part in light])
    assert not moved(light, light, limit) and not moved(light, twice, limit)
    assert moved((0.0, 0.99, 0.0), at_angle(2.1), limit)
    assert not moved((0.0, 0.99, 0.0), at_angle(1.9), limit)


def test_without_a_sun_nothing_is_computed_either():
    esper.create_entity(layer((sky(0.0, 10),), velocity=(0.0, 0.0)))
    weather = Weather()
    before = drawn(weather).cloud_shapes
    for _ in range(5):
        esper.process(0.05)
    assert drawn(weather).cloud_shapes is before


@pytest.mark.parametrize("count", [30, 600])
def test_when_it_has_moved_one_cloud_a_frame_each_once(count):
    weather, sun = sunny(count)
    before = drawn(weather).cloud_shapes
    sun.direction = at_angle(30.0)
    changed = []
    for _ in range(20):
        esper.process(0.05)
        assert weather.stats.cfa_computed == 1
        after = drawn(weather).cloud_shapes
        pairs = zip(before, after, strict=True)
        [which] = [k for k, (one, other) in enumerate(pairs) if one is not other]
        assert after[which].key == before[which].key
        assert after[which].billboards is before[which].billboards
        changed.append(which)
        before = after
    assert sorted(changed) == list(range(20))
    esper.process(0.05)
    assert weather.stats.cfa_computed == 0
    for shape in before:
        lengths = path_lengths(shape.centers, shape.sizes, at_angle(30.0))
        assert shape.absorbed == pytest.approx(absorbed(lengths, shape.penetration), abs=1e-6)


def test_under_a_sun_that_never_stops_all_take_turns():
    weather, sun = sunny()
    lit: dict[int, int] = {}
    before = drawn(weather).cloud_shapes
    for frame in range(200):
        sun.direction = at_angle(0.4 * (frame + 6))
        esper.process(0.05)
        assert weather.stats.cfa_computed <= 1
        after = drawn(weather).cloud_shapes
        for one, other in zip(before, after, strict=True):
            lit[one.key] = lit.get(one.key, 0) + (one is not other)
        before = after
    assert len(lit) == 20
    assert max(lit.values()) - min(lit.values()) <= 1


def test_clouds_that_come_later_wait_until_they_are_lit():
    weather, _ = sunny()
    esper.process(0.05)
    [(_, sky_layer)] = esper.get_component(SkyLayer)
    sky_layer.skies = (sky_layer.skies[0], sky(1.0, 60, "n 1", "n 2"))
    sky_layer.velocity = (40.0, 0.0)
    esper.create_entity(Climate(duration=1e-9))
    seen: set[int] = {shape.key for shape in drawn(weather).cloud_shapes}
    for _ in range(60):
        esper.process(0.5)
        assert weather.stats.cfa_computed <= 1
        frame = drawn(weather)
        new = [shape for shape in frame.cloud_shapes if shape.key not in seen]
        assert len(new) <= 1
        for shape in new:
            assert shape.light == UP
            seen.add(shape.key)
        assert frame.clouds["shape"].max() < len(frame.cloud_shapes)
    assert len(seen) > 24


def test_a_server_lights_nothing():
    weather = Weather()
    esper.create_entity(layer(four_skies()))
    seconds(5.0)
    assert len(weather._frame().clouds) == 0
    assert len(weather._state.cloud_shapes) == 0
    assert weather.stats.cfa_computed == 0
    assert weather.stats.clouds == 40


@pytest.mark.parametrize("direction", [(0, -1, 0), (1, 0, 0), (0.3, -0.01, 0.95)])
def test_a_sun_at_the_horizon_and_below_breaks_nothing(direction):
    weather, sun = sunny(20)
    sun.direction = direction
    seconds(1.5, 0.05)
    for shape in drawn(weather).cloud_shapes:
        assert shape.light == pytest.approx(sun.direction)
        assert ((shape.absorbed >= 0.0) & (shape.absorbed <= 1.0)).all()


def test_a_cloud_that_is_turned_is_lit_as_it_stands():
    weather, light = Weather(), (0.6, 0.0, 0.8)
    esper.create_entity(Sun(light))
    flat = model("flat")
    esper.create_entity(Cloud(flat, (0, 1000, 0)))
    esper.create_entity(Cloud(flat, (0, 1000, 0), heading=0.5 * math.pi))
    esper.create_entity(Cloud(flat, (0, 1000, 0), heading=0.02))
    frame = drawn(weather)
    assert len(frame.cloud_shapes) == 2  # a little turn is not worth another light
    turned = frame.cloud_shapes[frame.clouds["shape"][1]]
    # A quarter counter-clockwise from above takes +x to -z: turn the boxes and ask again.
    centers, sizes = (np.array(a[:, [2, 1, 0]]) for a in (turned.centers, turned.sizes))
    centers[:, 2] *= -1.0
    lengths = path_lengths(centers, sizes, light)
    assert turned.absorbed == pytest.approx(absorbed(lengths, turned.penetration), abs=1e-5)
    assert turned.light == light


def test_headings_go_to_the_nearest_turn():
    step = 2.0 * math.pi / TURNS
    assert [turn_of(k * step + 0.4 * step) for k in range(TURNS)] == list(range(TURNS))
    assert turn_of(-step) == TURNS - 1
    assert local(UP, 5) == UP
    assert local((1.0, 0.0, 0.0), TURNS // 4) == pytest.approx((0.0, 0.0, 1.0))


def test_the_same_model_and_number_are_made_once_and_others_are_others():
    library = ShapeLibrary()
    one, twin = model("one"), model("one")
    first = library.get(one, 3)
    assert library.get(one, 3) is first
    assert library.get(twin, 3) is first  # the same content
    assert library.get(one, 4) is not first
    assert library.get(one, 3, 6).made is first.made
    one.seeds[0].width = 300.0
    assert library.get(one, 3) is not first
    assert library.get(twin, 3) is first
    assert library.get(one, 3).made.sizes.max() == 300.0


def test_what_no_cloud_stands_with_any_more_is_forgotten():
    library = ShapeLibrary()
    kept = [library.get(model("kept"), number) for number in range(20)]
    for number in range(200):
        library.get(model("other"), number)
    library.prune({shape.key for shape in kept})
    assert len(library) == 20 + cloud_shapes.SPARE
    assert all(library.get(model("kept"), number) is shape for number, shape in enumerate(kept))
    assert library.unlit() is kept[0]


def test_large_clouds_are_lit_in_parts_that_make_the_same_whole(monkeypatch):
    root = CloudRoot(reproductions_min=4, reproductions_max=4, seeds_start=100, seeds_end=100)
    large = model("large")
    large.seeds = (CloudSeed(width=50, height=50, depth=50, roots=(root,)),)
    library = ShapeLibrary()
    shape = library.get(large, 0)
    count = len(shape.made.centers)
    assert count == 401
    library.light_new(shape, UP)
    tilted, parts = at_angle(40.0), 0
    while light_one(library, tilted):
        parts += 1
        assert (shape.target is None) == (shape.data.light == tilted)
    assert parts == math.ceil(count / (cloud_shapes.PAIRS // count))
    whole = path_lengths(shape.made.centers, shape.made.sizes, tilted)
    assert shape.data.absorbed == pytest.approx(absorbed(whole, large.light_penetration), abs=1e-6)
    monkeypatch.setattr(cloud_shapes, "AT_ONCE", 100)
    huge = library.get(large, 1)
    library.light_new(huge, UP)  # by its outline: brighter above than below
    height = huge.made.centers[:, 1]
    lit = huge.data.absorbed
    assert lit[height > 50.0].mean() < 0.4 < 0.6 < lit[height < -50.0].mean()
    while light_one(library, UP):
        pass
    assert huge.data.light == UP
