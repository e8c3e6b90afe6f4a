"""Drop sizes, speeds and optics against published figures and plain numerical integration."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Any

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import NDArray

from weather_ecs.errors import InvalidValueError
from weather_ecs.physics import drops

RATES = [0.1, 1.0, 5.0, 25.0, 100.0, 1000.0]
# Gunn and Kinzer (1949): diameter in mm, terminal speed in m/s.
GUNN_KINZER = np.array(
    [(0.2, 0.72), (0.5, 2.06), (1.0, 4.03), (1.5, 5.41), (2.0, 6.49), (2.5, 7.41), (3.0, 8.06),
     (3.5, 8.53), (4.0, 8.83), (4.5, 9.00), (5.0, 9.09), (5.8, 9.17)]
)  # fmt: skip


def integral(
    function: Callable[[NDArray[np.float64]], NDArray[np.float64]],
    low: float,
    high: float,
    n: int = 40_001,
) -> float:
    """Simpson's rule."""
    x = np.linspace(low, high, n)
    weights = np.where(np.arange(n) % 2 == 1, 4.0, 2.0)
    weights[[0, -1]] = 1.0
    return float((function(x) * weights).sum() * (high - low) / (3.0 * (n - 1)))


def gauge(rate: float, low: float, high: float) -> float:
    """mm/h that the distribution itself carries through a plane."""
    water = integral(
        lambda d: drops.size_distribution(d, rate) * d**3 * drops.terminal_speed(d), low, high
    )
    return math.pi / 6.0 * water * 3600.0 * 1e-6


# Marshall and Palmer over all D: rate, slope, drops/m3, those over 1 mm, extinction per km.
@pytest.mark.parametrize(
    ("rate", "slope", "number", "large", "lost"),
    [(1, 4.10, 1951, 32, 0.365), (5, 2.92, 2736, 147, 1.01),
     (25, 2.09, 3836, 477, 2.77), (100, 1.56, 5132, 1080, 6.64)],
)  # fmt: skip
def test_marshall_and_palmer(
    rate: float, slope: float, number: float, large: float, lost: float
) -> None:
    assert drops.slope(rate) == pytest.approx(slope, abs=0.005)
    assert drops.number_density(rate, 0.0, math.inf) == pytest.approx(number, abs=0.5)
    assert drops.number_density(rate, 1.0, math.inf) == pytest.approx(large, abs=0.5)
    assert 1000.0 * drops.extinction(rate) == pytest.approx(lost, rel=0.005)
    whole = integral(lambda d: drops.size_distribution(d, rate), 0.0, 40.0)
    assert whole == pytest.approx(number, abs=0.5)
    shadow = integral(lambda d: drops.size_distribution(d, rate) * d * d, 0.0, 40.0)
    assert 2.0 * math.pi / 4.0 * 1e-3 * shadow == pytest.approx(lost, rel=0.005)


def test_size_distribution_is_the_exponential() -> None:
    assert drops.size_distribution(0.0, 5.0) == 8000.0
    assert drops.size_distribution(2.0, 5.0) == pytest.approx(8000.0 * math.exp(-5.848), rel=1e-3)
    table = drops.size_distribution([[0.5], [1.0]], [1.0, 5.0, 25.0])
    assert table.shape == (2, 3)
    assert np.all(np.diff(table, axis=0) < 0.0)
    assert np.all(np.diff(table, axis=1) > 0.0)


def test_the_distributions_own_flux_overshoots() -> None:
    """By 5 to 18 % over all D in ordinary rain; the cut to 0.5 to 6 mm takes some of it away."""
    excess = [gauge(rate, 0.0, 40.0) / rate for rate in (1.0, 5.0, 25.0, 100.0)]
    assert np.all((np.array(excess) > 1.045) & (np.array(excess) < 1.185))


@pytest.mark.parametrize("rate", RATES)
def test_weights_make_the_gauge_read_the_rate(rate: float) -> None:
    own = gauge(rate, 0.5, 6.0)
    assert drops.flux_normalisation(rate) * own == pytest.approx(rate, rel=1e-9)
    expected = drops.number_density(rate) * drops.flux_normalisation(rate)
    assert drops.drop_density(rate) == pytest.approx(expected, rel=1e-12)


