"""The parts of the wet ground: stretches of areas, shares of cells, tiles at rest."""

from __future__ import annotations

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from weather_ecs.errors import InvalidValueError
from weather_ecs.frame import AREA_DTYPE
from weather_ecs.physics.ground_law import SnowLaw
from weather_ecs.physics.rain_field import area_shares
from weather_ecs.physics.wetness import DRYING, FILM, MM_PER_S
from weather_ecs.systems import wet_codes, wet_path, wet_rest, wet_shares
from weather_ecs.systems.wet_rest import FINENESS, TRACE, Resting
from weather_ecs.systems.wet_shares import Patterns, Shape
from weather_ecs.systems.wet_tiles import MOST_TILES, WetTiles, level_of

CELL = 2.0


def rows(x: float = 0.0, z: float = 0.0, rate: float = 10.0, radius: float = 20.0) -> np.ndarray:
    """One raining area."""
    return np.array([(1, (x, z), (radius, radius), 0.0, rate, 5.0, 400.0)], AREA_DTYPE)


# Stretches


def test_an_area_that_stands_is_one_stretch_however_its_row_is_made():
    stretch = wet_path.begin(rows(), rows(), CELL)
    assert stretch.still and stretch.goes_on(rows(), CELL) and stretch.ticks == 2
    assert not stretch.goes_on(rows(rate=10.5), CELL)
    assert not stretch.goes_on(rows(x=0.01), CELL)
    assert not stretch.goes_on(rows()[:0], CELL)
    assert stretch.ticks == 2 and stretch.still


def test_an_area_on_its_way_goes_on_while_it_keeps_its_course():
    stretch = wet_path.begin(rows(x=3.0), rows(), CELL)
    assert not stretch.still and stretch.goes_on(rows(x=6.0), CELL)
    assert stretch.goes_on(rows(x=9.0, z=0.9 * wet_path.NEAR * CELL), CELL)
    assert stretch.ticks == 3 and stretch.first["center"].tolist() == [[0.0, 0.0]]
    for other in (
        rows(x=12.0, z=3.0),  # it turns
        rows(x=9.0),  # it stands
        rows(x=12.0, rate=11.0),  # it rains harder
        rows(x=12.0, radius=21.0),  # it grows
    ):
        assert not stretch.goes_on(other, CELL)
    assert stretch.ticks == 3


def test_a_leap_another_area_and_a_jump_of_the_rate_begin_anew():
    assert wet_path.begin(rows(x=1.01 * wet_path.JUMP * CELL), rows(), CELL).still
    assert wet_path.begin(rows(x=1.0, radius=30.0), rows(), CELL).still
    assert wet_path.begin(rows(rate=20.0), rows(), CELL).still
    assert wet_path.begin(rows(), rows()[:0], CELL).still
    moves = wet_path.begin(rows(x=1.0, rate=20.0), rows(), CELL)
    assert not moves.still and moves.first["rain_rate"] == 20.0  # the new rate all the way
    ramp = wet_path.begin(rows(rate=10.5), rows(), CELL)
    assert not ramp.still and ramp.first["rain_rate"] == 10.0


# Shares


def cells(fallen: wet_shares.Fallen) -> dict[tuple[int, int], float]:
    """Amounts by cell."""
    found = {}
    for (i, j), amounts in zip(fallen.places, fallen.amounts, strict=True):
        for z, x in zip(*np.nonzero(amounts), strict=True):
            found[8 * i + int(x), 8 * j + int(z)] = float(amounts[z, x])
    return found


def test_a_standing_area_gives_every_cell_its_share():
    shape = Shape((13.0, 7.0), 0.6, 3.0)
    found = cells(Patterns(CELL).standing((-5.0, 40.0), shape))
    for (i, j), share in found.items():
        x, z = (i + 0.5) * CELL, (j + 0.5) * CELL
        law = area_shares(np.array([x]), np.array([z]), (-5.0, 40.0), *shape)
        assert share == pytest.approx(float(law.reshape(-1)[0]))
    assert sum(found.values()) * CELL**2 == pytest.approx(math.pi * 13.0 * 7.0, rel=0.35)


