"""The wetness map: against its oracle, as its observer walks; and as a game's shader reads it."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import moderngl
import numpy as np
import pytest

from tests.boxes import box, placed
from tests.rain_frames import area
from tests.wetness_stage import LEVEL, Maps, Point, dry_ground, scene, walk
from weather_ecs.frame import AirData, FrameData, OccluderData, SnowLook
from weather_ecs.gpu.wetness_pass import ROUND
from weather_ecs.physics import wet_map
from weather_ecs.physics.footprint import fall_speed_over
from weather_ecs.physics.snow_cover import melt_rate
from weather_ecs.physics.wetness import FILM, film_capacity, settle_one


def hilly() -> tuple[np.ndarray, np.ndarray]:
    """Ground with hills and hollows, every metre a vertex."""
    at = np.arange(-60.0, 61.0)
    x, z = np.meshgrid(at, at)
    y = 0.8 * np.sin(x / 7.0) * np.cos(z / 5.0) - 0.06 * np.cos(x * 1.3) * np.cos(z * 1.3)
    n = len(at)
    i, j = np.meshgrid(np.arange(n - 1), np.arange(n - 1))
    a = (j * n + i).ravel()
    quads = np.stack([a, a + n, a + 1, a + 1, a + n, a + n + 1], 1)
    vertices = np.stack([x, y, z], -1).reshape(-1, 3).astype(np.float32)
    return vertices, quads.reshape(-1).astype(np.uint32)


GROUND = OccluderData(0, np.eye(4), False, *hilly())

ROOF = box(1, placed((5, 4, 3), (4, 0.1, 3), 0.4, 0.3))


@pytest.fixture
def maps(ctx: moderngl.Context) -> Iterator[Maps]:
    made = Maps(ctx)
    yield made
    made.release()


# Against the oracle


RAIN = AirData()
SLEET = AirData(2.0, 0.8, 1.0, 0.4)
SNOW = AirData(-3.0, 0.9, -3.5, 1.0)


@pytest.mark.parametrize(
    ("wind", "air", "fronts"),
    [
        ((0.0, 0.0, 0.0), RAIN, {}),
        ((5.0, 0.0, -3.0), RAIN, {}),
        ((0.0, 0.0, 0.0), SNOW, {}),
        ((2.0, 0.0, 0.0), SLEET, {}),
        ((0.0, 0.0, 0.0), RAIN, {0: (46.0, 1e9, 0.0, 0.0)}),
        ((5.0, 0.0, -3.0), RAIN, {0: (-1.0, 70.0, 0.0, 0.0)}),
    ],
)
def test_the_map_is_what_its_oracle_says(
    maps: Maps, wind: Point, air: AirData, fronts: Any
) -> None:
    before, old, snowed = None, None, False
    ages = np.zeros(wet_map.BANDS)
    cart = placed((-4, 1.5, 0), (1.5, 0.5, 1.5))
    # A start, some bands, all of them, a walk, a turn of the wind, a stay.
    moments = [(10.0, 0, wind), (10.1, 0, wind), (11.2, 0, wind), (11.3, 4.2, wind)]
    moments += [(11.4, 4.2, (-4.0, 0.0, 2.0)), (12.9, 4.2, (-4.0, 0.0, 2.0))]
    for k, (time, x, now) in enumerate(moments):
        things = GROUND, ROOF, box(2, cart, True)
        flakes = SnowLook(settling=3.0 if wind[0] else 1.0)
        data = scene(time, *things, wind=now, air=air, fronts=fronts, flakes=flakes)
        # In the end all of it thaws.
        if k == len(moments) - 1 and air.snow_share == 1.0:
            data = replace(data, air=AirData(6.0, 0.8, 5.0, 0.0))
        if k:
            before, old = maps.read(), maps.seen.place
            ages = time - np.array(maps.seen.times)
        bands = maps.seen.band if k else 0
        maps.update(data, (x, 1.7, 0.0))
        found, expected = maps.expected(data, before, old, ages)
        got, place = maps.read(), maps.seen.place
        np.testing.assert_allclose(got[..., 1], found.position[..., 1], atol=1e-3)
        fresh = np.ones(place.size, bool)
        if place == old:
            due = -(-place.size // place.rows)
            due = int(np.ceil(due * min((time - moments[k - 1][0]) / ROUND, 1.0) - 1e-9))
            turns = (bands + np.arange(due)) % -(-place.size // place.rows)
            fresh = np.isin(np.arange(place.size) // place.rows, turns)
            np.testing.assert_array_equal(got[~fresh], before[~fresh])
        away = np.abs(got[..., [0, 2]] - expected)[fresh]
        # A texel whose point falls on the line between two of the map before may take either.
        assert np.mean(away > 1e-4 + 1e-3 * expected[fresh]) < 0.01, k
        assert np.median(away) < 1e-5
        snowed = snowed or bool(got[..., 2].max() > 0.001)
    assert expected[..., 0].max() > (0.005 if air.snow_share == 1.0 else 0.01)
    assert snowed == (air.snow_share > 0.0)
    assert (expected[found.known] == 0.0).any()


def test_hollows_gather_and_slopes_shed() -> None:
    footprint = wet_map.Footprint((0.0, 0.0), 16.0, (0.0, 0.0), -80.0, 120.0)
    place = wet_map.place_over(footprint, 64)
    pit = np.full((64, 64), 0.5)
    pit[30:34, 30:34] += 0.03 / 200.0
    found = wet_map.surface(place, footprint, pit, pit)
    middle = found.gathers[14:16, 14:16]
    assert (middle > 5.0).all() and found.gathers[3, 3] == 1.0
    assert found.capacity[15, 15] == pytest.approx(FILM + 30.0, abs=0.1)
    # A plane that rises by 0.8 a metre sheds, and is no hollow anywhere.
    close = wet_map.Footprint((0.0, 0.0), 4.0, (0.0, 0.0), -80.0, 120.0)
    plane = np.repeat(0.5 + 0.8 * 0.125 / 200.0 * np.arange(64.0)[:, None], 64, axis=1)
    steep = wet_map.surface(wet_map.place_over(close, 64), close, plane, plane)
    up = 1.0 / np.hypot(1.0, 0.8)
    held = steep.capacity[8:-8, 8:-8]
    np.testing.assert_allclose(held, film_capacity(up), rtol=0.05)
    np.testing.assert_allclose(steep.facing[8:-8, 8:-8], up, rtol=0.02)
    assert (steep.gathers[8:-8, 8:-8] == 1.0).all()
    assert (found.exposed == 1.0).all()
    assert (wet_map.surface(place, footprint, pit, pit - 1.0 / 200.0).exposed == 0.0).all()
    rail = np.full((64, 64), 0.5)
    rail[:, 20] -= 1.0 / 200.0
    railed = wet_map.surface(place, footprint, rail, rail)
    assert np.ptp(railed.position[..., 1]) < 1e-9  # the ground shows beside the rail
    assert sorted(set(railed.exposed.ravel())) == [0.5, 1.0]
    assert not wet_map.surface(place, footprint, np.ones((64, 64)), pit).known.any()


def test_level_ground_in_the_open_is_as_wet_as_samples_say(maps: Maps) -> None:
    for rate in (2.0, 25.0):
        rows = [area(0, (0, 0), (80, 80), rate)]
        number = int(rate)

        def data(time: float, rows: Any = rows, number: int = number) -> FrameData:
            return scene(time, LEVEL, rows=rows, wetness=dry_ground(time, number))

        walk(maps, 60.0, data)
        expected = settle_one(0.0, rate / 3600.0, FILM, 60.0)
        for point in ((3.0, 0.0, 4.0), (-12.0, 0.0, 9.0)):
            assert maps.at(*point) == pytest.approx(expected, rel=0.05)


def test_dry_under_a_roof_wet_upon_it_and_dry_where_it_does_not_rain(maps: Maps) -> None:
    roof = box(1, placed((5, 4, 3), (4, 0.1, 3)))
    walk(maps, 30.0, lambda t: scene(t, LEVEL, roof))
    read, place = maps.read(), maps.seen.place
    expected = settle_one(0.0, 40.0 / 3600.0, FILM, 30.0)
    assert maps.at(5.0, 4.1, 3.0) == pytest.approx(expected, rel=0.1)  # the roof's top
    assert maps.at(5.0, 0.0, 8.5) == pytest.approx(expected, rel=0.1)
    assert maps.at(-17.5, 0.0, 0.0) == 0.0
    assert read.shape == (place.size, place.size, 3)


@pytest.mark.parametrize("wind", [(0.0, 0.0, 0.0), (3.0, 0.0, -2.0)])
def test_lamps_and_poles_leave_no_dry_stain(maps: Maps, wind: Point) -> None:
    pole = box(5, placed((5, 1.5, 0), (0.1, 1.5, 0.1)))
    head = box(6, placed((5, 3.2, 0), (0.3, 0.2, 0.3)))
    walk(maps, 20.0, lambda t: scene(t, LEVEL, pole, head, wind=wind))
    open_ground = maps.at(3.0, 0.0, 6.0)
    assert open_ground > 0.1
    # Where the head's shadow lies, and along the upper half of the pole's.
    slope = np.array([wind[0], wind[2]]) / fall_speed_over(np.array([40.0]))
    for high, aside in ((3.2, 0.0), (3.2, 0.3), (2.6, 0.0), (2.0, 0.0)):
        x, z = np.array([5.0 + aside, 0.0]) + high * slope
        assert maps.at(x, 0.0, z) > 0.7 * open_ground, (high, aside)


def test_a_wall_keeps_the_rain_off_behind_it(maps: Maps) -> None:
    wall = box(7, placed((5, 1.5, 0), (0.1, 1.5, 6.0)))
    walk(maps, 20.0, lambda t: scene(t, LEVEL, wall, wind=(8.0, 0.0, 0.0)))
    # Rain meets the wall there and not the ground.
    assert maps.at(7.0, 0.0, 0.0, what=1) > 1.0
    assert abs(maps.at(11.0, 0.0, 0.0, what=1)) < 0.1 < maps.at(11.0, 0.0, 0.0)


def test_snow_lies_on_roof_and_ground_melts_and_wets_them(maps: Maps) -> None:
    roof = box(1, placed((5, 4, 3), (4, 0.1, 3)))
    walk(maps, 30.0, lambda t: scene(t, LEVEL, roof, air=SNOW))
    fallen = 40.0 / 3600.0 * 30.0
    for point in ((5.0, 4.1, 3.0), (5.0, 0.0, 8.5)):
        assert maps.at(*point, 2) == pytest.approx(fallen, rel=0.1)
        assert maps.at(*point) == 0.0
    read = maps.read()
    under = np.abs(read[..., 1]) < 0.5
    assert read[under][:, 2].max() == pytest.approx(fallen, rel=0.1)
    dry = [area(0, (8.0, 0.0), (25.0, 20.0), 0.0)]
    thaw = AirData(8.0, 0.9, 7.0, 0.0)
    rate = float(melt_rate(thaw.wet_bulb))
    walk(maps, 10.0, lambda t: scene(t, LEVEL, roof, rows=dry, air=thaw), start=30.0)
    assert maps.at(5.0, 4.1, 3.0, 2) == pytest.approx(fallen - 10.0 * rate, rel=0.15)
    assert maps.at(5.0, 4.1, 3.0) == pytest.approx(10.0 * rate, rel=0.15)
