"""Snow in the air: its laws against figures, what it adds up to, and the flakes' pictures."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from weather_ecs.errors import InvalidValueError
from weather_ecs.frame import RAIN, SNOW, AirData, SnowLook
from weather_ecs.gpu import flake_texture
from weather_ecs.gpu.flake_shapes import SIZE
from weather_ecs.gpu.flake_texture import CLUMPS, LAYERS, NEEDLES, PLATES, STARS, WET, build
from weather_ecs.physics.drops import drop_density, extinction, terminal_speed
from weather_ecs.physics.footprint import fall_speed_of, fall_speed_over
from weather_ecs.physics.optics import extinction_to_visibility
from weather_ecs.physics.snow import (
    Habit,
    aggregate_speed,
    clumped,
    flake_size,
    flake_speed,
    growth_temperature,
    habit,
    melted_diameter,
    snow_extinction,
    snow_law,
    snow_size_distribution,
)
from weather_ecs.physics.snow_step import flake_velocities, flake_words, flakes_of
from weather_ecs.physics.snowfall import snowfall
from weather_ecs.systems.falls import falls

IDS = np.arange(20_000, dtype=np.uint32)
QUANTILES = (np.arange(20_000) * 0.754877666 % 1.0).astype(np.float32)


# Laws


def test_sizes_are_gunn_and_marshalls():
    assert snow_size_distribution(0.0, 1.0) == pytest.approx(3800.0)
    assert snow_size_distribution(1.0, 1.0) == pytest.approx(3800.0 * math.exp(-2.55))
    expected = 3800.0 * 4.0**-0.87 * math.exp(-2.55 * 4.0**-0.48 * 2.0)
    assert snow_size_distribution(2.0, 4.0) == pytest.approx(expected)
    assert snow_size_distribution([0.5, 2.0], 0.0).tolist() == [0.0, 0.0]
    law = snow_law(2.5)
    x = np.linspace(0.2, 4.0, 20_001)
    n = snow_size_distribution(x, 2.5)
    shares = np.concatenate([[0.0], np.cumsum(0.5 * (n[1:] + n[:-1]))])
    shares /= shares[-1]
    at = np.array([0.1, 0.5, 0.9, 0.99])
    assert melted_diameter(at, law) == pytest.approx(np.interp(at, shares, x), rel=1e-3)
    assert melted_diameter([0.0, 1.0], law) == pytest.approx([0.2, 4.0], rel=1e-3)


def test_extinction_is_eleven_decibels_a_kilometre():
    assert snow_extinction(1.0) * 1000.0 == pytest.approx(11.0 / (10.0 * math.log10(math.e)))
    seen = extinction_to_visibility(snow_extinction([1.0, 2.5]))
    assert seen == pytest.approx([1545.0, 618.0], rel=1e-3)
    assert snow_extinction(2.0) > 4.0 * extinction(2.0)  # snow hides more than rain
    for wrong in (-1.0, math.nan, math.inf):
        with pytest.raises(InvalidValueError, match="rate"):
            snow_extinction(wrong)


def test_habits_follow_the_cold():
    cold = [-1, -5, -8, -11, -13, -15, -16.5, -20, -30, 5]
    P, C, S = Habit.PLATE, Habit.COLUMN, Habit.STAR
    assert habit(cold).tolist() == [P, C, C, P, S, S, S, P, C, P]
    assert growth_temperature([0.0, 0.5], -2.0).tolist() == [-5.0, -11.0]


def test_speeds_and_sizes_are_those_that_were_measured():
    assert aggregate_speed([1.0, 10.0]) == pytest.approx([0.8, 1.156], abs=1e-3)
    law = snow_law(1.0, temperature=0.0)
    star, needle = 13.5 / 12 - 3 / 12, 0.3  # grown at -13.5 and at -6.6 degrees
    assert habit(growth_temperature([star, needle], 0.0)).tolist() == [Habit.STAR, Habit.COLUMN]
    # A dendrite of 0.043 mg is 3.26 mm wide and falls at 0.31 m/s (Nakaya and Terada 1935).
    melted = (6.0 / math.pi * 0.043) ** (1.0 / 3.0)
    assert flake_size(melted, star, law) == pytest.approx(3.26, rel=0.02)
    assert flake_speed(melted, star, law) == pytest.approx(0.31, abs=0.005)
    assert flake_speed(0.3, needle, law) == pytest.approx(0.5)
    # Large ones are clumps, whatever they began as: 3.6 mg at 1 m/s (Sasyo and Matsuo 1980).
    melted = (6.0 / math.pi * 3.6) ** (1.0 / 3.0)
    assert flake_size(melted, [star, needle], law) == pytest.approx(7.6, rel=0.05)
    assert flake_speed(melted, [star, needle], law) == pytest.approx(1.1, abs=0.05)
    large = flake_speed([3.0, 4.0], star, law)
    assert ((large > 1.0) & (large < 2.0)).all()


def test_flakes_clump_near_freezing():
    assert clumped(0.7, 0.0) > 0.6 > 0.1 > clumped(0.7, -15.0)
    assert clumped([0.2, 4.0], -5.0).tolist() == [0.0, 1.0]


def test_the_speed_that_maps_are_made_for():
    rates = np.array([0.5, 2.5])
    assert fall_speed_over(rates) == fall_speed_over(rates, 0.4) == fall_speed_of(2.5)
    median = 4.0 * 3.67 / 1.6426  # mm, of the heavier snow
    assert fall_speed_over(rates, 1.0) == pytest.approx(0.8 * median**0.16, rel=1e-3)
    assert 0.7 < fall_speed_over(rates[:0], 1.0) < fall_speed_over(rates * 1e6, 1.0) < 1.3


def test_wet_flakes_are_smaller_and_fall_faster():
    diameter, at = np.array([[0.3], [1.0], [3.0]]), np.linspace(0.0, 0.99, 40)
    sizes = [flake_size(diameter, at, snow_law(2.0, wet, 0.5)) for wet in (0.0, 0.3, 0.6, 1.0)]
    speeds = [flake_speed(diameter, at, snow_law(2.0, wet, 0.5)) for wet in (0.0, 0.3, 0.6, 1.0)]
    for k in range(3):
        assert (sizes[k + 1] < sizes[k]).all() and (speeds[k + 1] > speeds[k]).all()
    assert speeds[3] == pytest.approx(np.broadcast_to(terminal_speed(diameter), (3, 40)))


# The whole of it


@given(
    st.floats(1e-3, 1000.0), st.floats(0.0, 1.0), st.floats(-60.0, 60.0),
    st.sampled_from(["physical", "liu_tong"]),
)  # fmt: skip
@settings(max_examples=40, deadline=None)
def test_any_snowfall_carries_its_rate(rate, wet, temperature, model):
    fall = snowfall(rate, wet, temperature, model)
    assert 3600e-6 * fall.density * fall.speed * fall.water == pytest.approx(rate, rel=1e-6)
    assert 0.0 < fall.cover <= 1.0
    assert fall.speed > 0.0
    assert all(map(math.isfinite, (*fall.law[:4], fall.density, fall.water)))


@pytest.mark.parametrize("rate", [0.3, 1.0, 2.5])
def test_the_number_of_flakes_is_close_to_the_measured_one(rate):
    x = np.linspace(0.2, 4.0, 4001)
    measured = np.trapezoid(snow_size_distribution(x, rate), x)
    # Cut and at our speeds the distribution carries its rate nearly by itself.
    assert snowfall(rate).density == pytest.approx(measured, rel=0.5)


def test_flakes_on_the_gpu_carry_the_rate():
    rate = 1.5
    fall = snowfall(rate, 0.0, -3.0)
    v = flake_velocities(IDS, QUANTILES, fall.law[:4], flakes_of(fall.law, 3.0))
    carried = 3600e-6 * math.pi / 6.0 * melted_diameter(QUANTILES, fall.law) ** 3 * -v[:, 1]
    assert fall.density * carried.mean() == pytest.approx(rate, rel=0.02)
    assert -v[:, 1].mean() == pytest.approx(fall.speed, rel=0.02)
    assert abs(v[:, [0, 2]].mean(axis=0)).max() < 0.01


def test_a_flake_sways_about_a_straight_way():
    law = snowfall(1.0, 0.0, -3.0).law
    times = np.arange(0.0, 64.0, 0.05)
    ways = np.array([flake_velocities(IDS[:50], QUANTILES[:50], law[:4], flakes_of(law, t))
                     for t in times])  # fmt: skip
    # Over a whole period it goes straight down at its mean speed; within one it does not.
    grown = (flake_words(IDS[:50]) & np.uint32(255)) / 256.0
    expected = flake_speed(melted_diameter(QUANTILES[:50], law), grown, law)
    assert -ways[:, :, 1].mean(axis=0) == pytest.approx(expected, rel=0.01)
    assert abs(ways[:, :, [0, 2]].mean(axis=0)).max() < 0.01
    assert (ways[:, :, [0, 2]].std(axis=0) > 0.05 * expected[:, None]).all()
    still = flake_velocities(IDS[:50], QUANTILES[:50], law[:4], flakes_of(law, 1.7, 0.0))
    assert (still[:, [0, 2]] == 0.0).all()


def test_the_papers_flakes():
    law = snowfall(1.0, model="liu_tong").law
    v = flake_velocities(IDS, QUANTILES, law[:4], flakes_of(law, 5.0))
    middle, half = (v.max(axis=0) + v.min(axis=0)) / 2, (v.max(axis=0) - v.min(axis=0)) / 2
    assert middle == pytest.approx([0.0, -1.0, 0.0], abs=2e-3)
    assert half == pytest.approx([0.25, 0.2, 0.25], abs=2e-3)
    assert v.std(axis=0) == pytest.approx(half / math.sqrt(3.0), rel=0.02)
    with pytest.raises(InvalidValueError, match="model"):
        snowfall(1.0, model="swiss")


# Sleet is both


def test_what_falls_by_the_share_of_snow():
    look = SnowLook()
    assert [f.kind for f in falls(4.0, AirData(), look)] == [RAIN]
    assert [f.kind for f in falls(4.0, AirData(snow_share=1.0), look)] == [SNOW]
    assert falls(0.0, AirData(snow_share=0.5), look) == ()
    rain, snow = falls(4.0, AirData(1.0, 0.9, 0.5, 0.25), look)
    assert (rain.kind, rain.rate, snow.kind, snow.rate) == (RAIN, 3.0, SNOW, 1.0)
    assert rain.density == drop_density(3.0)
    assert rain.extinction == extinction(3.0) and snow.extinction == snow_extinction(1.0)
    assert snow.law[2] == pytest.approx(0.75, abs=0.011)  # three quarters melted
    assert rain.part + snow.part == pytest.approx(1.0)
    assert snow.part == pytest.approx(snow.extinction / (rain.extinction + snow.extinction))


# Pictures


@pytest.fixture(scope="module")
def pictures() -> np.ndarray:
    return build().astype(float) / 255.0


def turned(image: np.ndarray, angle: float) -> np.ndarray:
    """A picture turned about its middle, between texels."""
    at = (np.arange(SIZE) + 0.5) / SIZE * 2.0 - 1.0
    x, y = np.meshgrid(at, at)
    c, s = math.cos(angle), math.sin(angle)
    u = np.clip(((c * x - s * y) + 1.0) * 0.5 * SIZE - 0.5, 0, SIZE - 1.001)
    v = np.clip(((s * x + c * y) + 1.0) * 0.5 * SIZE - 0.5, 0, SIZE - 1.001)
    i, j = u.astype(int), v.astype(int)
    fu, fv = u - i, v - j
    top = image[j, i] * (1 - fu) + image[j, i + 1] * fu
    return top * (1 - fv) + (image[j + 1, i] * (1 - fu) + image[j + 1, i + 1] * fu) * fv


def test_crystals_are_six_fold_and_no_two_alike(pictures):
    crystals = [*range(PLATES), *range(PLATES + NEEDLES, PLATES + NEEDLES + STARS)]
    assert len(crystals) >= 36 and len(pictures) == LAYERS
    at = (np.arange(SIZE) + 0.5) / SIZE * 2.0 - 1.0
    disc = np.hypot(*np.meshgrid(at, at)) < 0.85
    for k in crystals:
        image = pictures[k, ..., 0]
        sixth = np.abs(turned(image, math.pi / 3) - image)[disc].mean() / image[disc].mean()
        other = np.abs(turned(image, math.pi / 6) - image)[disc].mean() / image[disc].mean()
        assert sixth < 0.35 and sixth < 0.5 * other, k
    flat = pictures[crystals, ..., 0].reshape(len(crystals), -1)
    apart = np.abs(flat[:, None] - flat[None]).mean(axis=2) + np.eye(len(crystals))
    assert apart.min() > 0.005


def test_clumps_and_melting_flakes_fill_their_pictures(pictures):
    for k in range(LAYERS - CLUMPS - WET, LAYERS):
        cover = pictures[k, ..., 0]
        assert 0.1 < cover.mean() < 0.6
        assert cover[[0, -1]].max() < 0.5 and cover[SIZE // 2 - 4 : SIZE // 2 + 4].max() > 0.4


def test_pictures_are_the_same_every_time_and_made_once():
    assert build().tobytes() == build().tobytes()
    assert flake_texture._built() is flake_texture._built()
