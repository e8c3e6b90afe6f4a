"""`RainView`: what a camera sees of the rain, told without OpenGL and without a window."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.rain_frames import area, camera, frame, quality
from tests.rain_views import FAR, LOOK, NEAR, NORTH, counts
from weather_ecs.frame import ContainerData, DropLook
from weather_ecs.physics import lod
from weather_ecs.physics.container import Area, ContainerSettings, place
from weather_ecs.physics.drops import drop_density
from weather_ecs.physics.rain_step import axis_of, law_of, shape_of
from weather_ecs.systems.rain_view import RainView


def stood_for(container: ContainerData, used: int) -> np.ndarray:
    """Real drops that each drop in use stands for, where it was born; as shaders/streak.vert."""
    record = container.births[:used]
    d = np.hypot(record[:, 0], record[:, 1])
    fade = 1.0 / max(0.1 * container.count, 1.0)
    last = np.clip((container.count - np.arange(used)) * fade, 0.0, 1.0)
    return container.load * d / lod.weight_shape(d) * lod.rim_fade(d / record[:, 2]) * last


# One observer, one area


def test_nothing_falls_from_a_clear_sky():
    for clear in (frame(), frame(area(rain_rate=0.0), area(1, rain_rate=0.0))):
        view = RainView().view(clear, camera(), 0, quality())
        assert view.containers == () and view.veils == ()


def test_the_view_says_whose_it_is():
    seen, at = frame(NEAR, time=3.0), camera((1.0, 2.0, 3.0), 0.4, 0.1)
    view = RainView().view(seen, at, 7, quality())
    assert view.frame is seen and view.key == 7
    assert view.position == at.position == pytest.approx((1.0, 2.0, 3.0))
    assert view.view is at.view and view.projection is at.projection
    assert view.velocity == (0.0, 0.0, 0.0) and view.dt == 0.0


def test_a_container_is_what_the_physics_places():
    at = camera((10.0, 1.7, 5.0), 0.4)
    row = area(3, heading=0.3, soft_edge=500.0, rain_rate=12.0)
    (found,) = RainView().view(frame(row), at, 0, quality(800)).containers
    size = ContainerSettings(LOOK.reach, LOOK.height, LOOK.margin)
    shape = Area((0.0, 0.0), (60.0, 40.0), 0.3, 400.0)
    placed = place(shape, at.position, at.heading, at.half_width, size)
    assert found.axis == axis_of(placed) and found.shape == shape_of(placed)
    assert found.area_axis == pytest.approx((0.0, 0.0, math.cos(0.3), math.sin(0.3)))
    assert found.area_shape == (60.0, 40.0, 40.0, 400.0)  # the soft edge ends at b
    assert found.law == law_of(12.0)
    assert (found.area, found.count, found.size_scale) == (3, 800.0, 1.0)
    assert found.births.shape == (800, 4) and not found.births.flags.writeable


@pytest.mark.parametrize("budget", [1.0, 0.333, 0.05])
@pytest.mark.parametrize(("rate", "reach"), [(2.0, 40.0), (60.0, 15.0)])
def test_the_drops_in_use_stand_for_all_the_real_ones(budget: float, rate: float, reach: float):
    look = DropLook(reach=reach, height=18.0)
    seen = frame(area(radii=(300.0, 300.0), rain_rate=rate), look=look)
    (c,) = RainView(5).view(seen, camera(), 0, quality(200_000, budget=budget)).containers
    assert c.count == pytest.approx(200_000 * budget)
    used = min(int(c.count) + 1, 200_000)
    d, weights = np.hypot(c.births[:used, 0], c.births[:used, 1]), stood_for(c, used)
    # Ring by ring; in the last one a few drops stand for so many that their sum scatters.
    for inner, outer in ((0.0, 0.3), (0.3, 0.6), (0.6, 0.9)):
        volume = 0.5 * math.pi * (outer**2 - inner**2) * reach**2 * 18.0
        mine = weights[(d >= inner) & (d < outer)]
        scatter = math.sqrt(float((mine**2).sum()))
        assert scatter < 0.04 * mine.sum()
        assert mine.sum() == pytest.approx(float(drop_density(rate)) * volume, abs=4.0 * scatter)


def test_a_view_too_wide_has_two_halves_that_make_one_cylinder():
    down = camera((0.0, 10.0, 0.0), 0.3, -1.4)
    view = RainView().view(frame(NEAR), down, 0, quality(500))
    front, rear = view.containers
    assert (front.key, rear.key) == (0, 1)
    assert rear.axis[:2] == front.axis[:2]
    assert np.allclose(rear.axis[2:], np.negative(front.axis[2:]))
    assert (rear.shape, rear.area_shape, rear.load) == (front.shape, front.area_shape, front.load)
    assert not np.array_equal(front.births, rear.births)  # or the halves would mirror each other


def test_births_follow_the_seed_and_are_made_once():
    def born(seed: int, drops: int = 400) -> np.ndarray:
        return RainView(seed).view(frame(NEAR), camera(), 0, quality(drops)).containers[0].births

    assert np.array_equal(born(1), born(1))
    assert not np.array_equal(born(1), born(2))
    rain = RainView(1)
    many = frame(NEAR, area(1, (5.0, 5.0)))
    first = rain.view(many, camera(), 0, quality(400)).containers
    again = rain.view(many, camera(), 9, quality(400, budget=0.2)).containers
    assert first[0].births is first[1].births is again[0].births
    assert len(rain.view(many, camera(), 0, quality(300)).containers[0].births) == 300


# How the drops are shared out


def test_areas_that_overlap_share_the_drops_alike():
    rain = RainView()
    view = rain.view(frame(NEAR, area(1, (5.0, 5.0))), camera(), 0, quality(1000))
    assert counts(view) == pytest.approx({0: 500.0, 1: 500.0})
    assert all(c.load > 0.0 for c in view.containers)


def test_far_rain_takes_fewer_drops_the_farther_it_is():
    shares = []
    for z in (-60.0, -150.0, -400.0, -1500.0):
        view = RainView().view(frame(area(0, (0.0, z))), camera(heading=NORTH), 0, quality(1000))
        shares.append(counts(view)[0])
    assert shares == sorted(shares, reverse=True)
    assert 850.0 < shares[0] <= 1000.0 and shares[-1] < 200.0


def test_alone_an_area_far_off_leaves_drops_unused():
    view = RainView().view(frame(FAR), camera(heading=NORTH), 0, quality(1000))
    (c,) = view.containers
    assert c.count == pytest.approx(1000.0 / (1.0 + 110.0 / (6.0 * LOOK.reach)), rel=0.01)
    assert c.size_scale == pytest.approx(1.0 + 110.0 / LOOK.reach, rel=0.01)


def test_the_budget_scales_the_counts_and_keeps_the_buffers():
    rain = RainView()
    full = rain.view(frame(NEAR, FAR), camera(heading=NORTH), 0, quality(1000))
    tenth = rain.view(frame(NEAR, FAR), camera(heading=NORTH), 0, quality(1000, budget=0.1))
    assert counts(tenth) == pytest.approx({k: 0.1 * n for k, n in counts(full).items()})
    for more, less in zip(full.containers, tenth.containers, strict=True):
        assert more.births is less.births
        assert less.load == pytest.approx(10.0 * more.load)  # so that the rain stays as dense


def test_slots_go_to_the_nearest_areas_and_the_rest_are_veils():
    rows = [area(k, (0.0, -150.0 * (k + 1)), (50.0, 30.0)) for k in range(6)]
    view = RainView().view(frame(*reversed(rows)), camera(heading=NORTH), 0, quality(containers=2))
    assert [c.area for c in view.containers] == [0, 1]
    assert len(view.veils) == 6
    assert [veil.shown > 0.0 for veil in view.veils] == [False] * 6  # all beyond the reach
    none = RainView().view(frame(NEAR), camera(), 0, quality(containers=0))
    assert none.containers == () and len(none.veils) == 1 and none.veils[0].shown == 0.0


def test_what_is_out_of_the_picture_takes_no_drops():
    away = RainView().view(frame(FAR), camera(heading=-NORTH), 0, quality())
    assert away.containers == () and away.veils == ()
    assert len(RainView().view(frame(FAR), camera(heading=NORTH), 0, quality()).veils) == 1


def test_an_area_that_comes_into_the_picture_gets_its_drops_little_by_little():
    rain, dt = RainView(), 1 / 60
    rain.view(frame(FAR), camera(heading=-NORTH), 0, quality(1000))
    found = []
    for k in range(1, 60):
        view = rain.view(frame(FAR, time=k * dt), camera(heading=NORTH), 0, quality(1000))
        found.append(counts(view).get(1, 0.0))
    steps = np.diff([0.0, *found])
    assert steps.max() <= 2.0 * dt * 1000.0 + 1e-6
    assert steps.min() >= -1e-6
    assert found[-1] == pytest.approx(1000.0 / (1.0 + 110.0 / (6.0 * LOOK.reach)), rel=0.01)


coordinate = st.floats(-300.0, 300.0)
radius = st.floats(1e-3, 500.0)
rows_of_areas = st.lists(
    st.tuples(coordinate, coordinate, radius, radius, st.floats(-7, 7), st.floats(0, 500),
              st.floats(0, 600), st.floats(-50, 900)),
    max_size=8,
)  # fmt: skip


@settings(max_examples=60, deadline=None)
@given(
    rows_of_areas,
    st.lists(st.tuples(coordinate, st.floats(-5, 120), coordinate, st.floats(-4, 4),
                       st.floats(-1.5, 1.5), st.floats(0, 3)), min_size=1, max_size=6),
)  # fmt: skip
def test_any_areas_from_anywhere(rows: list[Any], path: list[Any]):
    rain, time = RainView(), 0.0
    areas = [
        area(10 * k, (x, z), (max(a, b), min(a, b)), rate, heading, soft, ceiling)
        for k, (x, z, a, b, heading, rate, soft, ceiling) in enumerate(rows)
    ]
    for x, y, z, heading, pitch, dt in path:
        time += dt
        at, choice = camera((x, y, z), heading, pitch), quality(100, 3, 0.7)
        view = rain.view(frame(*areas, time=time), at, 0, choice)
        keys = [c.key for c in view.containers]
        assert len(set(keys)) == len(keys) and len({key >> 2 for key in keys}) <= 3
        first_halves = sum(c.count for c in view.containers if not c.key & 1)
        assert first_halves <= 100 * 0.7 + 3.0  # every container has one drop at least
        assert 0.0 <= view.dt <= 0.1
        numbers: list[Any] = [view.velocity]
        for c in view.containers:
            numbers += [c.axis, c.shape, c.area_axis, c.area_shape, c.law, (c.load, c.count)]
            assert min(c.shape[0], c.shape[1], c.shape[3], c.load) > 0.0 and c.size_scale >= 1.0
        for veil in view.veils:
            numbers += [veil.axis, veil.shape, veil.span, (veil.extinction, veil.shown)]
            assert 0.0 <= veil.shape[2] < 1.0 and veil.shown >= 0.0
        assert np.isfinite(np.concatenate([np.ravel(n) for n in numbers])).all()
