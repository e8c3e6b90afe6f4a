"""`RainView`: what a camera sees of the rain, told without OpenGL and without a window."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.rain_frames import area, camera, frame, quality
from weather_ecs.frame import AirData, ContainerData, DropLook, FrameData, VeilData, ViewData
from weather_ecs.physics import lod
from weather_ecs.physics.container import Area, ContainerSettings, place
from weather_ecs.physics.drops import drop_density, extinction
from weather_ecs.physics.rain_step import axis_of, law_of, shape_of
from weather_ecs.systems.falls import shown_distance
from weather_ecs.systems.rain_view import RainView

LOOK = DropLook()
NEAR = area()
FAR = area(1, (0.0, -150.0))  # its rim is 110 m off, straight along -z
NORTH = math.pi / 2  # the heading of -z


def counts(view: ViewData) -> dict[int, float]:
    """Drops in use by area, both halves of a whole cylinder counted."""
    found: dict[int, float] = {}
    for container in view.containers:
        found[container.area] = found.get(container.area, 0.0) + container.count
    return found


def facts(container: ContainerData) -> tuple[Any, ...]:
    return tuple(getattr(container, name) for name in container.__slots__ if name != "births")


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


# Time


def test_a_second_draw_in_a_frame_does_not_move_anything():
    rain = RainView()
    rain.view(frame(NEAR, time=1.0), camera(), 0, quality())
    first = rain.view(frame(NEAR, time=1.02), camera((0.05, 1.7, 0.0)), 0, quality())
    second = rain.view(frame(NEAR, time=1.02), camera((0.05, 1.7, 0.0)), 0, quality())
    assert first.dt == pytest.approx(0.02) and second.dt == 0.0
    assert first.velocity == second.velocity
    assert [facts(c) for c in first.containers] == [facts(c) for c in second.containers]


@pytest.mark.parametrize("pause", [0.5, 60.0, 1e7])
def test_a_long_pause_is_a_short_step(pause: float):
    rain = RainView()
    rain.view(frame(NEAR, time=1.0), camera(), 0, quality())
    view = rain.view(frame(NEAR, time=1.0 + pause), camera(), 0, quality())
    assert 0.0 < view.dt <= 0.1
    assert view.velocity == (0.0, 0.0, 0.0)


def test_time_that_goes_back_begins_anew():
    rain = RainView()
    for k in range(20):
        rain.view(frame(NEAR, time=9.0 + k / 30), camera((0.1 * k, 1.7, 0.0)), 0, quality())
    view = rain.view(frame(NEAR, time=2.0), camera((0.3, 1.7, 0.0)), 0, quality())
    fresh = RainView().view(frame(NEAR, time=2.0), camera((0.3, 1.7, 0.0)), 0, quality())
    assert view.dt == 0.0 and view.velocity == (0.0, 0.0, 0.0)
    assert [facts(c) for c in view.containers] == [facts(c) for c in fresh.containers]
    later = rain.view(frame(NEAR, time=2.03), camera((0.3, 1.7, 0.0)), 0, quality())
    assert later.dt == pytest.approx(0.03)


# The observer's movement


def walk(velocity: tuple[float, float, float], frames: int, fps: float) -> list[ViewData]:
    rain, views = RainView(), []
    for k in range(frames):
        vx, vy, vz = velocity
        at = camera((vx * k / fps, 1.7 + vy * k / fps, vz * k / fps))
        views.append(rain.view(frame(NEAR, time=k / fps), at, 0, quality()))
    return views


@pytest.mark.parametrize("fps", [24.0, 60.0, 240.0])
@pytest.mark.parametrize("velocity", [(1.4, 0.0, 0.0), (-4.0, 0.5, 4.5), (0.0, -20.0, 0.0)])
def test_the_velocity_is_that_of_the_observer_soon(fps: float, velocity: tuple):
    found = [view.velocity for view in walk(velocity, int(0.4 * fps) + 2, fps)]
    assert found[0] == (0.0, 0.0, 0.0)
    assert found[-1] == pytest.approx(velocity, abs=0.01)
    # Smoothed: it comes close without ever going past.
    speeds = np.linalg.norm(found, axis=1)
    assert (np.diff(speeds) >= -1e-9).all() and speeds.max() <= np.linalg.norm(velocity) + 1e-9


def test_turning_on_the_spot_is_no_movement():
    rain = RainView()
    for k in range(30):
        view = rain.view(frame(NEAR, time=k / 60), camera(heading=0.2 * k), 0, quality())
    assert np.allclose(view.velocity, 0.0, atol=1e-9)


def test_a_teleport_is_no_movement_and_takes_the_container_along():
    rain = RainView()
    big = area(radii=(5000.0, 5000.0))
    for k in range(10):
        rain.view(frame(big, time=k / 60), camera((0.1 * k, 1.7, 0.0)), 0, quality())
    view = rain.view(frame(big, time=10 / 60), camera((900.0, 1.7, -40.0)), 0, quality())
    assert view.velocity == (0.0, 0.0, 0.0)
    (c,) = view.containers
    # Dragged to within the margin, and its back behind the observer by as much again.
    assert math.dist(c.axis[:2], (900.0, -40.0)) <= 2.0 * LOOK.margin + 0.25 + 1e-6
    assert c.count == pytest.approx(1000.0)


# Several observers, areas that go


def test_observers_do_not_know_of_each_other():
    rain, alone = RainView(), RainView()
    for k in range(40):
        seen = frame(NEAR, FAR, time=k / 30)
        mine = camera((0.2 * k, 1.7, 0.0), 0.1 * k)
        rain.view(seen, camera((5.0, 1.7, -0.5 * k), NORTH), 2, quality())
        both, one = rain.view(seen, mine, 1, quality()), alone.view(seen, mine, 1, quality())
        assert [facts(c) for c in both.containers] == [facts(c) for c in one.containers]
        assert (both.velocity, both.dt) == (one.velocity, one.dt)


def test_who_is_forgotten_begins_anew():
    rain = RainView()
    for key in (1, 2):
        rain.view(frame(NEAR, time=1.0), camera(), key, quality())
    rain.forget(1)
    rain.forget(1)
    rain.forget(99)
    inside_margin = camera((0.5, 1.7, 0.0))
    moved = rain.view(frame(NEAR, time=1.02), inside_margin, 1, quality())
    stayed = rain.view(frame(NEAR, time=1.02), inside_margin, 2, quality())
    assert (moved.dt, stayed.dt) == (0.0, pytest.approx(0.02))
    assert moved.containers[0].axis != stayed.containers[0].axis


def test_a_deleted_area_is_gone_and_not_remembered():
    rain = RainView()
    rain.view(frame(NEAR, area(1, (3.0, 0.0)), time=0.0), camera(), 0, quality())
    left = rain.view(frame(NEAR, time=0.1), camera(), 0, quality())
    assert set(counts(left)) == {0} and len(left.veils) == 1
    assert list(rain._observed[0].placed) == [0]
    dry = rain.view(frame(area(rain_rate=0.0), time=0.2), camera(), 0, quality())
    assert dry.containers == () and rain._observed[0].placed == {}
    # What begins again has the place of a new one, and gets its drops little by little.
    at = camera((0.3, 1.7, 0.0))
    (again,) = rain.view(frame(NEAR, time=0.3), at, 0, quality()).containers
    (new,) = RainView().view(frame(NEAR, time=0.3), at, 0, quality()).containers
    assert (again.axis, again.shape) == (new.axis, new.shape)
    assert again.count == pytest.approx(0.2 * new.count)
    assert again.load * again.count == pytest.approx(new.load * new.count)


# Veils


def veils(seen: FrameData, at: Any, choice: Any = None) -> tuple[VeilData, ...]:
    return RainView().view(seen, at, 0, choice or quality()).veils


def test_a_veil_says_how_deep_the_rain_is():
    row = area(0, (0.0, -150.0), (80.0, 40.0), 25.0, 0.4, 10.0, 350.0)
    (veil,) = veils(frame(row), camera((0.0, 30.0, 0.0), NORTH))
    assert veil.axis == pytest.approx((0.0, -150.0, math.cos(0.4), math.sin(0.4)))
    assert veil.shape == pytest.approx((80.0, 40.0, (1.0 - 10.0 / 40.0) ** 2))
    assert veil.span[0] < -200.0 and veil.span[1] == 350.0
    assert veil.extinction == pytest.approx(LOOK.veil * float(extinction(25.0)), rel=0.01)


def test_vast_rain_is_as_clear_as_its_law_says():
    found = []
    for radius in (40.0, 500.0, 20_000.0):
        row = area(0, (0.0, -150.0), (2.0 * radius, radius), 25.0, 0.4, 10.0, 350.0)
        (veil,) = veils(frame(row), camera((0.0, 30.0, 0.0), NORTH))
        found.append(veil.extinction / float(extinction(25.0)))
    assert found == pytest.approx([LOOK.veil, 0.5 * (1.0 + LOOK.veil), 1.0], rel=0.01)


def test_soft_edges_of_a_veil_from_none_to_all():
    for soft, inner in ((0.0, 0.9999), (10.0, 0.5625), (40.0, 0.0), (900.0, 0.0)):
        (veil,) = veils(frame(area(soft_edge=soft)), camera())
        assert veil.shape[2] == pytest.approx(inner)


def test_no_veils_where_the_quality_or_the_look_has_none():
    assert veils(frame(NEAR), camera(), quality(veil=False)) == ()
    assert veils(frame(NEAR, look=DropLook(veil=0.0)), camera()) == ()


def test_the_drops_share_of_the_veil_ends_where_there_are_no_drops():
    shown = []
    for share in (-0.2, 0.0, 0.3, 0.6, 0.99, 1.01, 9.0):  # of the reach, from the observer
        z = -40.0 - share * LOOK.reach
        (veil,) = veils(frame(area(0, (0.0, z))), camera(heading=NORTH))
        shown.append(veil.shown)
    assert shown == sorted(shown, reverse=True)
    assert shown[0] == shown_distance(LOOK, 25.0, 1000)
    assert shown[-2:] == [0.0, 0.0] and shown[-3] > 0.0


def test_what_drops_show_grows_with_their_number_and_falls_with_the_rain():
    by_count = [shown_distance(LOOK, 25.0, n) for n in (1, 100, 1000, 10_000, 100_000, 10**7)]
    by_rate = [shown_distance(LOOK, rate, 10_000) for rate in (0.5, 5.0, 50.0, 500.0)]
    assert by_count == sorted(by_count) and by_rate == sorted(by_rate, reverse=True)
    assert 0.0 < by_count[0] < 1.0
    # As many drops as in nature show all of it, but for the last quarter, where they thin out:
    # the line from 1 to 0 that has the integral of that, 7/8 of the reach.
    assert by_count[-1] == pytest.approx(2.0 * 0.875 * LOOK.reach, rel=0.01)
    assert shown_distance(replace(LOOK, opacity=0.0), 25.0, 1000) == 0.0


def test_containers_and_veils_know_when_the_rain_began() -> None:
    dry = (20.0, 1e9, 0.0, 0.0)
    seen = frame(area(3), area(5, (10.0, 0.0)), fronts={5: dry})
    view = RainView(1).view(seen, camera(), 0, quality())
    assert {c.area: c.dry for c in view.containers} == {3: (0.0, 0.0, 0.0, 0.0), 5: dry}
    assert [veil.dry for veil in view.veils] == [(0.0, 0.0, 0.0, 0.0), dry]
    assert view.veils[0].slope == pytest.approx(4.1 * 25.0**-0.21)


def test_snow_that_begins_fades_in_with_its_water() -> None:
    cold, dry = AirData(-5.0, 0.9, -5.5, 1.0), (60.0, 1e9, 0.0, 0.0)
    loads = []
    for fronts in ({}, {0: dry}):
        seen = frame(area(rain_rate=3.0), air=cold, fronts=fronts)
        (container, *_) = RainView(1).view(seen, camera(), 0, quality()).containers
        assert container.dry == (0.0, 0.0, 0.0, 0.0)
        loads.append(container.load)
    assert 0.0 < loads[1] < 0.9 * loads[0]


def test_a_shower_is_a_darker_curtain_from_outside_and_plain_within() -> None:
    """Little by little from its rim on; light rain hangs from thin clouds."""
    wet = frame(area(radii=(60.0, 40.0), rain_rate=25.0), wind=(6.0, 0.0, 0.0))
    seen = [veils(wet, camera((0.0, 1.7, z), NORTH))[0] for z in np.linspace(0.0, 120.0, 241)]
    shade, rays = np.array([(veil.cloud, veil.ragged) for veil in seen]).T
    inside = np.linspace(0.0, 120.0, 241) < 39.0
    assert not shade[inside].any() and not rays[inside].any()
    assert (np.diff(shade) >= 0.0).all() and np.diff(shade).max() < 0.03
    assert shade[-1] > 0.9 and rays[-1] > 0.5 and seen[-1].drift[0] > 0.0
    thin = frame(area(radii=(60.0, 40.0), rain_rate=0.5))
    assert 0.0 < veils(thin, camera((0.0, 1.7, 120.0), NORTH))[0].cloud < 0.2


def test_rain_is_hidden_by_its_cloud_from_above():
    carried = replace(frame(FAR), carried=frozenset((1,)))
    top = 400.0  # m, the ceiling of every area here

    def extinction_from(height: float, seen: FrameData) -> float:
        found = RainView().view(seen, camera((0.0, height, 0.0), NORTH, -0.5), 0, quality()).veils
        return sum(veil.extinction for veil in found)

    below, between, above = (extinction_from(top + rise, carried) for rise in (-10.0, 250.0, 600.0))
    assert 0.0 < between < 0.7 * below
    assert above == 0.0
    assert extinction_from(top + 600.0, frame(FAR)) > 0.0  # there is no cloud over a game's own
