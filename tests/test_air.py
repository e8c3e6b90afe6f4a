"""Air and fog: from components to frames, and what they take from the view."""

from __future__ import annotations

import math

import esper
import pytest

from tests.worlds import fresh_world
from weather_ecs import Weather
from weather_ecs.components import Air, Fog, RainArea, Sun
from weather_ecs.errors import InvalidValueError
from weather_ecs.frame import AirData, FogData, FrameData, SkyLight
from weather_ecs.physics import optics
from weather_ecs.physics.drops import extinction
from weather_ecs.physics.phase import share_at, snow_share, wet_bulb
from weather_ecs.physics.snow import snow_extinction
from weather_ecs.systems.air import fog_color
from weather_ecs.systems.extract import ExtractSystem
from weather_ecs.systems.state import WeatherState

pytestmark = pytest.mark.usefixtures("world")


def published() -> FrameData:
    return ExtractSystem().frame(WeatherState(0))


def test_without_components_the_air_is_clean_and_mild():
    found = published()
    assert found.air.temperature == AirData().temperature == Air().temperature
    assert found.air.humidity == AirData().humidity == Air().humidity
    assert found.air.wet_bulb == pytest.approx(AirData().wet_bulb, abs=0.01)
    assert found.air.snow_share == AirData().snow_share == 0.0
    assert found.fog.extinction == pytest.approx(FogData().extinction)
    assert found.fog.color == pytest.approx(FogData().color, abs=0.01)
    assert not found.fog.draw


def test_components_reach_the_frame_at_once():
    extract, state = ExtractSystem(), WeatherState(0)
    air, fog = Air(-3.0, 0.95), Fog(200.0, draw=True, depth=80.0)
    esper.create_entity(air)
    esper.create_entity(fog)
    found = extract.frame(state)
    assert found.air == AirData(-3.0, 0.95, float(wet_bulb(-3.0, 0.95)), share_at(-3.0, 0.95))
    assert found.air.snow_share > 0.9
    assert found.fog == FogData(3.912 / 200.0, fog_color(SkyLight()), 80.0, True)
    air.temperature, fog.visibility, fog.color = 10.0, 50.0, (1.0, 0.0, 0.5)
    found = extract.frame(state)
    assert found.air.snow_share == 0.0
    assert found.fog == FogData(3.912 / 50.0, (1.0, 0.0, 0.5), 80.0, True)


def test_the_oldest_counts_and_a_deleted_one_does_not():
    first = esper.create_entity(Fog(100.0), Air(1.0))
    esper.create_entity(Fog(200.0), Air(2.0))
    extract, state = ExtractSystem(), WeatherState(0)
    found = extract.frame(state)
    assert (found.fog.extinction, found.air.temperature) == (3.912 / 100.0, 1.0)
    esper.delete_entity(first)
    found = extract.frame(state)
    assert (found.fog.extinction, found.air.temperature) == (3.912 / 200.0, 2.0)


@pytest.mark.parametrize(
    ("visibility", "counts_as"), [(0.0, 1.0), (0.5, 1.0), (1.0, 1.0), (5e4, 5e4), (1e7, 5e4)]
)
def test_no_visibility_gives_an_extinction_that_is_none(visibility, counts_as):
    esper.create_entity(Fog(visibility))
    found = published().fog.extinction
    assert found == pytest.approx(3.912 / counts_as)
    assert float(optics.fog_factor(counts_as, found)) == pytest.approx(0.02, rel=1e-3)


def test_fog_takes_the_light_of_the_sky():
    esper.create_entity(Fog(100.0))
    sun = Sun(color=(0, 0, 0), zenith_color=(0.1, 0.1, 0.1), horizon_color=(0.2, 0.2, 0.3))
    esper.create_entity(sun)
    dull = published().fog.color
    assert dull == pytest.approx((0.175, 0.175, 0.25))
    sun.color = (5.0, 4.0, 3.0)
    bright = published().fog.color
    assert bright[0] - dull[0] > bright[2] - dull[2] > 0.0
    sun.direction = (1.0, -0.1, 0.0)  # below the horizon
    assert published().fog.color == pytest.approx(dull)


