"""What is seen under the horizon from high up: clouds, and ground behind clean air."""

from __future__ import annotations

import numpy as np
import pytest

from weather_ecs.physics import sky_floor, sky_map
from weather_ecs.physics.cloud_light import CLEAN, CLEAN_HEIGHT, surround

SKY, LAND, TOPS = np.array([0.5, 0.6, 0.7]), np.array([0.10, 0.12, 0.08]), np.array([0.8] * 3)


def seen(sines: list[float], share: float, depth: float) -> np.ndarray:
    level = np.tile(SKY, (len(sines), 1))
    return sky_floor.floor_light(level, LAND, TOPS, share, depth, np.array(sines))


def test_the_air_below_is_as_deep_as_its_law_says() -> None:
    heights = np.linspace(0.0, 5000.0, 20_001)
    whole = np.trapezoid(CLEAN * np.exp(-heights / CLEAN_HEIGHT), heights)
    assert sky_floor.depth_below(5000.0) == pytest.approx(whole, rel=1e-4)
    upper = heights >= 2500.0
    part = np.trapezoid(CLEAN * np.exp(-heights[upper] / CLEAN_HEIGHT), heights[upper])
    assert sky_floor.depth_below(5000.0, 2500.0) == pytest.approx(part, rel=1e-3)
    assert sky_floor.depth_below(0.0) == sky_floor.depth_below(-20.0) == 0.0


def test_the_horizon_is_as_bright_as_the_sky_over_it() -> None:
    """Without air a dark land would begin there; from 5 km it comes out of haze by and by."""
    high = seen([0.0, -0.03, -0.1, -0.3, -1.0], 0.0, sky_floor.depth_below(5000.0))
    low = seen([0.0, -0.1], 0.0, sky_floor.depth_below(1.7))
    assert np.allclose(high[0], SKY) and np.allclose(low[0], SKY)
    assert (np.diff(high[:, 0]) < 0.0).all()
    assert high[1, 0] > 0.8 * SKY[0]
    assert low[1, 0] < 0.25 * SKY[0]
    assert high[4] == pytest.approx(LAND, abs=0.09)


def test_a_deck_hides_the_land() -> None:
    deck = seen([-0.2], 1.0, 0.0)[0]
    assert deck == pytest.approx(TOPS, abs=1e-3)
    half = seen([-0.2], 0.5, 0.0)[0]
    assert half == pytest.approx(0.5 * (TOPS + LAND), abs=1e-3)


def test_so_many_clouds_cover_so_much() -> None:
    around = np.pi * sky_floor.AROUND**2
    assert sky_floor.share_covered(np.zeros(0)) == 0.0
    assert sky_floor.share_covered(np.full(10, 0.01 * around)) == pytest.approx(
        1.0 - np.exp(-0.1 * sky_floor.FILLED)
    )
    assert sky_floor.share_covered(np.full(100, 0.1 * around)) > 0.99


def test_tops_are_as_bright_as_the_sun_that_they_have() -> None:
    def top(high: float, sun: float, darkness: float = 0.0) -> float:
        towards = (0.0, high, (1.0 - high * high) ** 0.5)
        light = surround(towards, (sun,) * 3, (0.2, 0.3, 0.6), (0.5, 0.6, 0.7), (0.2,) * 3)
        return float(sky_floor.top_light(light, darkness).mean())

    assert top(0.9, 1.0) > 1.2 * top(0.1, 1.0)
    assert top(0.1, 1.0) > 1.5 * top(0.9, 0.0)
    assert top(0.5, 1.0, 0.9) == pytest.approx(top(0.5, 1.0), rel=0.05)


def test_light_that_is_bent_in_the_picture_is_bent_back() -> None:
    light = np.linspace(0.0, 2.0, 50)
    shown = sky_map.shown(light) ** 2.2
    assert sky_floor.unbent(shown[shown < 0.96]) == pytest.approx(light[shown < 0.96], abs=1e-6)
