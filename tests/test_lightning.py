"""Lightning's physics: chance, the course of a flash, its shape, its light, where it ends."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from weather_ecs.physics import lightning
from weather_ecs.physics.chance import uniform
from weather_ecs.physics.lightning_bolt import DIMENSION, bolt, crooked, roughness
from weather_ecs.systems.strike_place import surfaces_below

WORDS = range(1500)
ORIGIN, TARGET = (300.0, 1800.0, -2500.0), (0.0, 12.0, -2200.0)
numbers = st.integers(0, 2**63 - 1)


def divider_dimension(curve: np.ndarray) -> float:
    """1 less the slope of the length over the length of the ruler (Richardson)."""
    rulers, lengths = [], []
    for k in range(6):
        pieces = np.linalg.norm(np.diff(curve[:: 1 << k], axis=0), axis=1)
        rulers.append(math.sqrt((pieces**2).mean()))
        lengths.append(pieces.sum())
    return 1.0 - np.polyfit(np.log(rulers), np.log(lengths), 1)[0]


@pytest.mark.parametrize("mean", [0.05, 1.0, 7.5])
def test_poisson_numbers_have_their_mean_and_variance(mean: float) -> None:
    found = np.array([lightning.poisson(mean, uniform(9, k)) for k in range(6000)])
    error = math.sqrt(mean / len(found))
    assert abs(found.mean() - mean) < 4.0 * error
    assert found.var() == pytest.approx(mean, rel=0.15, abs=0.02)


def test_poisson_is_the_inverse_of_its_distribution() -> None:
    assert lightning.poisson(0.0, 0.999999) == 0
    below = 0.0
    for count in range(6):
        share = math.exp(-2.0) * 2.0**count / math.factorial(count)
        assert lightning.poisson(2.0, below + 0.5 * share) == count
        below += share


def test_currents_are_those_of_first_strokes() -> None:
    found = np.array([lightning.peak_current(word) for word in WORDS])
    assert np.median(found) == pytest.approx(30.0, rel=0.08)
    assert np.log(found).std() == pytest.approx(0.61, rel=0.1)
    assert found.min() >= 3.0
    assert found.max() <= 300.0


def test_flashes_to_ground_have_the_published_strokes() -> None:
    flashes = [lightning.course(word, True) for word in WORDS]
    strokes = np.array([len(flash.times) for flash in flashes])
    assert strokes.min() == 1
    assert strokes.max() == 5
    assert strokes.mean() == pytest.approx(3.0, abs=0.15)
    assert (strokes == 1).mean() == pytest.approx(0.2, abs=0.04)
    gaps = np.concatenate([np.diff(flash.times) for flash in flashes])
    assert math.exp(np.log(gaps).mean()) == pytest.approx(0.060, rel=0.08)
    later = np.concatenate([flash.peaks[1:] for flash in flashes])
    assert later.mean() == pytest.approx(0.4, abs=0.02)
    assert np.mean([flash.continuing[2] > 0.0 for flash in flashes]) == pytest.approx(0.3, abs=0.05)


@given(numbers, st.booleans())
def test_a_flash_begins_dark_and_ends(word: int, ground: bool) -> None:
    flash = lightning.course(word, ground)
    assert flash.end < 2.5
    assert lightning.intensity(flash, -1e-9) == 0.0
    assert lightning.intensity(flash, flash.end) == 0.0
    assert lightning.intensity(flash, math.nextafter(flash.end, 0.0)) < 0.02
    assert list(flash.times) == sorted(flash.times)
    light = [lightning.intensity(flash, 0.005 * k) for k in range(500)]
    assert 0.2 < max(light) < 3.0
    assert min(light) >= 0.0


def test_a_single_stroke_fades_as_it_is_held() -> None:
    word = next(w for w in WORDS if len(lightning.course(w, True).times) == 1)
    flash = lightning.course(word, True)._replace(continuing=(0.0, 0.0, 0.0))
    first = lightning.intensity(flash, flash.times[0])
    assert first == pytest.approx(1.0)
    later = lightning.intensity(flash, flash.times[0] + lightning.HELD)
    assert later == pytest.approx(math.exp(-1.0))
    leader = lightning.intensity(flash, 0.5 * flash.times[0])
    assert 0.0 < leader < 0.05


def test_light_falls_off_to_the_square_far_off_and_is_finite_near_by() -> None:
    place = (0.0, 2000.0, 0.0)
    up = (0.0, 1.0, 0.0)
    assert lightning.on_surface(place, place, up) == pytest.approx(1.0)
    assert lightning.on_surface(place, (0.0, 1999.0, 0.0), up) == pytest.approx(1.0, abs=1e-5)
    far = [float(lightning.falloff(d * d)) for d in (40_000.0, 80_000.0)]
    assert far[0] / far[1] == pytest.approx(4.0, rel=0.02)
    away = lightning.on_surface(place, (0.0, 0.0, 0.0), (0.0, -1.0, 0.0))
    towards = lightning.on_surface(place, (0.0, 0.0, 0.0), up)
    assert away / towards == pytest.approx(lightning.ALL_ROUND)


def test_thunder_and_the_channel_s_distance() -> None:
    assert lightning.thunder_delay(3400.0) == pytest.approx(10.0)
    assert lightning.channel_distance((0, 1000, 0), (0, 0, 0), (30, 500, 40)) == 50.0
    assert lightning.channel_distance((0, 1000, 0), (0, 0, 0), (0, -7, 0)) == 7.0
    assert lightning.channel_distance((1, 2, 3), (1, 2, 3), (1, 2, 3)) == 0.0


# Where it ends


def ends(tips: list[tuple[float, float, float]], current: float = 30.0) -> tuple[float, ...]:
    return lightning.attached(0.0, 0.0, 5.0, current, np.array(tips, float).reshape(-1, 3))


def test_the_striking_distance_is_love_s() -> None:
    assert lightning.striking_distance(30.0) == pytest.approx(91.2, abs=0.1)
    assert lightning.striking_distance(10.0) == pytest.approx(44.7, abs=0.1)


def test_a_mast_takes_what_comes_down_within_its_attractive_radius() -> None:
    # sqrt(h (2 r - h)) for a mast of the height h over the ground.
    reach, height = lightning.striking_distance(30.0), 20.0
    radius = math.sqrt(height * (2.0 * reach - height))
    near, far = (radius - 0.5, 25.0, 0.0), (radius + 0.5, 25.0, 0.0)
    assert ends([near]) == near
    assert ends([far]) == (0.0, 5.0, 0.0)
    assert ends([]) == (0.0, 5.0, 0.0)
    assert ends([near], current=3.0) == (0.0, 5.0, 0.0)
    taller = (-40.0, 60.0, 10.0)
    assert ends([near, taller]) == taller


def test_surfaces_right_below_are_found() -> None:
    roof = np.array([[(-10, 4, -10), (30, 4, -10), (-10, 8, 30)]], float)
    wall = np.array([[(0, 0, -9), (0, 9, -9), (0, 9, 9)]], float)
    np.testing.assert_allclose(surfaces_below(roof, 0.0, 0.0), [(0.0, 5.0, 0.0)])
    assert len(surfaces_below(roof, 40.0, 40.0)) == 0
    assert len(surfaces_below(wall, 0.0, 0.0)) == 0


# Shape


def test_a_channel_goes_from_the_cloud_to_the_ground() -> None:
    for word in range(20):
        made = bolt(ORIGIN, TARGET, word)
        np.testing.assert_allclose(made.trunk[0], ORIGIN)
        np.testing.assert_allclose(made.trunk[-1], TARGET)
        assert min(made.begin[:, 1].min(), made.end[:, 1].min()) >= TARGET[1]
        trunk = made.order == 0
        np.testing.assert_array_equal(made.begin[trunk], made.trunk[:-1])
        np.testing.assert_array_equal(made.end[trunk], made.trunk[1:])
        assert 500 < len(made.begin) < 1000
        assert np.isfinite(made.begin).all()
        assert ((made.along > 0.0) & (made.along <= 1.0)).all()


def test_branches_leave_what_is_there_and_end_in_the_air_dimmer() -> None:
    made = bolt(ORIGIN, TARGET, 5)
    for order, pieces in ((1, 32), (2, 8)):
        own = made.order == order
        roots = made.begin[own][::pieces]
        stems = np.concatenate([made.begin[made.order == order - 1], made.trunk])
        gaps = np.linalg.norm(stems[None] - roots[:, None], axis=2).min(axis=1)
        np.testing.assert_allclose(gaps, 0.0, atol=1e-9)
        assert (made.end[own][pieces - 1 :: pieces, 1] > TARGET[1] + 5.0).all()
        assert made.light[own].max() < made.light[made.order == order - 1].max()
        # A leader has to be where a branch begins before it can grow.
        along = made.along[own].reshape(-1, pieces)
        assert (np.diff(along, axis=1) >= 0.0).all()


def test_the_dimension_is_that_of_photographs() -> None:
    found = [divider_dimension(bolt(ORIGIN, TARGET, word).trunk) for word in range(40)]
    assert np.mean(found) == pytest.approx(DIMENSION, abs=0.03)
    assert 1.1 < np.mean(found) < 1.3


@pytest.mark.parametrize("dimension", [1.05, 1.2, 1.35])
def test_displacement_gives_the_dimension_that_is_asked(dimension: float) -> None:
    s = roughness(dimension)
    assert math.log(2.0) / math.log(2.0 / math.sqrt(1.0 + 4.0 * s * s)) == pytest.approx(dimension)
    ends = np.zeros((60, 3)), np.tile([0.0, 1000.0, 0.0], (60, 1))
    curves = crooked(*ends, 9, 3, dimension)
    found = np.mean([divider_dimension(curve) for curve in curves])
    assert found == pytest.approx(dimension, abs=0.03)


def test_shapes_follow_from_their_word() -> None:
    one = bolt(ORIGIN, TARGET, 77)
    bolt.cache_clear()
    again, other = bolt(ORIGIN, TARGET, 77), bolt(ORIGIN, TARGET, 78)
    np.testing.assert_array_equal(one.begin, again.begin)
    assert np.abs(one.trunk - other.trunk).max() > 10.0
    with pytest.raises(ValueError, match="read-only"):
        again.begin[0] = 0.0


@pytest.mark.parametrize("branches", [0.0, 0.5, 3.0])
def test_as_many_branches_as_are_asked(branches: float) -> None:
    made = bolt(ORIGIN, TARGET, 3, branches=branches)
    assert (made.order == 1).sum() == 32 * round(11 * branches)


@pytest.mark.parametrize("ground", [True, False])
def test_no_length_and_upward_channels_break_nothing(ground: bool) -> None:
    for origin, target in ((TARGET, TARGET), (TARGET, ORIGIN)):
        made = bolt(origin, target, 1, ground=ground)
        assert np.isfinite(made.begin).all()
        assert np.isfinite(made.end).all()
