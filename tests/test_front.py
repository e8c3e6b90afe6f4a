"""Rain that begins and ends: who is there at which height, against sums over many drops."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from weather_ecs.frame import AREA_DTYPE
from weather_ecs.physics import front
from weather_ecs.physics.drops import slope, terminal_speed

SIZE = 0.5 + (np.arange(40_000) + 0.5) * 5.5 / 40_000  # mm
SPEED = terminal_speed(SIZE)
BEGUN, ENDED = (20.0, front.LONG, 0.0, 0.0), (-1.0, 20.0, 0.0, 0.0)
ages = st.floats(0.0, 500.0)


def share(weight: np.ndarray, there: np.ndarray) -> float:
    return float((weight * there).sum() / weight.sum())


def sharp(fall: float, dry: front.Dry) -> np.ndarray:
    """Which sizes are there, to the drop."""
    time = fall / SPEED
    missing = (time >= dry[0]) & (time < dry[1]) | (time >= dry[2]) & (time < dry[3])
    return ~missing


@given(st.floats(0.5, 400.0), st.floats(0.1, 300.0), st.tuples(ages, ages, ages, ages))
def test_shares_of_water_and_extinction_are_those_of_the_drops_there(
    fall: float, rate: float, moments: tuple[float, float, float, float]
) -> None:
    a, b, c, d = sorted(moments)
    dry = (c, d, a, b)
    numbers = np.exp(-float(slope(rate)) * (SIZE - 0.5))
    there = sharp(fall, dry)
    water = share(numbers * SIZE**3 * SPEED, there)
    assert front.water_arrived(fall, dry, rate) == pytest.approx(water, abs=2e-3)
    lost = share(numbers * SIZE**2, there)
    assert front.extinction_arrived(fall, dry, rate) == pytest.approx(lost, abs=2e-3)


def test_the_large_drops_come_first_and_the_small_ones_stay_last() -> None:
    """20 s after the begin of a rain from 100 m, only what falls at 5 m/s and more is down."""
    down = SIZE[front.fallen_share(100.0 / SPEED, BEGUN) > 0.5]
    assert down.max() == SIZE[-1]
    assert terminal_speed(down.min()) == pytest.approx(5.0, abs=0.01)
    left = SIZE[front.fallen_share(100.0 / SPEED, ENDED) > 0.5]
    assert left.min() == SIZE[0]
    assert terminal_speed(left.max()) == pytest.approx(5.0, abs=0.01)


def test_beginning_and_ending_add_up_to_the_whole() -> None:
    heights = np.linspace(0.0, 300.0, 40)
    both = front.water_arrived(heights, BEGUN, 25.0) + front.water_arrived(heights, ENDED, 25.0)
    assert both == pytest.approx(1.0)
    assert np.all(np.diff(front.water_arrived(heights, BEGUN, 25.0)) <= 1e-12)
    assert front.water_arrived(20.0 * front.SLOWEST, BEGUN, 25.0) == pytest.approx(1.0)
    assert front.water_arrived(20.0 * front.FASTEST, BEGUN, 25.0) == pytest.approx(0.0)


def test_without_a_spell_all_is_there() -> None:
    for fall in (-50.0, 0.0, 1.0, 1e5):
        assert front.water_arrived(fall, front.SETTLED, 5.0) == 1.0
        assert front.extinction_arrived(fall, front.SETTLED, 5.0) == 1.0
    assert np.all(front.fallen_share([0.0, 1.0, 1e6], front.SETTLED) == 1.0)


def test_diameter_is_the_inverse_of_atlas() -> None:
    assert front.diameter_at(SPEED) == pytest.approx(SIZE, rel=1e-9)
    assert front.diameter_at([0.0, 1.0, 9.6, 50.0]).tolist() == [0.5, 0.5, 6.0, 6.0]


@given(st.floats(0.0, 1e4), st.floats(-10.0, 1e5), st.tuples(ages, ages, ages, ages))
def test_any_rate_height_and_times_keep_it_a_share(
    rate: float, fall: float, dry: tuple[float, float, float, float]
) -> None:
    for found in (
        front.water_arrived(fall, dry, rate),
        front.extinction_arrived(fall, dry, rate),
        *front.landing_share(fall, dry, rate),
    ):
        assert 0.0 <= float(found) <= 1.0 + 1e-9


def test_what_lands_by_number_and_by_water() -> None:
    number, water = front.landing_share(100.0, BEGUN, 25.0)
    assert 0.0 < number < water < 1.0  # few drops so far, and large ones
    assert water == pytest.approx(float(front.water_arrived(100.0, BEGUN, 25.0)), abs=0.02)
    assert front.landing_share(100.0, front.SETTLED, 25.0) == pytest.approx((1.0, 1.0))


def test_areas_on_level_ground() -> None:
    rows = np.zeros(3, AREA_DTYPE)
    rows["key"], rows["ceiling"], rows["rain_rate"] = [4, 5, 6], 100.0, [25.0, 25.0, 0.0]
    assert front.on_level_ground(rows, {}) is rows
    found = front.on_level_ground(rows, {5: BEGUN, 6: BEGUN})
    expected = 25.0 * float(front.water_arrived(100.0, BEGUN, 25.0))
    assert found["rain_rate"].tolist() == [25.0, pytest.approx(expected), 0.0]
    assert math.isclose(rows["rain_rate"][1], 25.0)
