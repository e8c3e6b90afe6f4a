"""Fog and visibility against Koschmieder's law and the figures of rain."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from weather_ecs.errors import InvalidValueError
from weather_ecs.physics import optics
from weather_ecs.physics.drops import extinction


def test_fog_takes_the_same_share_of_every_metre() -> None:
    assert optics.fog_factor(0.0, 0.8) == 1.0
    assert optics.fog_factor(1.0, 0.8) == pytest.approx(0.449328964, abs=1e-9)
    far = optics.fog_factor(np.arange(20.0), 0.8)
    assert np.allclose(far[1:] / far[:-1], math.exp(-0.8))


@given(st.floats(0.0, math.inf), st.floats(0.0, math.inf))
def test_fog_factor_is_a_share_whatever_the_numbers(distance: float, density: float) -> None:
    share = optics.fog_factor(distance, density)
    assert 0.0 <= share <= 1.0
    assert share == 1.0 or (distance > 0.0 and density > 0.0)


def test_fog_at_infinity() -> None:
    assert optics.fog_factor(math.inf, 0.01) == 0.0
    assert optics.fog_factor(math.inf, 0.0) == 1.0
    assert optics.fog_factor(5.0, math.inf) == 0.0


@given(st.floats(1e-3, 1e9))
def test_an_object_at_the_visibility_keeps_two_percent_of_its_contrast(visibility: float) -> None:
    lost = optics.visibility_to_extinction(visibility)
    assert optics.fog_factor(visibility, lost) == pytest.approx(0.02, rel=1e-3)
    assert optics.extinction_to_visibility(lost) == pytest.approx(visibility)


def test_koschmieder_at_round_figures_and_limits() -> None:
    assert np.allclose(optics.visibility_to_extinction([1000.0, 100.0]), [0.003912, 0.03912])
    assert optics.visibility_to_extinction(math.inf) == 0.0
    assert optics.extinction_to_visibility(0.0) == math.inf


def test_visibility_in_rain() -> None:
    """3.912 over 0.365, 1.01, 2.77 and 6.64 per km."""
    seen = optics.visibility_in_rain([1.0, 5.0, 25.0, 100.0])
    assert np.allclose(seen, [10728.0, 3892.0, 1412.0, 589.5], rtol=2e-3)
    assert np.all(np.diff(optics.visibility_in_rain(np.linspace(0.1, 1000.0, 50))) < 0.0)
    assert optics.visibility_in_rain(0.0) == math.inf
    assert optics.visibility_in_rain(0.0, 20_000.0) == pytest.approx(20_000.0)
    both = optics.visibility_in_rain(25.0, 5000.0)
    assert both == pytest.approx(3.912 / (extinction(25.0) + 3.912 / 5000.0))


@pytest.mark.parametrize(
    "call",
    [
        lambda: optics.fog_factor(-1.0, 0.1),
        lambda: optics.fog_factor(1.0, -0.1),
        lambda: optics.fog_factor(math.nan, 0.1),
        lambda: optics.fog_factor([1.0, math.nan], 0.1),
        lambda: optics.visibility_to_extinction(0.0),
        lambda: optics.visibility_to_extinction([100.0, 1e-305]),
        lambda: optics.visibility_to_extinction(-5.0),
        lambda: optics.visibility_to_extinction(math.nan),
        lambda: optics.extinction_to_visibility(-1e-9),
        lambda: optics.visibility_in_rain(-1.0),
        lambda: optics.visibility_in_rain(1.0, 0.0),
        lambda: optics.fog_factor("far", 1.0),
    ],
)
def test_bad_input_is_named(call: Callable[..., object]) -> None:
    with pytest.raises(InvalidValueError):
        call()