@pytest.mark.parametrize("rate", RATES)
def test_truncated_integrals(rate: float) -> None:
    number = integral(lambda d: drops.size_distribution(d, rate), 0.5, 6.0)
    assert drops.number_density(rate) == pytest.approx(number, rel=1e-9)
    area = integral(lambda d: drops.size_distribution(d, rate) * d * d, 0.5, 6.0)
    area *= math.pi / 4.0 * 1e-6
    assert drops.mean_cross_section(rate) == pytest.approx(area / number, rel=1e-9)
    assert drops.extinction_of_sampled(rate) == pytest.approx(2.0 * area, rel=1e-9)
    assert drops.extinction_of_sampled(rate) < drops.extinction(rate)


@given(st.floats(0.0, 1.0), st.one_of(st.just(0.0), st.floats(1e-12, 1e9)))
def test_quantile_inverts_the_cumulative_distribution(u: float, rate: float) -> None:
    diameter = float(drops.diameter_quantile(u, rate))
    assert 0.5 <= diameter <= 6.0
    if rate > 1e-3:
        share = drops.number_density(rate, 0.5, diameter) / drops.number_density(rate)
        assert share == pytest.approx(u, abs=1e-9)


def test_quantile_is_the_closed_form_a_shader_uses() -> None:
    u, slope = np.linspace(0.0, 1.0, 101), float(drops.slope(5.0))
    low, high = math.exp(-0.5 * slope), math.exp(-6.0 * slope)
    assert np.allclose(drops.diameter_quantile(u, 5.0), -np.log(low - u * (low - high)) / slope)
    assert drops.diameter_quantile([0.0, 1.0], 5.0) == pytest.approx([0.5, 6.0])
    assert np.all(np.diff(drops.diameter_quantile(u, 0.01)) > 0.0)
    assert np.all(np.diff(drops.diameter_quantile(0.5, RATES)) > 0.0)


@pytest.mark.parametrize("flux", [False, True])
@pytest.mark.parametrize("rate", [1e-6, 0.1, 5.0, 100.0, 1000.0])
def test_samples_follow_their_density(rate: float, flux: bool) -> None:
    n = 200_000
    sample = np.sort(drops.sample_diameters(n, rate, np.random.default_rng(7), flux=flux))
    assert sample[0] >= 0.5
    assert sample[-1] <= 6.0
    reach = min(5.5, 60.0 / float(drops.slope(rate)))
    grid = 0.5 + np.linspace(0.0, reach, 20_001)
    density = np.exp(-float(drops.slope(rate)) * (grid - 0.5))
    density *= drops.terminal_speed(grid) if flux else 1.0
    cumulative = np.concatenate(([0.0], np.cumsum((density[1:] + density[:-1]) / 2.0)))
    expected = np.interp(sample, grid, cumulative / cumulative[-1])
    ranks = (np.arange(n) + 0.5) / n
    assert np.abs(expected - ranks).max() * math.sqrt(n) < 1.95  # Kolmogorov, 1 in 1000


def test_drops_that_land_are_larger_than_drops_in_the_air() -> None:
    air = drops.sample_diameters(100_000, 5.0, np.random.default_rng(1))
    landing = drops.sample_diameters(100_000, 5.0, np.random.default_rng(1), flux=True)
    assert np.all(landing >= air - 1e-5)
    assert landing.mean() > air.mean() + 0.05
    speed = drops.terminal_speed(air)
    assert landing.mean() == pytest.approx((air * speed).sum() / speed.sum(), rel=0.01)


def test_samples_repeat_with_their_seed() -> None:
    once, again = (drops.sample_diameters(50, 5.0, np.random.default_rng(3)) for _ in range(2))
    assert np.array_equal(once, again)
    assert drops.sample_diameters(0, 5.0, np.random.default_rng(3)).shape == (0,)


def test_no_rain_is_no_drops_and_no_nan() -> None:
    assert drops.size_distribution([0.0, 0.5, 6.0], 0.0).tolist() == [0.0, 0.0, 0.0]
    assert drops.number_density(0.0) == drops.drop_density(0.0) == 0.0
    assert drops.extinction(0.0) == drops.extinction_of_sampled(0.0) == 0.0
    assert drops.flux_normalisation(0.0) == 1.0
    assert drops.mean_cross_section(0.0) == pytest.approx(math.pi / 4.0 * 0.25e-6)
    for flux in (False, True):
        dry = drops.sample_diameters(9, 0.0, np.random.default_rng(1), flux=flux)
        assert np.all(dry == 0.5)


