"""Containers of a view as time passes and observers move, come and go."""

from __future__ import annotations

import math
from typing import Any

import numpy as np
import pytest

from tests.rain_frames import area, camera, frame, quality
from tests.rain_views import FAR, LOOK, NEAR, NORTH, counts
from weather_ecs.frame import ContainerData, ViewData
from weather_ecs.systems.rain_view import RainView


def facts(container: ContainerData) -> tuple[Any, ...]:
    return tuple(getattr(container, name) for name in container.__slots__ if name != "births")


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
