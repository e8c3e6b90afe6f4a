"""`Clock`: fixed steps out of any frame times."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from weather_ecs.clock import LONGEST, STEP, Clock
from weather_ecs.errors import InvalidValueError

frames = st.lists(st.floats(0.0, 10.0), max_size=60)


def test_sixty_frames_a_second_are_twenty_steps():
    clock = Clock()
    assert sum(clock.advance(1 / 60) for _ in range(60)) == 20
    assert clock.time == pytest.approx(1.0, abs=1e-8)
    assert Clock().advance(STEP) == 1
    assert Clock().advance(0.0) == 0


@settings(deadline=None)
@given(frames)
def test_no_time_is_lost_or_made(times):
    clock = Clock()
    steps = sum(clock.advance(dt) for dt in times)
    assert clock.steps == steps
    assert 0.0 <= clock.remainder < STEP
    assert clock.time == pytest.approx(math.fsum(times), abs=1e-6)
    assert clock.time == clock.steps * STEP + clock.remainder


@settings(deadline=None)
@given(frames)
def test_time_never_runs_back(times):
    clock, before = Clock(), 0.0
    for dt in times:
        clock.advance(dt)
        assert clock.time >= before
        before = clock.time


@settings(deadline=None)
@given(st.integers(1, 400))
def test_however_a_second_is_cut_it_has_twenty_steps(parts):
    clock = Clock()
    assert sum(clock.advance(1.0 / parts) for _ in range(parts)) == 20


def test_an_hour_of_uneven_frames_stays_finite():
    clock, rng = Clock(), np.random.default_rng(1)
    total = 0.0
    while total < 3600.0:
        dt = float(rng.exponential(0.5))
        clock.advance(dt)
        total += min(dt, LONGEST)
    assert clock.time == pytest.approx(total, abs=1e-5)


@pytest.mark.parametrize(
    "dt", [-1e-9, -1.0, math.nan, math.inf, -math.inf, None, "1", True, 1j, [0.1], np.bool_(True)]
)
@pytest.mark.parametrize("paused", [False, True])
def test_bad_times_change_nothing(dt, paused):
    clock = Clock()
    clock.advance(0.07)
    clock.paused = paused
    before = clock.state()
    with pytest.raises(InvalidValueError, match="dt"):
        clock.advance(dt)
    assert clock.state() == before


@pytest.mark.parametrize("dt", [10.5, 3600.0, 1e308])
def test_a_stop_in_the_debugger_counts_as_ten_seconds(dt):
    clock = Clock()
    assert clock.advance(dt) == 200
    assert clock.time == pytest.approx(LONGEST)
    assert clock.dropped == min(dt - LONGEST, 1e300)
    clock.advance(dt)
    assert math.isfinite(clock.dropped)


def test_numpy_numbers_and_integers_are_times():
    clock = Clock()
    assert clock.advance(np.float32(0.5)) == 10
    assert clock.advance(1) == 20
    assert clock.advance(np.int64(1)) == 20


def test_a_paused_clock_stands_still():
    clock = Clock()
    clock.advance(0.52)
    before = clock.time
    clock.paused = True
    assert clock.advance(100.0) == 0
    assert clock.time == before
    assert clock.dropped == 0.0
    clock.paused = False
    assert clock.advance(0.05) == 1


def test_speed():
    clock = Clock()
    clock.speed = 3
    assert clock.advance(1.0) == 60
    clock.speed = 0.0
    assert clock.advance(10.0) == 0
    clock.speed = 1000.0
    assert clock.advance(LONGEST) == 200_000


@pytest.mark.parametrize("speed", [-1, math.nan, math.inf, 1001, None, "2", True])
def test_bad_speeds(speed):
    clock = Clock()
    with pytest.raises(InvalidValueError, match="speed"):
        clock.speed = speed
    assert clock.speed == 1.0


@pytest.mark.parametrize("paused", [0, 1, None, "no"])
def test_bad_pauses(paused):
    with pytest.raises(InvalidValueError, match="paused"):
        Clock().paused = paused


@settings(deadline=None)
@given(frames, frames, st.floats(0, 5), st.booleans())
def test_a_restored_clock_goes_on_alike(before, after, speed, paused):
    clock = Clock()
    clock.speed = speed
    for dt in before:
        clock.advance(dt)
    clock.paused = paused
    twin = Clock.from_state(clock.state())
    assert twin.state() == clock.state()
    assert [twin.advance(dt) for dt in after] == [clock.advance(dt) for dt in after]
    assert twin.state() == clock.state()


@pytest.mark.parametrize(
    "change",
    [
        {"steps": -1},
        {"steps": 1.0},
        {"steps": True},
        {"steps": 2**60},
        {"remainder": STEP},
        {"remainder": -0.01},
        {"remainder": math.nan},
        {"dropped": -1.0},
        {"dropped": math.inf},
        {"paused": 1},
        {"speed": None},
        {"more": 1},
    ],
)
def test_bad_states(change):
    with pytest.raises(InvalidValueError):
        Clock.from_state(Clock().state() | change)
    with pytest.raises(InvalidValueError):
        Clock.from_state({})