@pytest.mark.parametrize("color", ["red", (1, 2), (-1, 0, 0), (0, 0, 1001), (math.nan, 0, 0), 3])
def test_a_colour_that_is_none_is_refused(color):
    with pytest.raises(InvalidValueError, match=r"Fog\.color"):
        Fog(color=color)
    assert Fog(color=None).color is None


def test_rain_and_snow_take_what_their_laws_say():
    for rain, snow in ((0.0, 0.0), (25.0, 0.0), (0.0, 4.0), (3.0, 1.0), (1000.0, 0.0)):
        expected = float(extinction(rain) + snow_extinction(snow))
        assert optics.falling_extinction(rain, snow) == pytest.approx(expected, rel=1e-9)


def sampled(temperature: float, height: float = 0.0, visibility: float = 1e7, rate: float = 2.0):
    with fresh_world():
        esper.create_entity(Air(temperature, 0.9))
        esper.create_entity(Fog(visibility))
        esper.create_entity(RainArea((0, 0), (60, 60), rate, ceiling=9000.0))
        with Weather() as weather:
            return weather.sample((0.0, height, 0.0))


@pytest.mark.parametrize("temperature", [-60.0, -5.0, 0.0, 1.0, 2.0, 5.0, 60.0])
def test_what_falls_is_shared_out_by_the_wet_bulb(temperature):
    got = sampled(temperature)
    share = float(snow_share(wet_bulb(temperature, 0.9)))
    assert got.snow_rate == pytest.approx(2.0 * share, abs=0.02)
    assert got.rain_rate + got.snow_rate == pytest.approx(2.0)
    assert got.temperature == temperature
    lost = optics.CLEAR + float(extinction(got.rain_rate) + snow_extinction(got.snow_rate))
    assert got.visibility == pytest.approx(3.912 / lost)


def test_higher_up_it_snows():
    low, high = sampled(8.0), sampled(8.0, 2000.0)
    assert low.snow_rate == 0.0 == high.rain_rate
    assert high.snow_rate == pytest.approx(2.0)
    assert high.temperature == pytest.approx(8.0 - 13.0)


def test_fog_and_what_falls_both_hide():
    assert sampled(15.0, visibility=300.0, rate=0.0).visibility == pytest.approx(300.0)
    both = sampled(15.0, visibility=300.0, rate=50.0).visibility
    rain = sampled(15.0, rate=50.0).visibility
    assert 1.0 / both == pytest.approx(1.0 / 300.0 + 1.0 / rain - 1.0 / 5e4, rel=1e-6)


def test_walking_into_rain_visibility_falls_smoothly():
    esper.create_entity(RainArea((0, 0), (60, 60), 25.0, soft_edge=20.0))
    with Weather() as weather:
        seen = [weather.sample((62.0 - 0.25 * k, 1.7, 0.0)).visibility for k in range(120)]
    assert seen[0] == pytest.approx(5e4)
    assert seen[-1] < 1500.0
    lost = [3.912 / v for v in seen]
    assert all(0.0 <= b - a < 1e-4 for a, b in zip(lost, lost[1:], strict=False))


def test_a_snapshot_holds_air_and_fog():
    air = esper.create_entity(Air(-7.5, 0.6))
    esper.create_entity(Fog(80.0, (0.5, 0.6, 0.7), 90.0, True))
    esper.create_entity(Fog())
    with Weather() as weather:
        data = weather.snapshot()
        esper.delete_entity(air, immediate=True)
        for _, fog in esper.get_component(Fog):
            fog.visibility = 5.0
        weather.restore(data)
        found = [it for _, it in sorted(esper.get_component(Fog), key=lambda pair: pair[0])]
        assert [(it.visibility, it.color, it.depth, it.draw) for it in found] == [
            (80.0, (0.5, 0.6, 0.7), 90.0, True),
            (1000.0, None, 250.0, False),
        ]
        ((_, restored),) = esper.get_component(Air)
        assert (restored.temperature, restored.humidity) == (-7.5, 0.6)
        assert weather.snapshot() == data
