"""Level of detail: Equations 2 and 3, and that the weights fill every ring evenly."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st
from numpy.typing import NDArray

from weather_ecs.errors import InvalidValueError
from weather_ecs.physics import lod

N = 400_000
Drawn = tuple[NDArray[np.float64], NDArray[np.float64]]


@pytest.fixture(scope="module")
def drawn() -> Drawn:
    rng = np.random.default_rng(20)
    d = lod.radial_positions(N, rng)
    return d, lod.own_reach(d, rng.random(N))


def largest_gap(
    sample: NDArray[np.float64], cdf: Callable[[NDArray[np.float64]], NDArray[np.float64]]
) -> float:
    """Kolmogorov's statistic times sqrt(n): above 1.95 once in a thousand samples."""
    ordered = np.sort(sample)
    expected = cdf(ordered)
    ranks = np.arange(len(ordered) + 1) / len(ordered)
    gap = max(np.abs(expected - ranks[1:]).max(), np.abs(expected - ranks[:-1]).max())
    return gap * math.sqrt(len(ordered))


def test_positions_follow_equation_2(drawn: Drawn) -> None:
    d, _ = drawn
    assert d.min() >= 0.0
    assert d.max() < 1.0
    assert largest_gap(d, lambda x: 1.0 - (1.0 - x) ** 2) < 1.95
    assert d.mean() == pytest.approx(1.0 / 3.0, abs=4.0 * math.sqrt(1.0 / 18.0 / N))


def test_positions_are_the_inverse_of_the_law() -> None:
    u = np.random.default_rng(3).random(1000)
    d = lod.radial_positions(1000, np.random.default_rng(3))
    assert np.allclose(d, 1.0 - np.sqrt(1.0 - u), atol=1e-15)
    assert lod.radial_positions(0, np.random.default_rng(3)).shape == (0,)


def test_size_grows_with_the_square() -> None:
    d = np.linspace(0.0, 1.0, 11)
    assert np.allclose(lod.size_factor(d, 4.0), 1.0 + 3.0 * d**2)
    assert np.array_equal(lod.size_factor([-1.0, 7.0, math.inf], 4.0), [1.0, 4.0, 4.0])
    assert np.all(np.diff(lod.size_factor(d, 4.0)) > 0.0)
    assert np.all(lod.size_factor(d, 1.0) == 1.0)


def test_own_reach_is_uniform_over_all_drops(drawn: Drawn) -> None:
    d, s = drawn
    assert np.all((s >= d) & (s <= 1.0) & (s > 0.0))
    assert largest_gap(s, lambda x: x) < 1.95


def test_a_drop_is_anywhere_in_its_own_half_disc(drawn: Drawn) -> None:
    """Given s, d/s has the density 2 q of a uniform disc; also for the small and large s alone."""
    d, s = drawn
    for low, high in [(0.0, 0.1), (0.1, 0.5), (0.5, 0.9), (0.9, 1.0)]:
        chosen = (s > low) & (s <= high)
        assert largest_gap(d[chosen] / s[chosen], np.square) < 1.95


def test_the_mixture_gives_equation_2_back() -> None:
    rng = np.random.default_rng(5)
    d = rng.random(N) * np.sqrt(rng.random(N))
    assert largest_gap(d, lambda x: 1.0 - (1.0 - x) ** 2) < 1.95


def test_own_reach_at_the_ends() -> None:
    assert np.allclose(lod.own_reach(0.3, [0.0, 1.0]), [0.3, 1.0])
    assert np.all(lod.own_reach(0.0, [0.0, 0.5, 0.999]) > 0.0)
    assert np.all(np.isfinite(0.0 / lod.own_reach(0.0, np.linspace(0.0, 1.0, 9))))
    assert np.all(lod.own_reach(1.0, [0.0, 0.5, 1.0]) == 1.0)


def test_rim_fade() -> None:
    q = [0.0, 0.75, 0.8, 0.875, 1.0, 1.5, math.inf]
    assert np.allclose(lod.rim_fade(q), [1.0, 1.0, 0.8, 0.5, 0.0, 0.0, 0.0])


@given(st.floats(0.0, 1.0))
def test_weight_shape_is_the_integral_of_the_fade(d: float) -> None:
    edges = np.unique(np.concatenate((np.linspace(d, 1.0, 201), [max(d, 0.75)])))
    fade = lod.rim_fade(edges)
    integral = float(((fade[1:] + fade[:-1]) / 2.0 * np.diff(edges)).sum())
    assert lod.weight_shape(d) == pytest.approx(integral, abs=1e-12)


def test_weights_fill_every_ring_with_the_real_density(drawn: Drawn) -> None:
    d, s = drawn
    density, height, reach = 547.0, 24.0, 40.0
    weights = lod.drops_stood_for(d, s, density, height, reach, N)
    edges = np.linspace(0.0, 1.0, 26)
    total, _ = np.histogram(d, edges, weights=weights)
    spread, _ = np.histogram(d, edges, weights=weights**2)
    volume = 0.5 * math.pi * reach**2 * np.diff(edges**2) * height
    error = np.sqrt(spread)  # of the sum, in standard deviations
    assert np.all(np.abs(total - density * volume) < 4.0 * error)
    assert np.all(error[1:-1] < 0.05 * density * volume[1:-1])  # so that the line above says much
    everything = density * volume.sum()
    assert weights.sum() == pytest.approx(everything, rel=0.02)


def test_weights_are_even_within_a_ring_and_finite_everywhere() -> None:
    """At one distance, the mean over the drops there is what a uniform density asks for."""
    u = (np.arange(100_000) + 0.5) / 100_000
    for d in [1e-9, 0.01, 0.3, 0.74, 0.75, 0.76, 0.9, 0.999]:
        weights = lod.drops_stood_for(d, lod.own_reach(d, u), 100.0, 10.0, 20.0, 50_000)
        per_ring = weights.mean() * 50_000 * 2.0 * (1.0 - d)
        assert per_ring == pytest.approx(100.0 * 10.0 * math.pi * d * 20.0**2, rel=1e-4)
    ends = lod.drops_stood_for([0.0, 1.0], [1.0, 1.0], 100.0, 10.0, 20.0, 50_000)
    assert np.array_equal(ends, [0.0, 0.0])
    assert lod.drops_stood_for(0.5, 1.0, 0.0, 10.0, 20.0, 0) == 0.0


@pytest.mark.parametrize(
    "call",
    [
        lambda: lod.radial_positions(-1, np.random.default_rng()),
        lambda: lod.radial_positions(1.5, np.random.default_rng()),  # type: ignore[arg-type]
        lambda: lod.size_factor(math.nan, 4.0),
        lambda: lod.size_factor(0.5, 0.5),
        lambda: lod.size_factor(0.5, math.inf),
        lambda: lod.own_reach(1.5, 0.5),
        lambda: lod.own_reach(0.5, math.nan),
        lambda: lod.own_reach(0.5, -0.1),
        lambda: lod.rim_fade(math.nan),
        lambda: lod.weight_shape(-0.1),
        lambda: lod.drops_stood_for(0.5, 1.0, -1.0, 10.0, 20.0, 5),
    ],
)
def test_bad_input_is_named(call: Callable[..., object]) -> None:
    with pytest.raises(InvalidValueError):
        call()
