"""What clouds take of each other's light: the law, and the clouds of a frame that it is for."""

from __future__ import annotations

import math
from typing import Any

import esper
import numpy as np
import pytest
from numpy.typing import NDArray

from weather_ecs import Weather
from weather_ecs.components import Atmosphere, Cloud
from weather_ecs.physics.cloud_shade import PACKED, SKY, STRENGTH, SUN, Bodies, packed, taken

NOON = np.array([0.0, 1.0, 0.0])
Array = NDArray[np.float64]


def bodies(*places: tuple[float, float, float], half: Any = 400.0, dense: float = 1e-3) -> Bodies:
    center = np.array(places, np.float64).reshape(-1, 3)
    sizes = np.broadcast_to(np.asarray(half, np.float64), center.shape)
    return Bodies(center, sizes.copy(), np.full(len(center), dense))


def test_right_behind_a_cloud_it_is_beer_and_lambert_s_law_along_its_chord() -> None:
    low, high = bodies((0.0, 1000.0, 0.0)), bodies((0.0, 4000.0, 0.0), half=(2000.0, 300.0, 900.0))
    sun, sky = taken(low, high, NOON)[0]
    left = math.exp(-STRENGTH * 600.0 * 1e-3)
    assert sun == pytest.approx(SUN * (1.0 - left))
    assert sky == pytest.approx(SKY * (1.0 - left))
    # Along a slanting light the chord is longer, by the ellipsoid.
    slant = np.array([0.6, 0.8, 0.0])
    middle = (0.0 + 3000.0 * 0.75, 4000.0, 0.0)
    chord = 2.0 / math.hypot(0.6 / 2000.0, 0.8 / 300.0)
    found = taken(low, bodies(middle, half=(2000.0, 300.0, 900.0)), slant)[0, 0]
    assert found == pytest.approx(SUN * (1.0 - math.exp(-STRENGTH * chord * 1e-3)))
    # Two of them leave the product.
    both = Bodies(*(np.concatenate([a, a]) for a in high))
    assert taken(low, both, NOON)[0, 0] == pytest.approx(SUN * (1.0 - left * left))


def test_nothing_is_taken_from_beside_below_or_by_what_is_thin() -> None:
    one = bodies((0.0, 1000.0, 0.0))
    for place in ((1500.0, 1000.0, 0.0), (0.0, -2000.0, 0.0), (0.0, 1000.0, 0.0)):
        assert taken(one, bodies(place), NOON)[0] == pytest.approx(0.0, abs=1e-12)
    assert not taken(one, bodies((0.0, 3000.0, 0.0), dense=0.0), NOON).any()
    # Beside the sun's way, but in the sky overhead.
    sun, sky = taken(one, bodies((0.0, 3000.0, 0.0)), np.array([0.8, 0.6, 0.0]))[0]
    assert sun == 0.0
    assert sky > 0.2


def test_a_small_cloud_takes_little_of_a_large_one() -> None:
    large, small = bodies((0.0, 1000.0, 0.0), half=4000.0), bodies((0.0, 6000.0, 0.0))
    as_large = bodies((0.0, 6000.0, 0.0), half=(4000.0, 400.0, 4000.0))
    part, whole = (taken(large, each, NOON)[0, 0] for each in (small, as_large))
    assert part == pytest.approx(0.01 * whole)


def test_clouds_of_one_deck_leave_each_other_their_tops() -> None:
    """However many there are, and however low the sun: what is above counts."""
    rng = np.random.default_rng(5)
    places = np.column_stack([*rng.uniform(-9000.0, 9000.0, (2, 80))])
    heights = rng.uniform(1800.0, 2200.0, 80)
    deck = bodies(*np.column_stack([places[:, 0], heights, places[:, 1]]), half=(3700, 900, 4200))
    for light in (NOON, np.array([0.8, 0.6, 0.0]), np.array([0.995, 0.1, 0.0])):
        assert taken(deck, deck, light).max() < 0.02
    above = deck._replace(center=deck.center + (0.0, 3000.0, 0.0))
    assert taken(deck, above, NOON).min() > 0.5


def test_the_shadow_comes_evenly_and_the_sky_s_is_the_wider() -> None:
    one = bodies((0.0, 1000.0, 0.0))
    x = np.linspace(0.0, 2500.0, 126)
    found = np.array([taken(one, bodies((float(at), 3000.0, 0.0)), NOON)[0] for at in x])
    assert (np.diff(found, axis=0) <= 1e-12).all()
    assert np.abs(np.diff(found[:, 0])).max() < 0.05
    assert not found[-1, 0].any()
    half = [float(x[np.argmax(column < 0.5 * column[0])]) for column in found.T]
    assert half[1] > 1.3 * half[0]


def test_two_shares_fit_into_one_number() -> None:
    rng = np.random.default_rng(3)
    shares = np.concatenate([rng.uniform(size=(200, 2)), [[0.0, 0.0], [1.0, 1.0], [0.0, 1.0]]])
    number = packed(shares).astype(np.float32)
    sun, sky = np.floor(number) / 255.0, np.mod(number, 1.0) / PACKED
    np.testing.assert_allclose(sun, shares[:, 0], atol=0.5 / 255.0 + 1e-6)
    np.testing.assert_allclose(sky, shares[:, 1], atol=2e-4)


def shaded(weather: Weather, frames: int = 1, dt: float = 0.5) -> Array:
    """(n, 2), by the height of the clouds."""
    for _ in range(frames):
        esper.process(dt)
    clouds = weather.frame().clouds
    return np.asarray(clouds["shaded"][np.argsort(clouds["position"][:, 1])], np.float64)


@pytest.fixture
def weather(world: str) -> Any:
    made = Weather(seed=2)
    made._state.drawn = True
    esper.create_entity(Atmosphere("2025-06-21T12:00:00Z", speed=0.0))
    esper.create_entity(Cloud("cumulus", (0.0, 900.0, 0.0), drift=0.0))
    yield made
    made.close()


def test_a_cloud_under_a_deck_is_dark_from_the_first_and_comes_out_of_it(weather: Weather) -> None:
    deck = Cloud("nimbostratus", (0.0, 2600.0, 0.0), drift=0.0)
    esper.create_entity(deck)
    low, high = shaded(weather)
    assert low[0] > 0.6
    assert low[1] > 0.4
    assert not high.any()
    deck.position = (30_000.0, 2600.0, 0.0)
    soon, _ = shaded(weather)
    assert 0.2 * low[0] < soon[0] < low[0]  # not at once
    assert shaded(weather, 30)[0] == pytest.approx(0.0, abs=1e-3)


def test_without_a_picture_nobody_asks(weather: Weather) -> None:
    weather._state.drawn = False
    esper.create_entity(Cloud("nimbostratus", (0.0, 2600.0, 0.0), drift=0.0))
    assert not shaded(weather).any()
