"""Gust and steady wind: what the paper says in words, and its formulas where the two agree."""

from __future__ import annotations

import math
from collections.abc import Callable

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st
from numpy.typing import ArrayLike, NDArray

from weather_ecs.errors import InvalidValueError
from weather_ecs.physics import wind

spans = st.floats(0.1, 50.0)
coefficient = st.floats(0.1, 3.0)


def assert_continuous(
    law: Callable[[ArrayLike], NDArray[np.float64]], joints: tuple[float, ...]
) -> None:
    """No jump: over a step a thousand times smaller, the largest change is far smaller too."""
    for joint in joints:
        around = joint + np.linspace(-1.0, 1.0, 401) * 1e-3
        fine = joint + np.linspace(-1.0, 1.0, 401) * 1e-6
        coarse = np.abs(np.diff(law(around))).max()
        assert np.abs(np.diff(law(fine))).max() <= 0.01 * coarse + 1e-9
    assert law(0.0) == 0.0
    assert law(joints[-1]) == 0.0
    assert np.array_equal(law([-1.0, -math.inf, joints[-1] + 1e-9, 1e9, math.inf]), np.zeros(5))


@settings(max_examples=50, deadline=None)
@given(spans, spans, coefficient, st.floats(-0.05, 1.0), coefficient, coefficient)
def test_gust_is_continuous_for_any_coefficients(
    tc: float, rest: float, a: float, b: float, c: float, d: float
) -> None:
    end = tc + rest

    def law(t: ArrayLike) -> NDArray[np.float64]:
        return wind.gust(t, tc, end, a=a, b=b, c=c, d=d)

    assert_continuous(law, (0.0, tc, end))
    strength = law(np.linspace(0.0, end, 500))
    assert np.all((strength >= 0.0) & (strength <= max(a + b, c) + 1e-12))


def test_gust_of_the_paper_rises_peaks_and_falls_to_zero() -> None:
    t = np.linspace(0.0, 10.0, 1001)
    strength = wind.gust(t, 4.0, 10.0)
    assert np.allclose(strength[:401], t[:401] / 4.0)  # a t + b in units of tc
    assert np.allclose(strength[400:], 1.0 - (t[400:] - 4.0) / 6.0)
    assert strength.max() == strength[400] == 1.0
    assert np.all(np.diff(strength[:401]) > 0.0)
    assert np.all(np.diff(strength[400:]) < 0.0)


def test_gust_of_two_tc_is_the_printed_formula_with_its_sign_turned() -> None:
    t = np.linspace(0.0, 6.0, 61)
    printed = np.where(t <= 3.0, t / 3.0, 1.0 - (t - 3.0) / 3.0)
    assert np.allclose(wind.gust(t, 3.0, 6.0), printed)
    tall = wind.gust(t, 3.0, 6.0, a=2.0, c=2.0, d=2.0)
    assert np.allclose(tall, 2.0 * printed)


def test_gust_with_a_steep_fall_is_over_early() -> None:
    assert wind.gust(5.9, 2.0, 10.0, d=2.0) > 0.0
    assert wind.gust(6.1, 2.0, 10.0, d=2.0) == 0.0
    slow = wind.gust(np.array((9.0, 9.99)), 2.0, 10.0, d=0.1)
    assert np.allclose(slow, (0.125, 0.00125))


@settings(max_examples=50, deadline=None)
@given(
    spans, spans, spans, coefficient, st.floats(-0.05, 1.0), coefficient, coefficient,
    coefficient, coefficient,
)  # fmt: skip
def test_steady_is_continuous_for_any_coefficients(
    tc: float, held: float, rest: float, a: float, b: float, c: float, d: float, e: float, f: float
) -> None:
    middle, end = tc + held, tc + held + rest

    def law(t: ArrayLike) -> NDArray[np.float64]:
        return wind.steady(t, tc, middle, end, a=a, b=b, c=c, d=d, e=e, f=f)

    assert_continuous(law, (0.0, tc, middle, end))
    strength = law(np.linspace(0.0, end, 500))
    top = a + b + c + d + e
    assert np.all((strength >= 0.0) & (strength <= top))


def test_steady_of_the_paper_rises_holds_and_dies() -> None:
    t = np.linspace(0.0, 40.0, 4001)
    strength = wind.steady(t, 2.0, 30.0, 40.0)
    rise, hold, death = t <= 2.0, (t >= 2.0) & (t <= 30.0), t >= 30.0
    assert np.allclose(strength[rise], t[rise] / 2.0)
    assert np.all(np.abs(strength[hold] - 1.0) <= 0.3 + 1e-12)
    assert strength[hold].std() > 0.1  # it does vary
    inner = (t >= 4.0) & (t <= 28.0)
    assert np.allclose(strength[inner], 1.0 + 0.3 * np.cos(t[inner] / 2.0))  # as printed
    assert np.allclose(strength[death], 1.0 - (t[death] - 30.0) / 10.0)
    assert strength[rise][-1] == pytest.approx(1.0)
    assert np.all(np.diff(strength[death]) < 0.0)


def test_times_may_be_one_or_many() -> None:
    assert wind.gust(1.0, 2.0, 4.0).shape == ()
    assert wind.steady(np.zeros((2, 3)), 1.0, 2.0, 3.0).shape == (2, 3)
    assert wind.steady([], 1.0, 2.0, 3.0).shape == (0,)


def test_power_law() -> None:
    assert wind.power_law(10.0) == 1.0
    assert wind.power_law(20.0) == pytest.approx(2.0**0.14)
    assert wind.power_law(2.0) == pytest.approx(0.7983, abs=1e-3)
    assert np.array_equal(wind.power_law([0.0, -5.0]), [0.0, 0.0])
    assert np.array_equal(wind.power_law([-1.0, 0.0, 3.0], exponent=0.0), [0.0, 0.0, 1.0])
    assert np.all(np.diff(wind.power_law(np.linspace(0.0, 500.0, 100))) > 0.0)
    assert wind.power_law(4.0, reference=2.0, exponent=1.0) == 2.0


@pytest.mark.parametrize(
    "call",
    [
        lambda: wind.gust(0.0, 0.0, 1.0),
        lambda: wind.gust(0.0, -1.0, 1.0),
        lambda: wind.gust(0.0, 2.0, 1.0),
        lambda: wind.gust(0.0, 1.0, 1.0),
        lambda: wind.gust(0.0, 1.0, math.inf),
        lambda: wind.gust(math.nan, 1.0, 2.0),
        lambda: wind.gust(0.0, math.nan, 2.0),
        lambda: wind.gust(0.0, 1.0, 2.0, a=math.nan),
        lambda: wind.gust("now", 1.0, 2.0),
        lambda: wind.steady(0.0, 2.0, 1.0, 3.0),
        lambda: wind.steady(0.0, 1.0, 3.0, 2.0),
        lambda: wind.steady([0.0, math.nan], 1.0, 2.0, 3.0),
        lambda: wind.steady(0.0, 1.0, 2.0, 3.0, d=math.inf),
        lambda: wind.power_law(math.nan),
        lambda: wind.power_law(1.0, reference=0.0),
        lambda: wind.power_law(1.0, reference=-1.0),
        lambda: wind.power_law(1.0, exponent=-0.1),
    ],
)
def test_bad_input_is_named(call: Callable[..., object]) -> None:
    with pytest.raises(InvalidValueError):
        call()
