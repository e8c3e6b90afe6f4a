"""Sun, moon and sidereal time against published examples and events."""

from __future__ import annotations

import math
from datetime import UTC, datetime

import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from weather_ecs.errors import InvalidValueError
from weather_ecs.physics import astronomy as sky

LATITUDES = st.floats(-90.0, 90.0)
LONGITUDES = st.floats(-180.0, 180.0)
TIMES = st.floats(sky.FIRST, sky.LAST)


def utc(*parts: int) -> float:
    return datetime(*parts, tzinfo=UTC).timestamp()  # type: ignore[misc, arg-type]


def sun_height(time: float, latitude: float, longitude: float) -> float:
    return sky.altitude_azimuth(sky.sun_direction(time, latitude, longitude))[0]


def test_sun_as_in_meeus_25a() -> None:
    """1992 October 13, 0h: apparent right ascension, declination and radius vector."""
    sun = sky.sun_place((2448908.5 - sky.J2000) / 36525.0)
    assert sun.right_ascension == pytest.approx(198.38083, abs=1e-4)
    assert sun.declination == pytest.approx(-7.78507, abs=1e-4)
    assert sun.distance / sky.AU == pytest.approx(0.99766, abs=1e-5)


def test_moon_as_in_meeus_47a_and_48a() -> None:
    """1992 April 12, 0h: place, distance, share lit and bright limb."""
    t = (2448724.5 - sky.J2000) / 36525.0
    moon = sky.moon_place(t)
    assert moon.right_ascension == pytest.approx(134.688470, abs=0.3)
    assert moon.declination == pytest.approx(13.768368, abs=0.3)
    assert moon.distance == pytest.approx(368409.7, rel=0.005)
    seen = sky.moon_at(utc(1992, 4, 12), 0.0, 0.0)
    assert seen.illuminated == pytest.approx(0.6786, abs=0.003)
    assert seen.bright_limb == pytest.approx(285.0, abs=0.5)


def test_sidereal_time_as_in_meeus_12() -> None:
    assert sky.sidereal_time(utc(1987, 4, 10)) == pytest.approx(197.693195, abs=1e-5)
    assert sky.sidereal_time(utc(1987, 4, 10, 19, 21)) == pytest.approx(128.7378734, abs=1e-5)


def test_altitude_and_azimuth_as_in_meeus_13b() -> None:
    """Venus over Washington; his azimuth counts from the south."""
    axes = sky.celestial_axes(utc(1987, 4, 10, 19, 21), 38.921389, -77.065556)
    a, d = math.radians(347.3193375), math.radians(-6.719892)
    x, y, z = axes @ (math.cos(d) * math.cos(a), math.cos(d) * math.sin(a), math.sin(d))
    altitude, azimuth = sky.altitude_azimuth((x, y, z))
    assert altitude == pytest.approx(15.1249, abs=0.005)
    assert azimuth == pytest.approx(68.0337 + 180.0, abs=0.005)


@pytest.mark.parametrize(
    ("moment", "declination"),
    [((2024, 3, 20, 3, 6), 0.0), ((2024, 6, 20, 20, 51), 23.436), ((2024, 12, 21, 9, 20), -23.436)],
)
def test_equinox_and_solstices(moment: tuple[int, ...], declination: float) -> None:
    found = sky.sun_place(sky.centuries(utc(*moment))).declination
    assert found == pytest.approx(declination, abs=0.01)


def test_noon_and_sunrise_at_known_places() -> None:
    """Greenwich, 20 March 2024: noon at 12:07, and sunrise by the hour angle of -50 arc minutes."""
    noon = max(range(700, 760), key=lambda m: sun_height(utc(2024, 3, 20) + 60 * m, 51.4779, 0.0))
    assert abs(noon - 727) <= 1
    assert sun_height(utc(2024, 3, 20) + 60 * noon, 51.4779, 0.0) == pytest.approx(38.6, abs=0.15)
    rise = min(
        range(300, 420),
        key=lambda m: abs(sun_height(utc(2024, 3, 20) + 60 * m, 51.4779, 0.0) + 0.833),
    )
    sine = math.sin(math.radians(-0.833)) / math.cos(math.radians(51.4779))  # at declination 0
    assert abs(rise - (727.4 - 4.0 * math.degrees(math.acos(sine)))) <= 1.5
    # The sun stands within half a degree of Nairobi's zenith at noon of the equinox.
    best = max(sun_height(utc(2024, 3, 20, 9) + 60 * m, -1.29, 36.82) for m in range(120))
    assert best == pytest.approx(88.8, abs=0.3)


