"""The law of the water on the ground."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from weather_ecs.physics.wetness import (
    DRAINING,
    DRYING,
    FILM,
    STEEP_FILM,
    film_capacity,
    merge,
    merge_one,
    settle,
    settle_one,
)

pytestmark = pytest.mark.usefixtures("world")

water = st.floats(0.0, 10.0)
inflows = st.one_of(st.just(0.0), st.floats(1e-6, 3.0))
capacities = st.floats(0.3, 60.0)
times = st.floats(0.0, 5000.0)


# The law


@settings(deadline=None, max_examples=40)
@given(water, inflows, capacities, st.floats(0.0, 600.0))
def test_the_law_solves_its_equation(w, s, c, seconds):
    steps = 20_000
    expected, dt = w, seconds / steps
    for _ in range(steps):
        expected += dt * (s - expected / DRYING - max(expected - c, 0.0) / DRAINING)
    assert settle_one(w, s, c, seconds) == pytest.approx(expected, rel=2e-3, abs=1e-3)


@settings(deadline=None, max_examples=200)
@given(st.lists(st.tuples(water, inflows, capacities), min_size=1, max_size=6), times, times)
def test_two_steps_are_one(cells, first, second):
    w, s, c = np.array(cells).T
    once = settle(w, s, c, first + second)
    twice = settle(settle(w, s, c, first), s, c, second)
    np.testing.assert_allclose(twice, once, rtol=1e-6, atol=1e-9)
    singly = [settle_one(*cell, first) for cell in cells]
    np.testing.assert_allclose(singly, settle(w, s, c, first), rtol=1e-12, atol=1e-15)


@settings(deadline=None, max_examples=100)
@given(water, inflows, capacities, times)
def test_water_stays_between_where_it_was_and_where_it_ends(w, s, c, seconds):
    end = s * DRYING
    if end > c:
        end = (s + c / DRAINING) / (1.0 / DRYING + 1.0 / DRAINING)
    now = settle_one(w, s, c, seconds)
    assert min(w, end) - 1e-9 <= now <= max(w, end) + 1e-9
    assert settle_one(w, s, c, 1e6) == pytest.approx(end, abs=1e-9)


def test_steep_surfaces_hold_less():
    held = film_capacity(np.linspace(0.0, 1.0, 50))
    assert held[0] == STEEP_FILM and held[-1] == FILM
    assert (np.diff(held) >= 0.0).all()


@given(water, water)
def test_fields_of_different_areas_fill_one_film(a, b):
    both = float(merge(a, b))
    assert max(a, b) - 1e-12 <= both <= a + b
    assert float(merge(b, a)) == pytest.approx(both)
    assert float(merge(a, 0.0)) == pytest.approx(a)
    assert merge_one(a, b) == both
