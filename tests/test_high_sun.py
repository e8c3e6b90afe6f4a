"""The sun by height, against the geometry of the Earth's shadow and the light at the ground."""

from __future__ import annotations

import math

import numpy as np
import pytest

from weather_ecs.components import Atmosphere
from weather_ecs.physics import astronomy
from weather_ecs.physics.atmosphere import transmittance
from weather_ecs.physics.high_sun import (
    BRIGHT,
    HEIGHTS,
    HIGHEST,
    ROOM,
    high_suns,
    shown_suns,
    sun_at,
)
from weather_ecs.physics.spectrum import seen
from weather_ecs.systems.atmosphere import _heaven

NO_CHANGE = np.ones(3)


@pytest.mark.parametrize("altitude", [53.0, 10.0, 3.0])
def test_at_the_ground_it_is_the_ground_s_and_above_whiter_and_brighter(altitude: float) -> None:
    suns = high_suns(altitude, 2.2)
    assert np.allclose(suns[0], seen(transmittance(altitude)), rtol=1e-6)
    assert (np.diff(suns, axis=0) >= 0.0).all()
    warm = suns[:, 0] / suns[:, 2]
    assert (np.diff(warm) < 0.0).all()


@pytest.mark.parametrize("altitude", [-1.0, -1.5, -2.0, -3.0])
def test_the_earth_s_shadow_reaches_as_high_as_the_horizon_dips(altitude: float) -> None:
    """A place that is h high sees the horizon acos(R / (R + h)) lower, and half a sun there."""
    radius = 6360.0
    dips = np.degrees(np.arccos(radius / (radius + 0.2 + HEIGHTS / 1000.0)))
    suns = high_suns(altitude, 2.2).max(axis=1)
    assert not suns[dips < -altitude - 0.27].any()
    assert (suns[dips > -altitude + 0.27] > 0.0).all()
    assert suns[-1] > 0.0


def test_between_the_heights_it_is_linear_in_their_root() -> None:
    suns = high_suns(1.0, 2.2)
    assert np.allclose(sun_at(suns, HEIGHTS), suns)
    middle = HIGHEST * (2.5 / 6.0) ** 2
    assert np.allclose(sun_at(suns, middle), 0.5 * (suns[2] + suns[3]))
    assert np.allclose(sun_at(suns, [-50.0, 20_000.0]), suns[[0, -1]])
    # Near enough to what it stands for.
    for height in (700.0, 2100.0, 6500.0):
        there = sun_at(high_suns(10.0, 2.2), height)
        low, high = (sun_at(high_suns(10.0, 2.2), h) for h in (0.8 * height, 1.2 * height))
        assert (low < there).all() and (there < high).all()


def test_what_is_shown_is_never_too_bright_and_keeps_its_colour() -> None:
    suns = high_suns(-1.0, 2.2)
    shown = shown_suns(suns, 30.0 * NO_CHANGE, 0.0, -0.017)
    assert suns.max() * 30.0 > 3.0
    assert BRIGHT < shown.max() <= BRIGHT + ROOM
    bright = suns.max(axis=1) > 0.01
    for light, whole in zip(shown[bright], suns[bright], strict=True):
        assert np.allclose(light / light.max(), whole / whole.max())
    assert np.allclose(shown_suns(suns, NO_CHANGE, 0.0, -0.017), suns)
    # Haze is in the lowest kilometre.
    hazy = shown_suns(high_suns(10.0, 2.2), NO_CHANGE, 0.1, math.sin(math.radians(10.0)))
    left = hazy / high_suns(10.0, 2.2)
    assert left[0].max() < 0.65 and np.allclose(left[HEIGHTS > 1000.0], 1.0)


def test_clouds_have_the_sun_while_the_ground_has_dusk_and_the_moon_later() -> None:
    air = Atmosphere(latitude=45.0)
    start = Atmosphere(time="2025-03-13T18:05:00Z").time
    heaven = _heaven(air, float(start), 0.0, 0.0)
    assert astronomy.altitude_azimuth(heaven.sun)[0] < -0.5
    assert heaven.high_direction == astronomy.refracted(heaven.sun)
    assert heaven.light.sun_color.max() < 1.0e-3
    assert heaven.high_colors[-1, 0] > 2.0 * heaven.high_colors[-1, 2] > 0.0
    night = _heaven(air, float(start) + 3.0 * 3600.0, 0.0, 0.0)
    assert night.high_direction == astronomy.refracted(night.moon.direction)
    assert night.high_colors.min() > 0.0