@given(
    st.lists(st.tuples(st.floats(-90, 90), st.floats(-90, 90)), min_size=1, max_size=6),
    st.lists(st.floats(0.1, 5.0), min_size=6, max_size=6),
)
def test_a_way_wets_as_much_as_its_moments_and_where_they_are(points, weights):
    patterns, shape = Patterns(CELL), Shape((9.0, 6.0), 0.3, 2.0)
    weights = weights[: len(points)]
    found = cells(patterns.swept(shape, np.array(points), np.array(weights)))
    one = sum(cells(patterns.swept(shape, np.array([(1.0, 1.0)]), np.ones(1))).values())
    assert sum(found.values()) == pytest.approx(one * sum(weights), rel=1e-9)
    x = sum((i + 0.5) * CELL * v for (i, _), v in found.items()) / sum(found.values())
    assert x == pytest.approx(np.average([p[0] for p in points], weights=weights), abs=1e-6)


def test_moments_follow_the_way_and_are_bounded():
    assert wet_shares.moments(0.0, CELL, 5.0) == 1
    assert wet_shares.moments(10.0, CELL, 0.0) == 5
    assert wet_shares.moments(10.0, CELL, 20.0) == 2
    assert wet_shares.moments(1e9, CELL, 0.0) == wet_shares.MOST_MOMENTS


# At rest


def test_a_tile_at_rest_dries_by_the_law_and_is_there_to_a_percent():
    resting, water = Resting(), np.full((1, 8, 8), 0.6 * FILM)
    resting.put([(3, -2)], water)
    for seconds in (0.0, 40.0, 200.0):
        resting.pass_time(seconds, 10)
        left = 0.6 * FILM * math.exp(-resting.now / DRYING)
        assert resting.tile((3, -2))[6, 5] == pytest.approx(left, rel=0.51 * FINENESS)
        assert resting.water() == pytest.approx(left, rel=0.51 * FINENESS)
    assert resting.tile((0, 0))[6, 5] == 0.0
    taken = resting.take((3, -2))
    assert taken is not None and resting.take((3, -2)) is None and not resting.tiles
    assert taken[0, 0] == pytest.approx(0.6 * FILM * math.exp(-240.0 / DRYING), rel=0.02)


def test_what_is_dry_goes_and_of_too_many_those_that_dry_first():
    resting = Resting()
    amounts = TRACE * np.exp(np.arange(1.0, 5.0))
    resting.put([(k, 0) for k in range(4)], np.ones((4, 8, 8)) * amounts[:, None, None])
    resting.put([(9, 9)], np.full((1, 8, 8), 0.5 * TRACE))
    assert sorted(resting.tiles) == [(0, 0), (1, 0), (2, 0), (3, 0)]  # a trace is dry
    resting.pass_time(0.0, 3)
    assert sorted(resting.tiles) == [(1, 0), (2, 0), (3, 0)]
    resting.pass_time(2.5 * DRYING, 3)
    assert sorted(resting.tiles) == [(2, 0), (3, 0)]


PLACES = st.tuples(st.integers(-(2**20), 2**20), st.integers(-(2**20), 2**20))


@given(st.sets(PLACES, max_size=12), st.integers(0, 2**32 - 1), st.integers(0, 300))
def test_tiles_at_rest_come_back_out_of_their_state(places, seed, age):
    resting, rng = Resting(), np.random.default_rng(seed)
    resting.put(sorted(places), rng.uniform(0.2, 1.0, (len(places), 8, 8)) * FILM)
    resting.pass_time(float(age), 100)
    state = resting.state()
    again = Resting.from_state(state, 100)
    assert again.state() == state and sorted(again.tiles) == sorted(resting.tiles)
    for place in resting.tiles:
        assert again.tile(place)[2, 1] == pytest.approx(resting.tile(place)[2, 1], rel=1e-12)


# What compresses


NEAR = st.tuples(st.integers(-2, 2), st.integers(-2, 2))


@given(st.sets(NEAR, max_size=12), st.integers(0, 2**32 - 1), st.sampled_from([1, 2, 3]))
def test_what_neighbours_do_not_tell_comes_back(places, seed, planes):
    order, top = sorted(places), 256**planes
    codes = np.random.default_rng(seed).integers(0, top, (len(order), 8, 8)).astype(np.uint32)
    raw = np.frombuffer(wet_codes.surprises(order, codes, planes), np.uint8)
    assert len(raw) == 64 * planes * len(order)
    assert np.array_equal(wet_codes.expected(order, raw, planes), codes)