@pytest.mark.filterwarnings("error")
@given(st.one_of(st.just(0.0), st.floats(5e-324, 1e6)))
def test_every_rate_gives_finite_numbers(rate: float) -> None:
    for function in (
        drops.number_density, drops.drop_density, drops.flux_normalisation, drops.extinction,
        drops.mean_cross_section, drops.extinction_of_sampled,
    ):  # fmt: skip
        value = function(rate)
        assert np.isfinite(value)
        assert value >= 0.0


def test_more_rain_means_more_drops_and_less_light() -> None:
    rates = np.concatenate(([0.0], np.geomspace(1e-3, 1000.0, 60)))
    for function in (drops.number_density, drops.drop_density, drops.extinction):
        assert np.all(np.diff(function(rates)) > 0.0)


def test_atlas_is_close_to_the_measurements() -> None:
    diameter, measured = GUNN_KINZER.T
    error = drops.terminal_speed(diameter) / measured - 1.0
    assert np.all(np.abs(error[diameter >= 0.5]) < 0.025)
    assert drops.terminal_speed(1.0) == pytest.approx(9.65 - 10.3 * math.exp(-0.6))
    assert np.array_equal(drops.terminal_speed([0.0, 0.05, 0.108]), [0.0, 0.0, 0.0])
    assert drops.terminal_speed(0.11) > 0.0
    assert np.all(np.diff(drops.terminal_speed(np.linspace(0.11, 6.0, 500))) > 0.0)


def test_liu_tong_is_the_papers_three_pieces() -> None:
    v = drops.terminal_speed([0.5, 1.0, 1.5, 1.5001, 4.0, 4.0001, 6.0], "liu_tong")
    expected = [2.0312, 3.8435, 5.5816, 5.6651, 9.2508, 9.0, 9.0]
    assert np.allclose(v, expected, atol=1e-3)
    diameter, measured = GUNN_KINZER[1:].T
    atlas = np.abs(drops.terminal_speed(diameter) - measured).mean()
    assert atlas < np.abs(drops.terminal_speed(diameter, "liu_tong") - measured).mean()


def test_beyond_the_sizes_of_a_law_its_pieces_go_on() -> None:
    assert drops.terminal_speed([0.2, 8.0], "liu_tong") == pytest.approx([0.8744, 9.0], abs=1e-3)
    assert drops.terminal_speed([6.0, 50.0]).tolist() == pytest.approx([9.3686, 9.65], abs=1e-3)
    with pytest.raises(InvalidValueError, match="diameter_mm"):
        drops.fall_speed(100.1, 1.0)


def test_speeds_of_the_first_paper() -> None:
    """Radii 0.1 to 0.45 mm: 0.72 to 3.67 m/s, spheres; 0.5 to 4 mm: 4.0 to 9.23, flattened."""
    small = drops.fall_speed([0.2, 0.9], math.inf)
    assert np.allclose(small, (0.72, 3.67), rtol=0.06)
    assert np.allclose(drops.terminal_speed([1.0, 8.0]), (4.0, 9.23), rtol=0.05)


def reference_fall(diameter_mm: float, time: float, step: float = 2e-5) -> float:
    """The same balance of forces by small plain steps, written out on its own."""
    d, r, speed = diameter_mm * 1e-3, 1.22 / 1000.0, 0.0
    for _ in range(round(time / step)):
        re = max(speed * d / 1.493776e-5, 1e-12)
        drag = 24.0 / re * (1.0 + 0.15 * re**0.687) + 0.42 / (1.0 + 42500.0 * re**-1.16)
        pull = (1.0 - r) * 9.8 - 3.0 * r * drag / (4.0 * d) * speed * speed
        speed += step * pull / (1.0 + r / 2.0)
    return speed


@pytest.mark.parametrize("diameter", [0.1, 0.5, 1.5, 5.0])  # mm
@pytest.mark.parametrize("time", [0.01, 0.05, 0.5, 1.3])
def test_fall_from_rest_follows_the_equation(diameter: float, time: float) -> None:
    expected = reference_fall(diameter, time)
    assert drops.fall_speed(diameter, time) == pytest.approx(expected, abs=0.004)


