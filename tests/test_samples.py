"""`weather.samples`: at every point what `weather.sample` says of it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import Any

import esper
import numpy as np
import pytest
from numpy.typing import NDArray

from tests.boxes import CORNERS, TRIANGLES, placed
from tests.shelter_shapes import hills
from weather_ecs import Samples, Weather
from weather_ecs.components import Air, Fog, Occluder, PointLight, RainArea, SnowFlakes, Wind
from weather_ecs.errors import ClosedError, InvalidValueError
from weather_ecs.frame import LIGHT_DTYPE
from weather_ecs.physics.lamps import Lamps
from weather_ecs.sampling import Sample
from weather_ecs.systems.box_grid import FINEST, BoxGrid

pytestmark = pytest.mark.usefixtures("world")


@pytest.fixture
def weather() -> Iterator[Weather]:
    with Weather(seed=3) as it:
        yield it


def points(count: int, seed: int = 0) -> NDArray[np.float64]:
    """Over the village and far beyond it, on the ground and high up, some twice."""
    rng = np.random.default_rng(seed)
    near = rng.uniform((-45, -3, -45), (45, 14, 45), (count * 3 // 4, 3))
    far = rng.normal(0.0, (400.0, 500.0, 400.0), (count - len(near), 3))
    return np.concatenate([near, far, near[:3]])


def village(dynamic: int = 5) -> list[Occluder]:
    """Boxes, walls, an uneven ground, and things that move."""
    rng = np.random.default_rng(1)
    things = [Occluder(*hills(10, 90.0), placed((0, -1.0, 0), (1, 1, 1)))]
    for k in range(40):
        center = (rng.uniform(-40, 40), rng.uniform(-1, 10), rng.uniform(-40, 40))
        size = tuple(rng.uniform(0.1, 6.0, 3).tolist())
        transform = placed(center, size, rng.uniform(-3, 3), rng.uniform(-0.6, 0.6))
        things.append(Occluder(CORNERS, TRIANGLES, transform, dynamic=k < dynamic))
    return things


def lamps(count: int) -> list[PointLight]:
    rng = np.random.default_rng(2)
    where = rng.uniform((-45, 0, -45), (45, 6, 45), (count, 3)).tolist()
    return [PointLight(place, (1.0, 0.6, 0.3), 4.0 + k) for k, place in enumerate(where)]


def agree(weather: Weather, at: NDArray[np.float64]) -> Samples:
    """The samples, which are those that are taken one by one."""
    got = weather.samples(at)
    assert got._fields == Sample._fields
    single = [weather.sample(tuple(point)) for point in at.tolist()]
    for name, many in zip(got._fields, got, strict=True):
        each = np.array([getattr(sample, name) for sample in single])
        assert many.dtype == each.dtype and many.shape == each.shape, name
        if name == "sheltered":
            np.testing.assert_array_equal(many, each)
        else:
            np.testing.assert_allclose(many, each, rtol=1e-9, atol=1e-12, err_msg=name)
    return got


WORLDS: dict[str, list[Any]] = {
    "calm": [],
    "wind": [Wind((1, 0.4), 9.0, exponent=0.2, ground=-1.0), Fog(visibility=900.0)],
    "gusts": [Wind((0, -1), 6.0, gustiness=0.6, interval=3.0, exponent=0.14)],
    "sleet": [Air(temperature=1.4, humidity=0.9)],
    "snow": [Air(temperature=-6.0, humidity=0.7), SnowFlakes(), Wind((1, 0), 1.5)],
    "thaw": [Air(temperature=2.0, humidity=0.5), SnowFlakes()],
}


@pytest.mark.parametrize("name", list(WORLDS))
def test_samples_are_the_samples_one_by_one(weather: Weather, name: str) -> None:
    moving = RainArea((20, 5), (50, 30), 9.0, heading=0.7, ceiling=250.0, velocity=(2.0, -1.0))
    still = RainArea((-10, 0), (80, 60), 40.0, soft_edge=25.0)
    small = RainArea((5, -30), (6, 4), 60.0, heading=-1.0, soft_edge=0.0)
    dry = RainArea((0, 0), (500, 500), 0.0)
    for component in (moving, still, small, dry, *WORLDS[name], *village(), *lamps(12)):
        esper.create_entity(component)
    for _ in range(9):
        esper.process(7.77)
    esper.process(0.013)
    got = agree(weather, points(1200))
    assert 0.05 < got.sheltered.mean() < 0.9
    assert (got.rain_rate > 0.0).any() or (got.snow_rate > 0.0).any()
    assert (got.wetness > 0.0).any() or (got.snow_depth > 0.0).any()
    assert len(np.unique(got.light.round(6))) > 50
    # A shower ends: its last drops still fall, what fell dries, and things have moved.
    still.rain_rate = 0.0
    thing = next(c for _, c in esper.get_component(Occluder) if c.dynamic)
    thing.transform = placed((3, 6, 3), (9, 0.2, 9), 0.4)
    esper.process(1.5)
    agree(weather, points(700, 1))
    small.rain_rate = moving.rain_rate = 0.0
    weather.strike(target=(30, 0, 10))
    esper.process(0.05)
    lit = agree(weather, points(300, 2))
    assert (lit.light > got.light.min()).all()
    for _ in range(20):
        esper.process(9.0)  # the tiles come to rest
    agree(weather, points(500, 3))


def test_samples_within_a_roof_s_edge_and_after_it_has_moved(weather: Weather) -> None:
    esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
    cover = Occluder(CORNERS, TRIANGLES, placed((0, 3, 0), (3, 0.05, 2)), dynamic=True)
    esper.create_entity(cover)
    at = np.stack([np.linspace(-4, 4, 161), np.full(161, 1.0), np.zeros(161)], axis=1)
    for shift in (0.0, 0.5, -20.0):
        cover.transform = placed((shift, 3, 0), (3, 0.05, 2))
        esper.process(0.25)
        expected = np.abs(at[:, 0] - shift) < 3.0
        clear = np.abs(np.abs(at[:, 0] - shift) - 3.0) > 1e-6
        got = weather.samples(at)
        np.testing.assert_array_equal(got.sheltered[clear], expected[clear])
        np.testing.assert_array_equal(got.rain_rate == 0.0, got.sheltered)


def test_samples_in_clear_air_and_of_no_points(weather: Weather) -> None:
    got = agree(weather, np.array([(1.0, 2.0, 3.0), (0.0, 0.0, 0.0)]))
    assert got.wind.shape == (2, 3) and not got.sheltered.any()
    for none in (np.zeros((0, 3)), [], np.zeros((0, 3), int)):
        empty = weather.samples(none)
        assert [each.shape for each in empty] == [
            (0, 3) if name == "wind" else (0,) for name in empty._fields
        ]
    esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
    for thing in (*village(), *lamps(2)):
        esper.create_entity(thing)
    esper.process(3.0)
    assert weather.samples([]).rain_rate.shape == (0,)


def test_any_numbers_will_do_and_are_left_alone(weather: Weather) -> None:
    esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
    for given in ([(0, 1, 0), (100, 1, 0)], np.array([(0, 1, 0), (100, 1, 0)], np.float32)):
        before = np.array(given)
        assert weather.samples(given).rain_rate.tolist() == [25.0, 0.0]
        np.testing.assert_array_equal(np.array(given), before)
    turned = np.array([(0, 100), (1, 1), (0, 0)], float).T
    turned.setflags(write=False)
    assert weather.samples(turned).rain_rate.tolist() == [25.0, 0.0]


@pytest.mark.parametrize(
    "positions",
    [
        (1.0, 2.0, 3.0),
        [(1.0, 2.0)],
        [(1.0, 2.0, 3.0), (1.0, 2.0)],
        np.zeros((2, 3, 1)),
        np.zeros((3, 0)),
        [(0.0, math.nan, 0.0)],
        [(0.0, 0.0, 0.0), (math.inf, 0.0, 0.0)],
        [(0.0, 0.0, 1e9)],
        [("1", "2", "3")],
        [(True, False, True)],
        [(1j, 0, 0)],
        [(10**400, 0, 0)],
        [None],
        None,
        "abc",
    ],
)
def test_bad_positions(weather: Weather, positions: Any) -> None:
    with pytest.raises(InvalidValueError, match="positions"):
        weather.samples(positions)


def test_asking_changes_nothing(weather: Weather) -> None:
    for component in (RainArea((0, 0), (60, 40), 25.0, velocity=(1, 2)), *village()):
        esper.create_entity(component)
    esper.process(3.3)
    before = weather.snapshot()
    weather.samples(points(50))
    assert weather.snapshot() == before
    weather.close()
    with pytest.raises(ClosedError):
        weather.samples(points(1))


# The parts


def test_lamps_that_reach_a_point_are_found_by_its_cell() -> None:
    rng = np.random.default_rng(0)
    rows = np.zeros(60, LIGHT_DTYPE)
    rows["position"] = rng.uniform(-60, 60, (60, 3)) * (1, 0.1, 1)
    rows["reach"] = 10.0 ** rng.uniform(-1, 2, 60)
    light = rng.uniform(0.1, 3, 60)
    pairs = zip(rows["position"].tolist(), rows["reach"].tolist(), light.tolist(), strict=True)
    known = Lamps([(x, y, z, reach, one) for (x, y, z), reach, one in pairs])
    at = rng.uniform(-70, 70, (600, 3)) * (1, 0.1, 1)
    away2 = np.square(at[:, None] - rows["position"]).sum(axis=2) / rows["reach"] ** 2
    expected = (np.square(np.maximum(1.0 - away2, 0.0)) * light).sum(axis=1)
    np.testing.assert_allclose(known.many(*at.T), expected, rtol=1e-9, atol=1e-14)
    np.testing.assert_allclose([known.at(*p) for p in at.tolist()], expected, rtol=1e-9, atol=1e-14)


def test_boxes_are_found_by_place() -> None:
    rng = np.random.default_rng(0)
    low = rng.uniform(-300, 300, (400, 2))
    high = low + 10.0 ** rng.uniform(-1, 2.5, (400, 2))
    top = rng.uniform(-5, 20, 400)
    grid = BoxGrid(low, high, top)
    at, level = rng.uniform(-320, 320, (500, 2)), rng.uniform(-6, 18, 500)
    over = (low <= at[:, None]).all(axis=2) & (at[:, None] <= high).all(axis=2)
    over &= top > level[:, None]
    found = np.zeros_like(over)
    for box, places in grid.pairs(at[:, 0], at[:, 1], level):
        assert len(places) and not found[places, box].any()
        found[places, box] = True
    np.testing.assert_array_equal(found, over)
    for (u, w), expected in zip(at.tolist(), over, strict=True):
        near = grid.near((math.floor(u / FINEST), math.floor(w / FINEST)))
        assert {box[5] for box in near} >= set(np.flatnonzero(expected).tolist())
        assert [box[0] for box in near] == sorted((box[0] for box in near), reverse=True)
    assert BoxGrid(low[:0], high[:0], top[:0]).pairs(at[:, 0], at[:, 1], level) == []
