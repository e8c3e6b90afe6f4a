"""Walking without a window: gravity, steps, walls, look."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from demo_game.collision import Box, Colliders, Post
from demo_game.player import (
    EYE_HEIGHT,
    JUMP_SPEED,
    PITCH_LIMIT,
    RADIUS,
    RUN_SPEED,
    WALK_SPEED,
    Intent,
    Player,
)

AHEAD = Intent(forward=1.0)
STILL = Intent()


class Flat:
    """Level ground with a stair of blocks, for players to walk on."""

    bounds = (np.array((-50.0, -9.0, -50.0)), np.array((50.0, 9.0, 50.0)))

    def __init__(self, slope: float = 0.0, stair: float = 0.0) -> None:
        self.slope, self.stair = slope, stair

    def floor_height(self, x: float, z: float, y: float) -> float:
        """A slope that rises towards -z, and steps of `stair` metres every metre from z = -5."""
        steps = max(0, min(4, math.ceil(-z - 5.0))) if self.stair else 0
        return -z * self.slope + steps * self.stair


def walk(player: Player, seconds: float, intent: Intent = AHEAD, dt: float = 1 / 60) -> None:
    for _ in range(round(seconds / dt)):
        player.update(dt, intent)


def player_at(x: float, z: float, ground: Flat | None = None, *shapes: Box | Post) -> Player:
    player = Player(ground or Flat(), Colliders.of(shapes))
    player.place_at(x, z, 0.0)
    return player


def test_walks_ahead_at_walking_and_running_speed() -> None:
    player = player_at(0.0, 0.0)
    walk(player, 2.0)
    before = player.position.copy()
    walk(player, 1.0)
    assert before[2] - player.position[2] == pytest.approx(WALK_SPEED, rel=0.01)
    walk(player, 2.0, Intent(forward=1.0, run=True))
    before = player.position.copy()
    walk(player, 1.0, Intent(forward=1.0, run=True))
    assert before[2] - player.position[2] == pytest.approx(RUN_SPEED, rel=0.01)
    assert player.position[0] == pytest.approx(0.0)


def test_diagonal_is_no_faster() -> None:
    player = player_at(0.0, 0.0)
    walk(player, 1.0, Intent(1.0, 1.0))
    before = player.position.copy()
    walk(player, 1.0, Intent(1.0, 1.0))
    assert math.dist(before, player.position) == pytest.approx(WALK_SPEED, rel=0.01)


def test_turning_left_walks_to_minus_x() -> None:
    player = player_at(0.0, 0.0)
    player.look(math.pi / 2, 0.0)
    walk(player, 1.0)
    assert player.position[0] < -1.0
    assert abs(player.position[2]) < 1e-6


def test_pitch_is_clamped_and_yaw_wraps() -> None:
    player = player_at(0.0, 0.0)
    player.look(0.0, 50.0)
    assert player.pitch == PITCH_LIMIT
    player.look(100.0, -500.0)
    assert player.pitch == -PITCH_LIMIT
    assert -math.pi <= player.yaw <= math.pi


def test_jump_rises_by_its_speed_and_lands() -> None:
    player = player_at(0.0, 0.0)
    heights = []
    player.update(1 / 60, Intent(jump=True))
    for _ in range(120):
        heights.append(float(player.position[1]))
        player.update(1 / 60, STILL)
    assert max(heights) == pytest.approx(JUMP_SPEED**2 / (2 * 9.81), rel=0.03)
    assert player.position[1] == 0.0
    assert player.on_ground


def test_no_second_jump_in_the_air() -> None:
    player = player_at(0.0, 0.0)
    highest = 0.0
    for _ in range(40):
        player.update(1 / 60, Intent(jump=True))
        highest = max(highest, float(player.position[1]))
    assert highest < 1.0


@pytest.mark.parametrize(("height", "climbed"), [(0.18, True), (0.34, True), (0.5, False)])
def test_steps_up_to_their_limit(height: float, climbed: bool) -> None:
    player = player_at(0.0, 0.0, Flat(stair=height))
    walk(player, 8.0)
    if climbed:
        assert player.position[1] == pytest.approx(4 * height)
    else:
        assert player.position[1] == 0.0
        assert player.position[2] > -5.01


def test_walks_down_a_slope_without_falling() -> None:
    player = player_at(0.0, 0.0, Flat(slope=0.3))
    player.look(math.pi, 0.0)
    for _ in range(180):
        player.update(1 / 60, Intent(forward=1.0, run=True))
        assert player.on_ground
    assert player.position[1] < -3.0


def test_slides_along_a_wall() -> None:
    wall = Box((0.0, -3.0), (20.0, 0.1), 0.0, 3.0, heading=0.3)
    player = player_at(0.0, 0.0, None, wall)
    walk(player, 6.0)
    assert abs(player.position[0]) > 1.5  # it went sideways
    assert not_inside(player, wall)


def test_stands_still_in_a_corner() -> None:
    walls = (Box((0.0, -3.0), (5.0, 0.1), 0.0, 3.0), Box((2.0, 0.0), (0.1, 5.0), 0.0, 3.0))
    player = player_at(0.0, 0.0, None, *walls)
    walk(player, 6.0, Intent(1.0, 1.0))
    before = player.position.copy()
    walk(player, 1.0, Intent(1.0, 1.0))
    assert math.dist(before, player.position) < 0.01
    assert all(not_inside(player, wall) for wall in walls)


@pytest.mark.parametrize("dt", [1 / 240, 1 / 60, 0.1, 1.0, 7.0])
def test_no_dt_tunnels_through_a_thin_wall(dt: float) -> None:
    player = player_at(0.0, 0.0, None, Box((0.0, -4.0), (30.0, 0.02), 0.0, 3.0))
    for _ in range(max(2, round(3.0 / dt))):
        player.update(dt, Intent(forward=1.0, run=True))
    assert player.position[2] > -4.0 + RADIUS - 0.03


def test_low_block_is_stepped_on_and_high_lintel_walked_under() -> None:
    player = player_at(
        0.0, 0.0, None, Box((0.0, -3.0), (1.0, 1.0), 0.0, 0.3), Box((0, -3), (1, 1), 2.5, 3.0)
    )
    heights = []
    for _ in range(180):
        player.update(1 / 60, AHEAD)
        heights.append(float(player.position[1]))
    assert max(heights) == pytest.approx(0.3)
    assert player.position[2] < -4.5
    assert player.position[1] == 0.0


def test_head_stops_at_a_ceiling() -> None:
    player = player_at(0.0, 0.0, None, Box((0.0, 0.0), (3.0, 3.0), 2.0, 2.2))
    highest = 0.0
    for index in range(60):
        player.update(1 / 60, Intent(jump=index == 0))
        highest = max(highest, float(player.position[1]))
    assert 0.1 < highest < 0.25
    assert player.on_ground


def test_stays_inside_the_bounds() -> None:
    player = player_at(0.0, 0.0)
    walk(player, 12.0, Intent(forward=1.0, run=True))
    assert player.position[2] == -50.0


def test_eye_follows_a_step_gently() -> None:
    player = player_at(0.0, -4.5, Flat(stair=0.3))
    eyes = []
    for _ in range(120):
        player.update(1 / 60, AHEAD)
        eyes.append(player.pose().eye[1])
    assert max(abs(b - a) for a, b in zip(eyes, eyes[1:], strict=False)) < 0.08
    walk(player, 4.0, STILL)
    assert player.pose().eye[1] == pytest.approx(float(player.position[1]) + EYE_HEIGHT, abs=1e-3)


@pytest.mark.parametrize("dt", [-0.1, math.nan, math.inf])
def test_a_bad_dt_is_refused(dt: float) -> None:
    with pytest.raises(ValueError, match="dt"):
        player_at(0.0, 0.0).update(dt, STILL)


@settings(max_examples=60, deadline=None)
@given(
    st.lists(
        st.tuples(
            st.floats(-4, 4), st.floats(-4, 4), st.floats(0.05, 2), st.floats(0.05, 2),
            st.floats(-3, 3), st.booleans(),
        ),
        min_size=1, max_size=5,
    ),
    st.floats(-math.pi, math.pi),
)  # fmt: skip
def test_never_ends_inside_a_shape(rows: list[tuple], yaw: float) -> None:
    shapes: list[Box | Post] = []
    for x, z, a, b, turn, is_post in rows:
        if math.hypot(x, z) < math.hypot(a, b) + 0.5:
            continue  # the player starts at the origin
        shapes.append(
            Post((x, z), min(a, 0.5), 0.0, 3.0) if is_post else Box((x, z), (a, b), 0, 3, turn)
        )
    player = player_at(0.0, 0.0, None, *shapes)
    player.look(yaw, 0.0)
    for _ in range(40):
        player.update(0.05, Intent(forward=1.0, run=True))
        assert np.isfinite(player.position).all()
        assert all(not_inside(player, shape) for shape in shapes)


def not_inside(player: Player, shape: Box | Post) -> bool:
    """Brute force: the shape's outline comes no nearer than the body's radius, less a little."""
    x, _, z = player.position
    dx, dz = x - shape.center[0], z - shape.center[1]
    if isinstance(shape, Post):
        return math.hypot(dx, dz) > shape.radius + RADIUS - 0.03
    c, s = math.cos(shape.heading), math.sin(shape.heading)
    u, w = dx * c - dz * s, dx * s + dz * c
    gap = math.hypot(max(abs(u) - shape.half[0], 0.0), max(abs(w) - shape.half[1], 0.0))
    return gap > RADIUS - 0.03


def test_flight_goes_where_the_eyes_look_and_ends_on_the_ground() -> None:
    player = Player(Flat())
    player.switch_flight()
    player.look(0.0, math.radians(30.0))
    for _ in range(600):
        player.update(1.0 / 60.0, Intent(forward=1.0, run=True))
    x, y, z = player.position
    assert abs(x) < 1e-6 and z < -1000.0  # beyond the rim of the place
    assert y == pytest.approx(-z * math.tan(math.radians(30.0)), rel=1e-6)
    for _ in range(600):
        player.update(1.0 / 60.0, STILL)
    assert np.linalg.norm(player.velocity) < 1e-6  # it hangs in the air
    player.look(0.0, math.radians(-90.0))
    for _ in range(3600):
        player.update(1.0 / 60.0, Intent(forward=1.0, run=True))
    assert player.position[1] == 0.0  # not through the ground
    player.switch_flight()
    assert player.position[2] == -50.0
    for _ in range(120):
        player.update(1.0 / 60.0, STILL)
    assert player.on_ground and player.position[1] == 0.0
