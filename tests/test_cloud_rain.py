"""Rain areas that clouds carry."""

from __future__ import annotations

import math

import esper
import numpy as np
import pytest

from tests.cloud_worlds import drawn, layer, model, places, record, seconds, sky
from weather_ecs import Weather
from weather_ecs.components import Climate, Cloud, RainArea, Sky, Wind
from weather_ecs.systems.cloud_rain import MOST, SHRINK, foot_of

pytestmark = pytest.mark.usefixtures("world")


def areas() -> list[RainArea]:
    return [area for _, area in sorted(esper.get_component(RainArea))]


def raining(count: int, rate: float = 12.0, state: float = 0.0, **fields) -> Sky:
    return Sky(state, (model("rainy", rain_rate=rate, **fields),), generated=2, count=count)


WIDE = {"size": (20_000.0, 20_000.0), "velocity": (10.0, 4.0), "base": 900.0}


def test_clouds_that_rain_carry_areas_with_them():
    weather = Weather(seed=3)
    esper.create_entity(layer((raining(8),), **WIDE))
    esper.create_entity(layer((sky(0.0, 9, "dry"),), **WIDE))
    esper.process(1.0)
    of = record(weather)
    assert len(areas()) == 8
    for area, place in zip(areas(), places(of), strict=True):
        assert area.center == pytest.approx(place, abs=200.0)
        assert area.ceiling == 900.0
        assert area.velocity == (10.0, 4.0)
        assert 40.0 < area.radii[1] <= area.radii[0] < 500.0
        assert 0.0 <= area.rain_rate <= 12.0
    assert max(area.rain_rate for area in areas()) == 12.0
    before = [area.center for area in areas()]
    entities = sorted(entity for entity, _ in esper.get_component(RainArea))
    seconds(7.3, 0.1)
    esper.process(0.05)
    assert sorted(entity for entity, _ in esper.get_component(RainArea)) == entities
    for area, (x, z) in zip(areas(), before, strict=True):
        assert area.center == pytest.approx((x + 73.5, z + 29.4), abs=0.6)


def test_the_area_moves_exactly_as_its_cloud_does():
    weather = Weather()
    esper.create_entity(Wind((0, 1), 5.0))
    esper.create_entity(layer((raining(1),), size=(9000.0, 9000.0), velocity=(3.0, 0.0)))
    esper.process(1.0)
    offset = None
    for _ in range(100):
        esper.process(0.05)
        [row] = drawn(weather).clouds
        [area] = areas()
        apart = area.center[0] - row["position"][0], area.center[1] - row["position"][2]
        offset = apart if offset is None else offset
        assert apart == pytest.approx(offset, abs=1e-6)


def test_it_rains_there_and_the_sample_says_so():
    weather = Weather(seed=1)
    esper.create_entity(layer((raining(3),), size=(9000.0, 9000.0), velocity=(0.0, 0.0)))
    esper.process(1.0)
    area = max(areas(), key=lambda area: area.rain_rate)
    x, z = area.center
    assert weather.sample((x, 0.0, z)).rain_rate == pytest.approx(area.rain_rate)
    assert weather.sample((x, 1500.0, z)).rain_rate == 0.0  # above the cloud's base


def test_the_foot_is_what_reaches_into_the_lower_part_of_the_shape():
    weather = Weather()
    made = weather._state.cloud_shapes.get(model("m"), 0).made
    foot = foot_of(made)
    low = made.centers[:, 1] - 0.5 * made.sizes[:, 1] <= -made.half[1] + 0.5 * made.half[1]
    assert 1 <= low.sum() <= len(low)
    edges = made.centers[low, 0] + 0.5 * made.sizes[low, 0]
    assert foot.x + foot.half_x == pytest.approx(edges.max(), abs=0.11)
    assert foot.half_z <= made.half[2] + 0.1


def test_the_rate_follows_the_climate_and_the_clouds_growth():
    weather = Weather(seed=2)
    climate = Climate(initial=1.0, final=0.0, duration=100.0, running=False)
    esper.create_entity(climate)
    skies = (Sky(0.0), raining(5, 20.0, state=0.8))
    esper.create_entity(layer(skies, size=(1e5, 1e5), velocity=(0.5, 0.0)))
    seconds(2.0)
    full = max(area.rain_rate for area in areas())
    assert full == 20.0
    climate.elapsed = 60.0  # the state is 0.4, half way to the clouds' own sky
    seconds(2.0)
    assert max(area.rain_rate for area in areas()) == pytest.approx(10.0)
    weather.close()


