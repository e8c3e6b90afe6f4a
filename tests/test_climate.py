"""State and shares of the climate: the dissertation's worked example, and properties."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.climate import shares, state

UNIT = st.floats(0.0, 1.0)
STATES = st.lists(UNIT, min_size=1, max_size=8, unique=True)


def test_the_worked_example():
    """Torchelsen 2005, 3.4: skies at 0, 0.25, 0.75 and 1, from 0 to 1 in 30, at 15."""
    now = state(0.0, 1.0, 30.0, 15.0)
    assert now == 0.5
    assert shares([0.0, 0.25, 0.75, 1.0], now).tolist() == [0.0, 0.5, 0.5, 0.0]


def test_three_skies_take_over_one_after_the_other():
    """The run of Figure 20: sky 1 alone, then 2 alone in the middle, then 3."""
    skies = [0.0, 0.5, 1.0]
    assert shares(skies, 0.0).tolist() == [1, 0, 0]
    assert shares(skies, 0.125).tolist() == [0.75, 0.25, 0]
    assert shares(skies, 0.5).tolist() == [0, 1, 0]
    assert shares(skies, 0.75).tolist() == [0, 0.5, 0.5]
    assert shares(skies, 1.0).tolist() == [0, 0, 1]


def test_the_state_runs_evenly_and_stays_at_its_ends():
    assert [state(0.2, 0.6, 10, t) for t in (0, 5, 10)] == pytest.approx([0.2, 0.4, 0.6])
    assert state(1.0, 0.0, 10, 2.5) == 0.75
    assert state(0.2, 0.6, 10, -1) == 0.2
    assert state(0.2, 0.6, 10, 1e9) == 0.6


@settings(deadline=None)
@given(UNIT, UNIT, st.floats(1e-300, 1e300), st.floats(-1e300, 1e300))
def test_the_state_never_leaves_its_ends(initial, final, duration, t):
    now = state(initial, final, duration, t)
    assert min(initial, final) <= now <= max(initial, final)


@settings(deadline=None)
@given(STATES, UNIT)
def test_shares_are_those_of_the_formula(skies, now):
    got = shares(skies, now)
    assert got.shape == (len(skies),)
    assert got.sum() == pytest.approx(1.0, abs=1e-12)
    assert np.all(got >= 0.0)
    below = [s for s in skies if s < now]
    above = [s for s in skies if s >= now]
    if not below or not above:
        assert got[skies.index(min(skies, key=lambda s: abs(s - now)))] == 1.0
        return
    low, high = max(below), min(above)
    for s, share in zip(skies, got, strict=True):
        expected = 1.0 - abs((now - s) / (high - low)) if s in (low, high) else 0.0
        assert share == pytest.approx(expected, abs=1e-9)


@settings(deadline=None)
@given(STATES, UNIT)
def test_the_order_of_the_skies_does_not_matter(skies, now):
    assert shares(skies[::-1], now).tolist() == shares(skies, now)[::-1].tolist()


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        ((0, 1, 0, 5), "duration"),
        ((0, 1, -3, 5), "duration"),
        ((0, 1, math.nan, 5), "duration"),
        ((-0.1, 1, 1, 0), "initial"),
        ((0, 1.1, 1, 0), "final"),
        ((0, 1, 1, math.nan), "t"),
        ((0, "late", 1, 0), "final"),
    ],
)
def test_bad_runs_are_refused(arguments, field):
    with pytest.raises(InvalidValueError) as caught:
        state(*arguments)
    assert caught.value.field == field


@pytest.mark.parametrize(
    ("skies", "now"),
    [([], 0.5), ([0.5, 0.5], 0.5), ([0.0, 1.5], 0.5), ([[0.0]], 0), ([0.0], -1), ([0.0], math.nan)],
)
def test_bad_skies_are_refused(skies, now):
    with pytest.raises(InvalidValueError):
        shares(skies, now)