def test_where_neighbours_tell_all_there_is_little_to_keep():
    order = [(0, 0), (0, 1), (1, 0), (1, 1), (3, 0)]
    flat = np.full((5, 8, 8), 700, np.uint32)
    values = np.frombuffer(wet_codes.surprises(order, flat, 2), np.uint8).reshape(2, 5, 64)
    assert [np.count_nonzero(tile.any(axis=0)) for tile in values.swapaxes(0, 1)] == [1, 0, 0, 0, 1]
    i, j = np.meshgrid(np.arange(8), np.arange(8))
    slope = np.stack([300 + 5 * (8 * a + i) + 3 * (8 * b + j) for a, b in order[:4]])
    raw = wet_codes.surprises(order[:4], slope.astype(np.uint32), 2)
    values = np.frombuffer(raw, np.uint8).reshape(2, 4, 8, 8)
    assert not values[:, 3].any() and not values[:, :, 1:, 1:].any()


@given(st.sets(PLACES, max_size=20))
def test_places_come_back(places):
    order = sorted(places)
    assert wet_rest.unpacked("places", wet_rest.packed(order), 20) == order


@pytest.mark.parametrize("value", ["0g", "0", None, 5, "00" * 3])
def test_other_bytes_than_expected_are_refused(value):
    with pytest.raises(InvalidValueError, match=r"wetness\.codes"):
        wet_rest.raw_bytes(value, 2)


# Tiles


@pytest.mark.parametrize(
    ("radii", "level"), [((16.0, 16.0), 1), ((1.0, 1.0), -2), ((9e5, 9e5), 17)]
)
def test_cells_are_as_wide_as_the_area_asks(radii, level):
    assert level_of(*radii) == level
    assert 8.0 * math.pi <= math.pi * radii[0] * radii[1] / 4.0**level or level == -2


def test_tiles_that_it_does_not_rain_on_go_to_rest_and_are_taken_up_again():
    tiles = WetTiles(1)
    tiles.rain(rows(rate=6.0))
    tiles.settle(60.0)
    wet = tiles.at(0.0, 0.0)
    law = tiles.law.settle_one(0.0, 6.0 * MM_PER_S, 60.0)
    assert wet == pytest.approx(law, rel=1e-3) and not tiles._resting.tiles
    tiles.settle(1.0)
    assert not tiles._places and len(tiles) == len(tiles._resting.tiles) > 0
    assert tiles.at(0.0, 0.0) == pytest.approx(wet, rel=0.03)
    tiles.rain(rows(rate=6.0))
    tiles.settle(60.0)
    assert not tiles._resting.tiles
    law = tiles.law.settle_one(law, 6.0 * MM_PER_S, 60.0)
    assert tiles.at(0.0, 0.0) == pytest.approx(law, rel=0.03)


def test_a_copy_is_another_one_and_snow_does_not_rest():
    tiles = WetTiles(1, SnowLaw(0.0))
    tiles.rain(rows(rate=6.0))
    tiles.settle(60.0)
    other = tiles.copy()
    assert other.state() == tiles.state()
    other.rain(rows(rate=60.0))
    other.settle(60.0)
    assert other.at(0.0, 0.0) > 5.0 * tiles.at(0.0, 0.0)
    tiles.settle(1.0)
    assert not tiles._resting.tiles and 0 < len(tiles) <= MOST_TILES


@pytest.mark.parametrize("level", [-1, 0, 2])
def test_places_lie_between_the_cells_of_now(level):
    tiles, rng = WetTiles(level), np.random.default_rng(level + 1)
    x, z = rng.uniform(-30.0, 30.0, (2, 300))
    # Two rains, then none: the first tiles dry, rest and go while the others are still wet.
    for seconds, area in (
        (60.0, rows(-6, 3)),
        (60.0, rows(9, -9, 40.0)),
        (90.0, None),
        (200.0, None),
    ):
        if isinstance(area, np.ndarray):
            tiles.rain(area)
        tiles.settle(seconds)
        cell, places, water = tiles.arrays()
        known = dict(zip(map(tuple, places.tolist()), water, strict=True))
        dry = np.zeros((8, 8))

        def of(i, j, known=known, dry=dry):
            return known.get((i >> 3, j >> 3), dry)[j & 7, i & 7]

        expected = []
        for u, w in zip(x / cell - 0.5, z / cell - 0.5, strict=True):
            i, j = math.floor(u), math.floor(w)
            low = of(i, j) * (1 - u + i) + of(i + 1, j) * (u - i)
            high = of(i, j + 1) * (1 - u + i) + of(i + 1, j + 1) * (u - i)
            expected.append(low * (1 - w + j) + high * (w - j))
        pairs = zip(x.tolist(), z.tolist(), strict=True)
        np.testing.assert_allclose([tiles.at(*p) for p in pairs], expected, rtol=1e-5)
        np.testing.assert_allclose(tiles.many(x, z), expected, rtol=1e-5)
        assert max(expected) > 0.0
