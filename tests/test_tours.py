"""The camera's ways: smooth, the same at any frame rate, through every stage."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from demo_game.camera import Pose, look_direction, projection_matrix, view_matrix, yaw_pitch
from demo_game.curve import Path, Smooth
from demo_game.player import EYE_HEIGHT
from demo_game.tours import EDGE_Z, TOURS, make_tour


class Flat:
    """Level ground."""

    bounds = (np.array((-200.0, -9.0, -200.0)), np.array((200.0, 9.0, 200.0)))

    def floor_height(self, x: float, z: float, y: float) -> float:
        return 0.0


GROUND = Flat()


def positions(name: str, frames: int, dt: float = 1 / 60, speed: float = 1.4) -> np.ndarray:
    tour = make_tour(name, GROUND, (frames - 1) * dt, speed)
    return np.array([tour.pose(i * dt).eye for i in range(frames)])


@pytest.mark.parametrize("name", TOURS)
def test_poses_are_finite_and_at_eye_height(name: str) -> None:
    eyes = positions(name, 200)
    assert np.isfinite(eyes).all()
    on_foot = eyes[:140] if name == "clouds" else eyes
    assert np.abs(on_foot[:, 1] - EYE_HEIGHT).max() < 0.05


def test_walk_goes_through_every_stage_in_any_number_of_frames() -> None:
    for frames in (40, 600):
        tour = make_tour("walk", GROUND, (frames - 1) / 60)
        stages = list(dict.fromkeys(tour.stage(i / 60) for i in range(frames)))
        assert stages == [
            "far", "approach", "edge", "inside", "cabin", "out", "leaving", "looking back",
        ]  # fmt: skip


def test_walk_is_the_same_way_at_any_frame_rate() -> None:
    few, many = positions("walk", 61, 1 / 6), positions("walk", 601, 1 / 60)
    assert np.abs(few - many[::10]).max() < 1e-9


def test_walk_starts_dry_crosses_and_ends_dry() -> None:
    eyes = positions("walk", 600)
    inside = (eyes[:, 0] / 70.0) ** 2 + ((eyes[:, 2] + 70.0) / 45.0) ** 2 < 1.0
    assert not inside[0]
    assert not inside[-1]
    assert np.abs(np.diff(inside.astype(int))).sum() == 2  # in once, out once
    steps = np.linalg.norm(np.diff(eyes[:, [0, 2]], axis=0), axis=1)
    assert np.abs(np.diff(steps)).max() < 0.2 * steps.max()  # no jerk in speed


@pytest.mark.parametrize("name", ["walk", "run", "crossing", "clouds", "snow", "storm", "night"])
def test_looks_turn_gently(name: str) -> None:
    tour = make_tour(name, GROUND, 599 / 60)
    poses = [tour.pose(i / 60) for i in range(600)]
    yaws = np.unwrap([pose.yaw for pose in poses])
    assert np.abs(np.diff(yaws)).max() < math.radians(7.0)
    assert max(abs(pose.pitch) for pose in poses) < math.radians(35.0)


@pytest.mark.parametrize(("name", "speed"), [("run", 6.0), ("crossing", 1.4), ("crossing", 6.0)])
def test_true_speeds(name: str, speed: float) -> None:
    eyes = positions(name, 100, speed=speed)
    steps = np.linalg.norm(np.diff(eyes[:, [0, 2]], axis=0), axis=1) * 60
    assert steps == pytest.approx(speed, rel=0.03)


def test_crossing_goes_from_twelve_metres_outside_to_inside() -> None:
    eyes = positions("crossing", 60 * 20)
    assert eyes[0, 2] == pytest.approx(EDGE_Z + 12.0)
    assert eyes[-1, 2] < EDGE_Z - 12.0
    assert np.abs(eyes[:, 0]).max() < 1e-9


def test_still_does_not_move() -> None:
    eyes = positions("still", 50)
    assert (eyes == eyes[0]).all()


def test_one_frame_is_enough() -> None:
    for name in TOURS:
        assert np.isfinite(make_tour(name, GROUND, 0.0).pose(0.0).eye).all()


def test_an_unknown_tour_is_refused() -> None:
    with pytest.raises(ValueError, match="walk, run, crossing, still, clouds, snow, storm, night"):
        make_tour("moon", GROUND, 1.0)


@pytest.mark.parametrize("frames", [30, 600, 6000])
def test_the_clouds_tour_fills_the_sky_and_flies_over_it(frames: int) -> None:
    duration = (frames - 1) / 60
    tour = make_tour("clouds", GROUND, duration)
    assert tour.play is not None
    turns = [tour.play.at(u * duration, 0.0) for u in np.linspace(0.0, 1.0, 201)]
    states = [turn.mood.state for turn in turns]
    assert states[0] == 0.0
    assert states[-1] == 1.0
    assert (np.diff(states) >= 0.0).all()
    assert all(turn.rains and turn.mood.rain_rate == 0.0 for turn in turns)
    # The sky needs minutes to fill, however short the tour is, and near rain falls as it does.
    passed = sum(turn.speed for turn in turns) / len(turns) * duration
    assert passed >= 200.0 * min(1.0, duration / 0.3)
    assert {turn.speed for turn in turns[130:]} == {1.0}
    heights = [tour.pose(u * duration).eye[1] for u in np.linspace(0.0, 1.0, 201)]
    assert max(heights[:145]) == pytest.approx(EYE_HEIGHT)
    assert heights[-1] > 4000.0
    assert tour.pose(duration).pitch < 0.0
    stages = list(dict.fromkeys(tour.stage(u * duration) for u in np.linspace(0.0, 1.0, 201)))
    assert stages[0] == "clear"
    assert stages[-1] == "over the tops"


@pytest.mark.parametrize("frames", [30, 600, 60_000])
def test_the_snow_tour_begins_snows_and_stops(frames: int) -> None:
    duration = (frames - 1) / 60
    play = make_tour("snow", GROUND, duration).play
    assert play is not None
    before, during, after = (play.at(u * duration, 0.0) for u in (0.02, 0.55, 0.95))
    assert before.mood.rain_rate == after.mood.rain_rate == 0.0
    assert during.mood.rain_rate == 3.5
    assert max(turn.mood.temperature for turn in (before, during, after)) < 0.0
    assert during.speed == 1.0
    assert before.speed >= 1.0
    assert 1.0 <= (during.settling or 0.0) <= 100.0


@pytest.mark.parametrize("frames", [30, 600, 60_000])
def test_the_storm_tour_brings_a_storm_and_strikes(frames: int) -> None:
    duration = (frames - 1) / 60
    play = make_tour("storm", GROUND, duration).play
    assert play is not None
    turns = [play.at(u * duration, 0.0) for u in np.linspace(0.0, 1.0, 101)]
    assert [turns[0].whole, turns[-1].whole] == ["fair_cumulus", "thunderstorm"]
    assert {turn.speed for turn in turns[53:]} == {1.0}
    counts = [len(turn.strikes) for turn in turns]
    assert counts[50] == 0  # none in the time-lapse
    assert counts[-1] >= 3
    assert (np.diff(counts) >= 0).all()
    centers = np.array([turn.center for turn in turns])
    assert (np.diff(centers[:, 1]) >= 0.0).all()  # its rain comes nearer


@given(st.lists(st.floats(-10, 10), min_size=3, max_size=8))
def test_smooth_passes_through_its_values_and_never_overshoots(values: list[float]) -> None:
    curve = Smooth(range(len(values)), values)
    for index, value in enumerate(values):
        assert curve(index) == pytest.approx(value, abs=1e-9)
    for index in range(len(values) - 1):
        low, high = sorted(values[index : index + 2])
        for t in (0.1, 0.5, 0.9):
            assert low - 1e-9 <= curve(index + t) <= high + 1e-9


def test_path_keeps_its_ends() -> None:
    path = Path([(0, 0), (10, 0), (10, -10)], rounding=3.0)
    assert path(0.0) == pytest.approx((0.0, 0.0), abs=1e-9)
    assert path(path.length) == pytest.approx((10.0, -10.0), abs=1e-9)
    corner = path(10.0)
    assert 0.1 < math.dist(corner, (10, 0)) < 1.0  # rounded, not cut off


@given(st.floats(-3.1, 3.1), st.floats(-1.5, 1.5))
def test_view_looks_along_its_direction(yaw: float, pitch: float) -> None:
    eye = (3.0, 2.0, -7.0)
    view = view_matrix(Pose(eye, yaw, pitch))
    ahead = view @ np.array((*(np.array(eye) + look_direction(yaw, pitch)), 1.0))
    assert ahead == pytest.approx((0.0, 0.0, -1.0, 1.0), abs=1e-9)
    assert yaw_pitch(look_direction(yaw, pitch)) == pytest.approx((yaw, pitch), abs=1e-9)
    assert np.linalg.det(view[:3, :3]) == pytest.approx(1.0)


def test_projection_has_the_field_of_view_asked_for() -> None:
    hfov = math.radians(80.0)
    projection = projection_matrix(hfov, 16 / 9)
    edge = projection @ np.array((math.tan(hfov / 2), 0.0, -1.0, 1.0))
    assert edge[0] / edge[3] == pytest.approx(1.0)
    tall = projection_matrix(hfov, 0.2)
    assert 2 * math.atan(1 / tall[1, 1]) <= math.radians(110.001)
