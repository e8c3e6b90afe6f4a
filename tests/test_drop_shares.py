"""How drops are shared out: slots that are lost and won, halves of a container, and its depth."""

from __future__ import annotations

import math

import numpy as np
import pytest

from tests.rain_frames import area, camera, frame, quality
from weather_ecs.frame import DropLook, OccluderData, ViewData
from weather_ecs.systems.drop_shares import RATE, importances
from weather_ecs.systems.rain_view import RainView
from weather_ecs.systems.scene_floor import SceneFloor

DT = 1 / 30
LOOK = DropLook()
QUAD = np.array([0, 1, 2, 1, 3, 2], np.uint32)


def slab(
    height: float, x: float = 0.0, z: float = 0.0, half: float = 200.0, dynamic: bool = False
) -> OccluderData:
    """A level square."""
    corners = [(sx * half, height, sz * half) for sx in (-1, 1) for sz in (-1, 1)]
    place = np.eye(4)
    place[0, 3], place[2, 3] = x, z
    return OccluderData(0, place, dynamic, np.array(corners, np.float32), QUAD)


def totals(view: ViewData) -> dict[int, float]:
    found: dict[int, float] = {}
    for c in view.containers:
        found[c.area] = found.get(c.area, 0.0) + c.count
    return found


# Slots


def test_first_the_ones_that_matter_most_are_shown_at_once() -> None:
    wanted = {0: 0.2, 1: 1.0, 2: 0.5, 3: 0.0}
    assert importances(None, wanted, 2, 0.0) == {1: 1.0, 2: 0.5}
    assert importances(None, wanted, 9, 0.0) == {0: 0.2, 1: 1.0, 2: 0.5}
    assert importances(None, wanted, 0, 0.0) == {}


def test_who_loses_a_slot_fades_out_before_another_comes_in() -> None:
    now = importances(None, {0: 0.6, 1: 0.4}, 1, 0.0)
    assert now == {0: 0.6}
    wanted, seen = {0: 0.4, 1: 0.6}, []
    for _ in range(60):
        now = importances(now, wanted, 1, DT)
        seen.append((now.get(0, 0.0), now.get(1, 0.0)))
        assert len(now) <= 1 and all(value > 0.0 for value in now.values())
    steps = np.abs(np.diff([(0.6, 0.0), *seen], axis=0))
    assert steps.max() <= RATE * DT + 1e-9
    assert seen[-1] == (0.0, 0.6)


def test_two_alike_do_not_take_turns() -> None:
    now = importances(None, {0: 0.50, 1: 0.49}, 1, 0.0)
    for k in range(40):
        now = importances(now, {0: 0.50, 1: 0.49 + 0.02 * (k % 2)}, 1, DT)
        assert now == {0: 0.50}


def test_no_time_no_change() -> None:
    assert importances({0: 0.3}, {0: 1.0, 1: 0.9}, 2, 0.0) == {0: 0.3}


def test_fewer_slots_hold_at_once() -> None:
    now = importances({0: 0.3, 1: 0.9, 2: 0.5}, {0: 0.3, 1: 0.9, 2: 0.5}, 2, DT)
    assert set(now) == {1, 2}


def test_drops_of_an_area_that_loses_its_slot_glide_out() -> None:
    # Two areas to either side; walking from one towards the other changes which one is nearer.
    rows = area(0, (-90.0, 0.0), (30.0, 30.0)), area(1, (90.0, 0.0), (30.0, 30.0))
    rain, found = RainView(), []
    for k in range(240):
        x = min(-80.0 + k, 80.0)
        at = camera((x, 1.7, 150.0), math.pi / 2)
        view = rain.view(frame(*rows, time=k * DT), at, 0, quality(1000, 1))
        assert len({c.area for c in view.containers}) <= 1
        found.append([totals(view).get(key, 0.0) for key in (0, 1)])
    steps = np.abs(np.diff(found, axis=0))
    assert steps.max() <= RATE * DT * 1000.0 + 1e-6
    assert found[0][0] > 200.0 and found[0][1] == 0.0
    assert found[-1][1] > 200.0 and found[-1][0] == 0.0


# Halves


