"""Stars of the sky, and the rain that a rainbow stands in."""

from __future__ import annotations

import math

import numpy as np
import pytest

from weather_ecs.frame import AREA_DTYPE
from weather_ecs.physics.rain_ahead import FAR, bow_strength, rain_along
from weather_ecs.physics.stars import FAINTEST, stars

CEILING = 900.0  # m, of the areas


def separation(a: tuple[float, float], b: tuple[float, float]) -> float:
    """Degrees between two places (right ascension in hours, declination in degrees)."""
    (a1, d1), (a2, d2) = ((math.radians(15.0 * h), math.radians(d)) for h, d in (a, b))
    cosine = math.sin(d1) * math.sin(d2) + math.cos(d1) * math.cos(d2) * math.cos(a1 - a2)
    return math.degrees(math.acos(cosine))


def nearest(place: tuple[float, float]) -> tuple[float, float]:
    """(degrees off, magnitude) of the bright star nearest to a place."""
    a, d = math.radians(15.0 * place[0]), math.radians(place[1])
    way = np.array((math.cos(d) * math.cos(a), math.cos(d) * math.sin(a), math.sin(d)))
    them = stars()
    bright = np.flatnonzero(them.magnitudes < 2.5)
    cosines = them.directions[bright] @ way
    best = int(cosines.argmax())
    return math.degrees(math.acos(min(cosines[best], 1.0))), float(them.magnitudes[bright[best]])


def test_bright_stars_are_where_catalogues_have_them() -> None:
    for place, magnitude in (
        ((6.7525, -16.716), -1.46),  # Sirius
        ((18.6156, 38.784), 0.03),  # Vega
        ((2.5303, 89.264), 2.02),  # Polaris
        ((5.9195, 7.407), 0.50),  # Betelgeuse
    ):
        off, found = nearest(place)
        assert off < 0.1
        assert found == pytest.approx(magnitude, abs=0.05)
    # Known widths: the Big Dipper's pointers, Orion's belt.
    assert separation((11.062, 61.75), (11.031, 56.38)) == pytest.approx(5.4, abs=0.1)


def test_counts_and_light_are_those_of_the_sky() -> None:
    """About 50 stars to magnitude 2, 500 to 4, and three times as many with every magnitude."""
    m = stars().magnitudes
    assert 35 < (m < 2.0).sum() < 60
    assert 200 < (m < 4.0).sum() < 700
    assert 2.0 < (m < 5.5).sum() / (m < 4.5).sum() < 4.5
    assert m.max() <= FAINTEST
    assert np.allclose(np.linalg.norm(stars().directions, axis=1), 1.0)
    assert stars().colors.min() > 0.3
    assert stars().colors.max() <= 1.0


def areas(*rows: tuple[float, ...]) -> np.ndarray:
    made = np.zeros(len(rows), AREA_DTYPE)
    for row, (x, z, a, b, heading, rate) in zip(made, rows, strict=True):
        row["center"], row["radii"], row["heading"], row["rain_rate"] = (
            (x, z),
            (a, b),
            heading,
            rate,
        )
    made["ceiling"] = CEILING
    return made


def test_rain_along_a_look_is_the_chord_of_the_ellipse() -> None:
    east, north = np.array([1.0, 0.0, 0.0]), np.array([0.0, 0.0, -1.0])
    here = (0.0, 2.0, 0.0)
    looks = np.stack([east, north])
    assert np.allclose(rain_along(areas((1000, 0, 200, 100, 0, 1.0)), here, looks), (400, 0))
    turned = areas((1000, 0, 200, 100, math.pi / 2, 1.0))
    assert rain_along(turned, here, east) == pytest.approx(200.0)
    within = areas((0, 0, 200, 100, 0, 10.0))
    assert np.allclose(rain_along(within, here, looks), np.array((200, 100)) * 10.0**0.63)
    assert rain_along(areas((-1000, 0, 200, 100, 0, 1.0)), here, east) == 0.0  # behind
    assert rain_along(areas((FAR + 500, 0, 200, 100, 0, 1.0)), here, east) == 0.0
    assert rain_along(areas((1000, 0, 200, 100, 0, 0.0)), here, east) == 0.0


def test_rain_along_a_look_ends_at_the_ceiling() -> None:
    """One who flies over the rain has it below the horizon only, and none overhead."""
    wide = areas((0, 0, 3000, 3000, 0, 1.0))
    up, down = (np.array([math.cos(a), math.sin(a), 0.0]) for a in (math.pi / 4, -math.pi / 4))
    assert rain_along(wide, (0.0, 100.0, 0.0), up) == pytest.approx(CEILING - 100.0)
    above = (0.0, CEILING + 500.0, 0.0)
    assert rain_along(wide, above, up) == 0.0
    assert rain_along(wide, above, np.array([1.0, 0.0, 0.0])) == 0.0
    assert rain_along(wide, above, down) == pytest.approx(3000.0 - 500.0)


def test_a_bow_grows_with_the_rain_up_to_its_full_light() -> None:
    rain = np.array([0.0, 100.0, 500.0, 5000.0, 1e9])
    strength = bow_strength(rain)
    assert strength[0] == 0.0
    assert (np.diff(strength) >= 0.0).all()
    assert strength[-1] == 1.0