def test_fall_starts_with_gravity_and_ends_terminal() -> None:
    start = drops.fall_speed([0.5, 2.0, 6.0], 0.001)
    assert np.allclose(start, 9.8 * 0.001 * (1 - 0.00122) / (1 + 0.00061), rtol=0.01)
    settled = [(0.2, 0.72), (0.5, 2.06), (1.0, 4.03), (1.5, 5.41), (2.0, 6.49)]
    diameter, measured = np.array(settled).T
    assert np.allclose(drops.fall_speed(diameter, 30.0), measured, rtol=0.06)
    assert np.array_equal(drops.fall_speed(diameter, 30.0), drops.fall_speed(diameter, math.inf))


@settings(deadline=None)
@given(st.floats(0.0, 10.0), st.floats(0.0, 20.0), st.floats(0.0, 5.0))
def test_fall_speed_grows_with_time_and_never_passes_free_fall(
    diameter: float, time: float, later: float
) -> None:
    now, then = drops.fall_speed(diameter, [time, time + later])
    assert 0.0 <= now <= then + 1e-4
    assert now <= 9.8 * time + 1e-12
    assert then <= drops.fall_speed(diameter, math.inf) + 1e-4


def test_fall_speed_broadcasts_and_takes_any_size() -> None:
    table = drops.fall_speed(np.array([[0.0], [1e-6], [0.01], [1.0], [6.0]]), [0.0, 0.5, 9.0])
    assert table.shape == (5, 3)
    assert np.all(table[:, 0] == 0.0)
    assert np.all(np.diff(table[:, 2]) >= 0.0)
    assert table[2, 2] == pytest.approx(1e-10 * 9.8 / 18.0 / 1.22e-3 / 1.493776e-5, rel=0.02)
    alone = [[drops.fall_speed(d, t) for t in (0.0, 0.5, 9.0)] for d in (0.0, 1e-6, 0.01, 1.0, 6.0)]
    assert np.allclose(table, alone)


def test_axis_ratio_of_beard_and_chuang() -> None:
    ratio = drops.axis_ratio([1.0, 2.0, 3.0, 4.0, 5.0, 6.0])
    assert np.allclose(ratio, [0.983, 0.928, 0.856, 0.779, 0.706, 0.640], atol=6e-4)
    assert np.all(drops.axis_ratio([0.0, 0.1, 0.3]) == 1.0)
    assert drops.axis_ratio(0.5) == pytest.approx(1.0, abs=0.002)
    fine = drops.axis_ratio(np.linspace(0.5, 8.0, 300))
    assert np.all(np.diff(fine) < 0.0)
    assert drops.axis_ratio(50.0) == drops.axis_ratio(8.0) > 0.4


@pytest.mark.parametrize("bad", [-1.0, math.nan, math.inf, "heavy", None])
def test_bad_input_is_named(bad: Any) -> None:
    for function in (
        drops.slope, drops.number_density, drops.drop_density, drops.flux_normalisation,
        drops.mean_cross_section, drops.extinction, drops.extinction_of_sampled,
    ):  # fmt: skip
        with pytest.raises(InvalidValueError, match="rain_rate"):
            function(bad)
    with pytest.raises(InvalidValueError, match="rain_rate"):
        drops.size_distribution(1.0, bad)
    with pytest.raises(InvalidValueError, match="rain_rate"):
        drops.sample_diameters(5, bad, np.random.default_rng())
    sized: list[Callable[[Any], object]] = [drops.terminal_speed, drops.axis_ratio]
    for of_size in sized:
        with pytest.raises(InvalidValueError, match="diameter_mm"):
            of_size(bad)
    with pytest.raises(InvalidValueError, match="diameter_mm"):
        drops.fall_speed(bad, 1.0)
    with pytest.raises(InvalidValueError, match="diameter_mm"):
        drops.size_distribution(bad, 1.0)
    if bad != math.inf:
        with pytest.raises(InvalidValueError, match="time"):
            drops.fall_speed(1.0, bad)


def test_bad_counts_models_and_shares() -> None:
    rng = np.random.default_rng()
    wrong: list[Any] = [-1, 2.5, None, True]
    for n in wrong:
        with pytest.raises(InvalidValueError, match="n"):
            drops.sample_diameters(n, 5.0, rng)
    with pytest.raises(InvalidValueError, match="model"):
        drops.terminal_speed(1.0, "newton")
    for u in (-0.1, 1.1, math.nan):
        with pytest.raises(InvalidValueError, match="u"):
            drops.diameter_quantile(u, 5.0)
    with pytest.raises(InvalidValueError, match="largest"):
        drops.number_density(5.0, 2.0, 1.0)