def test_looking_down_costs_no_more_and_nothing_jumps() -> None:
    rain, front, rear = RainView(), [], []
    row = area(radii=(500.0, 500.0))
    for k in range(120):
        pitch = -1.5 * math.sin(math.pi * k / 119)
        at = camera((0.0, 5.0, 0.0), 0.3, pitch)
        view = rain.view(frame(row, time=k * DT), at, 0, quality(1000))
        halves = {c.key & 1: c for c in view.containers}
        front.append(halves[0].count)
        rear.append(halves[1].count if 1 in halves else 0.0)
        for half in halves.values():  # each has all the rain of its own half
            assert half.load * half.count == pytest.approx(halves[0].load * halves[0].count)
            assert half.count <= len(half.births)
    assert np.allclose(np.add(front, rear), 1000.0)
    assert rear[0] == 0.0 and max(rear) == pytest.approx(500.0) and rear[-1] < 500.0
    assert np.abs(np.diff(rear)).max() <= 3.0 * DT * 1000.0 + 1e-6


def test_the_rear_half_is_full_before_it_is_in_view() -> None:
    for degrees in range(0, 90, 2):
        at = camera((0.0, 5.0, 0.0), 0.0, -math.radians(degrees))
        view = RainView().view(frame(area()), at, 0, quality(1000))
        halves = {c.key & 1: c for c in view.containers}
        if at.half_width > math.radians(82.0):
            assert halves[1].count == pytest.approx(halves[0].count)
        if at.half_width < math.radians(68.0):
            assert set(halves) == {0}


# Depth


def test_the_floor_is_the_lowest_of_what_stands_still_ahead() -> None:
    scene = SceneFloor()
    assert scene.lowest((), (0.0, 0.0, 0.0), 0.0, 30.0) is None
    ground, pit, tower = slab(-2.0), slab(-9.0, x=120.0, half=60.0), slab(11.0, half=2.0)
    assert scene.lowest((ground, tower), (0.0, 12.0, 0.0), 0.0, 30.0) == -2.0
    # The pit lies under the ground where both are, and nothing is known beyond them.
    assert scene.lowest((ground, pit), (50.0, 2.0, 0.0), 0.0, 30.0) == -2.0
    assert scene.lowest((pit,), (100.0, 2.0, 0.0), 0.0, 30.0) == -9.0
    assert scene.lowest((pit,), (900.0, 2.0, 0.0), 0.0, 30.0) is None
    moving = slab(-30.0, dynamic=True)
    assert scene.lowest((ground, moving), (0.0, 2.0, 0.0), 0.0, 30.0) == -2.0
    turned = slab(0.0, half=40.0)
    turned.transform[:3, :3] = [[0, 1, 0], [-1, 0, 0], [0, 0, 1]]  # on its edge
    assert scene.lowest((turned,), (-5.0, 2.0, 0.0), 0.0, 30.0) is None


@pytest.mark.parametrize("eye", [1.7, 5.0, 15.0, 25.0])
def test_rain_reaches_the_ground_below_a_tower_and_is_as_dense(eye: float) -> None:
    at = camera((0.0, eye, 0.0))
    ground = (slab(0.0), slab(eye - 1.7, half=2.0))
    (c,) = RainView().view(frame(area(), occluders=ground), at, 0, quality()).containers
    (flat,) = RainView().view(frame(area()), at, 0, quality()).containers
    assert c.shape[2] <= min(-0.5, eye - 0.3 * LOOK.height) + 1e-9
    assert c.shape[2] + c.shape[3] == pytest.approx(flat.shape[2] + flat.shape[3])
    assert c.load / c.shape[3] == pytest.approx(flat.load / flat.shape[3])
    if eye < 5.5:
        assert c.shape == flat.shape


def test_no_deeper_than_a_limit() -> None:
    at = camera((0.0, 300.0, 0.0))
    (c,) = RainView().view(frame(area(), occluders=(slab(0.0),)), at, 0, quality()).containers
    assert c.shape[2] == pytest.approx(270.0)


def test_the_depth_glides_when_the_ground_falls_away() -> None:
    rain, bottoms, tops = RainView(), [], []
    ground = (slab(0.0, x=-100.0, half=100.0), slab(-20.0, x=200.0, half=200.0))
    row = area(radii=(500.0, 500.0))
    for k in range(300):
        at = camera((min(-60.0 + 0.4 * k, -1.0), 1.7, 0.0))
        view = rain.view(frame(row, time=k * DT, occluders=ground), at, 0, quality())
        (c,) = view.containers
        bottoms.append(c.shape[2])
        tops.append(c.shape[2] + c.shape[3])
    assert bottoms[0] == pytest.approx(1.7 - 6.0) and bottoms[-1] == pytest.approx(-20.5)
    assert np.abs(np.diff(bottoms)).max() <= 4.0 * DT + 1e-6
    assert np.ptp(tops) < 1e-6