def test_it_rises_in_the_east_and_is_south_at_noon() -> None:
    morning = sky.sun_direction(utc(2024, 3, 20, 7), 51.5, 0.0)
    assert morning[0] > 0.9
    noon = sky.sun_direction(utc(2024, 3, 20, 12, 7), 51.5, 0.0)
    assert abs(noon[0]) < 0.01
    assert noon[2] > 0.5
    assert sky.sun_direction(utc(2024, 3, 20, 12, 7), -51.5, 0.0)[2] < -0.5


def test_polar_day_and_night() -> None:
    day = [sun_height(utc(2024, 6, 21) + 3600 * h, 80.0, 20.0) for h in range(24)]
    night = [sun_height(utc(2024, 12, 21) + 3600 * h, 80.0, 20.0) for h in range(24)]
    assert min(day) > 12.0
    assert max(night) < -12.0
    pole = [sun_height(utc(2024, 6, 21) + 3600 * h, 90.0, 0.0) for h in range(24)]
    assert max(pole) - min(pole) < 0.02


def test_moon_at_published_phases() -> None:
    assert sky.moon_at(utc(2024, 1, 25, 17, 54), 0.0, 0.0).illuminated > 0.998
    assert sky.moon_at(utc(2024, 4, 8, 18, 21), 0.0, 0.0).illuminated < 0.0005
    half = sky.moon_at(utc(2024, 1, 18, 3, 53), 0.0, 0.0)
    assert half.illuminated == pytest.approx(0.5, abs=0.01)


def test_eclipse_of_2024_over_dallas() -> None:
    """Totality at 18:42 UTC: moon and sun stand together, which needs the parallax."""
    time = utc(2024, 4, 8, 18, 42)
    sun = np.array(sky.sun_direction(time, 32.78, -96.80))
    moon = np.array(sky.moon_at(time, 32.78, -96.80).direction)
    assert math.degrees(math.acos(float(sun @ moon))) < 0.35


def test_refraction_as_published() -> None:
    """Half a degree at the horizon, a minute of arc half-way up, none overhead."""
    assert sky.refraction(-0.5667) == pytest.approx(0.5667, abs=0.03)
    assert sky.refraction(45.0) * 60.0 == pytest.approx(1.0, abs=0.05)
    assert sky.refraction(90.0) < 1e-4
    assert sky.refraction(-3.0) == sky.refraction(-90.0) == 0.0


@settings(max_examples=60, deadline=None)
@given(TIMES, LATITUDES, LONGITUDES)
def test_everywhere_and_at_any_time(time: float, latitude: float, longitude: float) -> None:
    axes = sky.celestial_axes(time, latitude, longitude)
    assert np.allclose(axes @ axes.T, np.eye(3), atol=1e-12)
    assert np.linalg.det(axes) == pytest.approx(1.0)
    for direction in (
        sky.sun_direction(time, latitude, longitude),
        sky.moon_at(time, latitude, longitude).direction,
    ):
        assert math.hypot(*direction) == pytest.approx(1.0)
        assert np.allclose(sky.direction_of(*sky.altitude_azimuth(direction)), direction, atol=1e-6)
        assert sky.refracted(direction)[1] >= direction[1] - 1e-9


@pytest.mark.parametrize(
    ("time", "latitude", "longitude", "field"),
    [
        (sky.LAST + 1.0, 0.0, 0.0, "time"),
        (sky.FIRST - 1.0, 0.0, 0.0, "time"),
        (math.nan, 0.0, 0.0, "time"),
        (0.0, 90.01, 0.0, "latitude"),
        (0.0, math.inf, 0.0, "latitude"),
        (0.0, 0.0, -180.5, "longitude"),
    ],
)
def test_out_of_range(time: float, latitude: float, longitude: float, field: str) -> None:
    with pytest.raises(InvalidValueError, match=field):
        sky.sun_direction(time, latitude, longitude)
