"""Wet-bulb temperature, and what falls at it."""

from __future__ import annotations

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.phase import (
    LAPSE_RATE,
    melting_height,
    share_at,
    snow_share,
    temperature_at,
    wet_bulb,
)


def psychrometric(t: np.ndarray, humidity: np.ndarray) -> np.ndarray:
    """Wet bulb by the psychrometric equation at 1013.25 hPa, pressures by Magnus."""

    def saturated(x: np.ndarray) -> np.ndarray:
        return 6.112 * np.exp(17.62 * x / (243.12 + x))

    vapour = humidity * saturated(t)
    low, high = t - 60.0 + 0.0 * humidity, t + 0.0 * humidity
    for _ in range(60):
        middle = 0.5 * (low + high)
        dry = saturated(middle) - 6.62e-4 * 1013.25 * (t - middle) < vapour
        low, high = np.where(dry, middle, low), np.where(dry, high, middle)
    return high


def test_wet_bulb_of_stulls_own_example():
    """Stull (2011): 20 degrees and 50 % give 13.7."""
    assert float(wet_bulb(20.0, 0.5)) == pytest.approx(13.7, abs=0.05)


def test_wet_bulb_keeps_to_the_psychrometric_equation():
    t = np.linspace(-15.0, 40.0, 56)[:, None]
    humidity = np.linspace(0.05, 1.0, 39)[None, :]
    off = wet_bulb(t, humidity) - psychrometric(t, humidity)
    valid = 100.0 * humidity >= 27.7 - 2.27 * t
    assert np.abs(off[valid]).max() < 1.4  # his own count: -1 to 0.65
    assert np.abs(off).max() < 1.7  # in cold and dry air too
    assert off[valid].min() < -0.5  # it is a fit and no copy of the oracle


def test_wet_bulb_is_never_above_the_air_nor_missing_anywhere():
    t = np.linspace(-60.0, 60.0, 241)[:, None]
    humidity = np.linspace(0.0, 1.0, 101)[None, :]
    tw = wet_bulb(t, humidity)
    assert np.isfinite(tw).all()
    assert (tw <= t).all()
    assert (np.diff(tw, axis=0) > 0.0).all()  # warmer air, warmer bulb
    assert (np.diff(tw, axis=1) >= 0.0).all()  # damper air too
    np.testing.assert_allclose(tw[:, -1], t[:, 0], atol=1e-12)


def test_half_of_what_falls_is_snow_where_the_observations_say():
    """Wang et al. (2019): a wet bulb of 0.81 degrees; Behrangi et al. (2018): about 1."""
    assert float(snow_share(0.814)) == pytest.approx(0.5, abs=0.001)
    assert float(snow_share(0.0)) == pytest.approx(0.85, abs=0.01)
    assert snow_share([-60.0, -2.0, 3.6, 60.0]).tolist() == [1.0, 1.0, 0.0, 0.0]


def test_dry_air_turns_rain_to_snow():
    assert share_at(3.0, 1.0) < 0.1
    assert share_at(3.0, 0.4) > 0.8
    assert share_at(15.0, 0.8) == 0.0


@given(st.floats(-60.0, 60.0), st.floats(0.0, 1.0))
def test_share_is_one_and_falls_with_the_temperature(temperature, humidity):
    share = share_at(temperature, humidity)
    assert 0.0 <= share <= 1.0
    assert share_at(temperature + 0.25, humidity) <= share + 1e-12
    assert share - share_at(temperature + 0.01, humidity) < 0.02  # no step


def test_temperature_falls_with_height():
    assert temperature_at(15.0, 1000.0) == pytest.approx(8.5)
    assert temperature_at(15.0, 11_000.0) == pytest.approx(-56.5)  # the standard atmosphere's
    assert temperature_at(15.0, 1e7) == temperature_at(15.0, 11_000.0)
    assert temperature_at(15.0, -100.0) == pytest.approx(15.0 + 100.0 * LAPSE_RATE)


def test_melting_height_is_where_half_is_snow():
    height = melting_height(15.0, 0.8)
    assert 1500.0 < height < 2500.0
    assert share_at(temperature_at(15.0, height), 0.8) == pytest.approx(0.5, abs=1e-3)
    assert melting_height(-5.0, 0.9) < 0.0
    assert melting_height(60.0, 0.0) <= 11_000.0


@pytest.mark.parametrize(
    ("field", "arguments"),
    [
        ("temperature", (float("nan"), 0.5)),
        ("temperature", (101.0, 0.5)),
        ("humidity", (0.0, 1.1)),
        ("humidity", (0.0, -0.1)),
    ],
)
def test_bad_input_is_named(field, arguments):
    with pytest.raises(InvalidValueError, match=field):
        wet_bulb(*arguments)