def test_a_cloud_that_dissolves_ceases_to_rain_and_its_area_goes():
    weather = Weather(seed=2)
    climate = Climate(initial=1.0, final=0.0, duration=1e-9, running=False)
    esper.create_entity(climate)
    skies = (Sky(0.0), raining(4, 20.0, state=1.0))
    sky_layer = layer(skies, size=(9e4, 9e4), velocity=(0.0, 0.0), turnover=40.0)
    esper.create_entity(sky_layer)
    esper.process(1.0)
    assert len(areas()) == 4
    climate.initial, climate.final = 0.9, 0.9
    sky_layer.skies[1].count = 1
    seen = set()
    for _ in range(60):
        esper.process(1.0)
        seen |= {area.rain_rate for area in areas()}
    assert len(areas()) == len(record(weather).array) <= 4
    assert len({rate for rate in seen if 0.0 < rate < 18.0}) > 5


def test_under_a_closed_sky_it_does_not_rain_twice():
    weather = Weather(seed=5)
    esper.create_entity(layer((raining(30, 6.0),), size=(1200.0, 1200.0), velocity=(0.0, 0.0)))
    esper.process(1.0)
    covered = sum(math.pi * area.radii[0] * area.radii[1] for area in areas())
    assert covered == pytest.approx(0.9 * 1200.0**2, rel=1e-3)
    assert max(area.rain_rate for area in areas()) == 6.0
    for area in areas():
        assert 20.0 < area.radii[1] <= area.radii[0]
        assert area.soft_edge < area.radii[1]
    grid = np.linspace(-450.0, 450.0, 12)
    rates = [weather.sample((x, 0.0, z)).rain_rate for x in grid for z in grid]
    assert 1.5 < np.mean(rates) < 6.5


def test_of_very_many_clouds_the_oldest_rain():
    weather = Weather()
    esper.create_entity(layer((raining(100),), **WIDE))
    esper.create_entity(Cloud(model("rainy", rain_rate=5.0), (0, 700, 0)))
    seconds(3.0)
    assert len(areas()) == MOST
    assert sorted(serial for _, serial in weather._state.clouds.rain) == list(range(MOST))


def test_rain_leaves_with_its_cloud_and_nothing_is_left():
    weather = Weather(seed=7)
    entity = esper.create_entity(layer((raining(10),)))  # crossed in 100 s
    here = set()
    for _ in range(250):
        esper.process(1.0)
        assert len(areas()) == 10
        here |= set(weather._state.clouds.rain)
    assert len(here) > 25
    assert min(area.rain_rate for area in areas()) < 12.0  # at the edge it is less
    esper.delete_entity(entity)
    seconds(2.0)
    assert areas() == []
    assert weather._state.clouds.rain == {}
    assert weather._state.uids.by_entity == {}


def test_a_cloud_of_the_games_own_rains_too():
    Weather()
    rainy = model("rainy", rain_rate=8.0)
    cloud = Cloud(rainy, (100.0, 700.0, 50.0), scale=2.0, heading=0.5 * math.pi, velocity=(2, 0))
    entity = esper.create_entity(cloud)
    esper.process(1.0)
    [area] = areas()
    assert area.rain_rate == 8.0
    assert area.ceiling == 700.0
    assert area.center == pytest.approx((102.0, 50.0), abs=300.0)
    assert area.radii[0] > SHRINK * 180.0
    cloud.growth = 0.25
    esper.process(1.0)
    assert area.rain_rate == 2.0
    esper.delete_entity(entity)
    seconds(2.0)
    assert areas() == []


def test_what_the_game_does_to_carried_areas_is_respected():
    weather = Weather()
    entity = esper.create_entity(layer((raining(3),), velocity=(0.0, 0.0)))
    esper.process(1.0)
    first, second, third = sorted(e for e, _ in esper.get_component(RainArea))
    esper.delete_entity(first)
    esper.add_component(second, Wind())
    seconds(3.0)
    assert [e for e, _ in sorted(esper.get_component(RainArea))] == [second, third]
    esper.delete_entity(entity)
    seconds(2.0)
    assert areas() == []
    assert esper.has_component(second, Wind)
    assert not esper.entity_exists(third)
    weather.close()


def test_closing_takes_the_carried_areas_out():
    mine = esper.create_entity(RainArea((0, 0), (5, 5)))
    with Weather():
        esper.create_entity(layer((raining(3),)))
        esper.process(1.0)
        assert len(areas()) == 4
    assert [entity for entity, _ in esper.get_component(RainArea)] == [mine]
