"""Rainbow and halo against the angles that every book has."""

from __future__ import annotations

import numpy as np
import pytest

from weather_ecs.physics.bows import BOW, HALO, halo, rainbow

LUMINANCE = (0.2126, 0.7152, 0.0722)
PRIMARY, SECONDARY = BOW < 46.0, BOW > 48.0


def peaks(part: np.ndarray) -> list[float]:
    """Where red, green and blue are brightest, degrees."""
    return [float(BOW[part][rainbow()[part, c].argmax()]) for c in range(3)]


def test_primary_is_at_42_degrees_with_red_outside() -> None:
    red, green, blue = peaks(PRIMARY)
    assert red == pytest.approx(42.2, abs=0.4)
    assert blue == pytest.approx(40.8, abs=0.5)
    assert red > green > blue


def test_secondary_is_at_51_degrees_in_reversed_order() -> None:
    red, green, blue = peaks(SECONDARY)
    assert red == pytest.approx(50.6, abs=0.5)
    assert blue == pytest.approx(53.2, abs=0.8)
    assert red < green < blue


def test_alexanders_band_is_dark_and_the_inside_bright() -> None:
    light = rainbow() @ LUMINANCE
    band = light[(BOW > 43.5) & (BOW < 49.0)]
    assert band.max() < 0.02
    assert light[(BOW > 33.0) & (BOW < 39.0)].min() > 0.1
    assert light[(BOW > 54.0) & (BOW < 58.0)].min() > 0.01
    assert 5.0 < light[PRIMARY].max() / light[SECONDARY].max() < 16.0


def test_halo_begins_at_22_degrees_with_red() -> None:
    light = halo() @ LUMINANCE
    assert HALO[light.argmax()] == pytest.approx(22.0, abs=0.4)
    assert light[HALO < 21.0].max() < 0.02
    red, blue = (float(HALO[halo()[:, c].argmax()]) for c in (0, 2))
    assert red < blue
    assert 0.0 < light[HALO.searchsorted(40.0)] < 0.05


def test_all_is_finite_and_positive() -> None:
    for table in (rainbow(), halo()):
        assert np.isfinite(table).all()
        assert table.min() >= 0.0
