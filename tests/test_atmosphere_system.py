"""The atmosphere as a component: its time, its light, snapshots, all without OpenGL."""

from __future__ import annotations

import math

import esper
import numpy as np
import pytest

from weather_ecs import Weather
from weather_ecs.components import Atmosphere, Climate, Fog, Sun
from weather_ecs.errors import InvalidValueError
from weather_ecs.frame import FrameData, SkyLight
from weather_ecs.physics.haze import THICKEST, Lit, haze_depth, haze_visibility, under_fog
from weather_ecs.presets import WholeWeather


def made(**fields: object) -> tuple[Weather, Atmosphere]:
    weather, air = Weather(), Atmosphere(**fields)  # type: ignore[arg-type]
    esper.create_entity(air)
    esper.process(0.05)
    return weather, air


def frame(weather: Weather) -> FrameData:
    return weather._frame()


@pytest.fixture(autouse=True)
def world():
    esper.switch_world("sky")
    yield
    esper.switch_world("default")
    esper.delete_world("sky")


def test_time_is_text_or_seconds_and_goes_with_the_clock() -> None:
    assert Atmosphere("1970-01-02").time == 86400.0
    assert Atmosphere("1970-01-01T01:00:00+01:00").time == 0.0
    weather, air = made(time=0.0, speed=60.0)
    for _ in range(100):
        esper.process(0.05)
    assert air.time == pytest.approx(101 * 0.05 * 60.0)
    weather.paused = True
    before = air.time
    esper.process(5.0)
    assert air.time == before
    weather.close()


def test_it_stops_with_the_years_it_is_good_for() -> None:
    weather, air = made(time="2099-12-31T23:59:00Z", speed=1e6)
    esper.process(10.0)
    assert math.isfinite(weather.sample((0, 0, 0)).light)
    air.speed = -1e6
    for _ in range(3):
        esper.process(10.0)
    assert air.time > 0.0
    air.time = -2208988800.0
    esper.process(10.0)
    assert air.time == -2208988800.0
    weather.close()


def test_it_takes_the_place_of_the_sun_and_gives_it_back() -> None:
    weather, _air = made()
    game = Sun(color=(9.0, 9.0, 9.0))
    esper.create_entity(game)
    noon = weather.light
    assert noon is frame(weather).sky
    assert noon.sun_color[0] < 2.0
    assert noon.sun_direction[1] == pytest.approx(math.sin(math.radians(68.4)), abs=0.01)
    assert noon.sun_direction[2] > 0.3  # in the south
    esper.delete_entity(esper.get_component(Atmosphere)[0][0], immediate=True)
    assert frame(weather).sky.sun_color == (9.0, 9.0, 9.0)
    weather.close()


def test_a_night_with_a_full_moon_is_brighter_than_one_without() -> None:
    """In 2025 the moon was full on 14 March, and new on the 29th."""
    weather, air = made()
    lights = []
    for day in ("2025-03-14", "2025-03-29"):
        air.time = f"{day}T00:00:00Z"
        lights.append(weather.sample((0, 0, 0)).light)
    full, none = lights
    assert 1.3 * none < full < 10.0 * none


def test_light_of_day_twilight_and_night() -> None:
    weather, air = made()
    lights = []
    for time in ("12:00", "19:00", "19:52", "20:30", "23:00"):
        air.time = f"2025-06-21T{time}:00Z"
        lights.append(weather.sample((0, 0, 0)).light)
    assert lights == sorted(lights, reverse=True)
    assert 1.0 < lights[0] < 2.0
    assert 0.01 < lights[-1] < 0.2
    weather.close()


def test_fog_takes_its_colour() -> None:
    weather, air = made()
    esper.create_entity(Fog(100.0))
    noon = frame(weather).fog.color
    air.time = "2025-06-21T23:30:00Z"
    night = frame(weather).fog.color
    assert max(night) < 0.2 * min(noon)
    weather.close()


def test_polar_day_and_night() -> None:
    weather, air = made(latitude=85.0)
    for hour in range(0, 24, 6):
        air.time = f"2025-06-21T{hour:02}:00:00Z"
        assert frame(weather).sky.sun_color[0] > 0.5
        air.time = f"2025-12-21T{hour:02}:00:00Z"
        assert max(frame(weather).sky.zenith_color) < 0.15
    weather.close()


def test_the_full_moon_casts_shadows_at_night() -> None:
    weather, _ = made(time="2024-01-25T23:30:00Z", speed=0.0)
    sky = frame(weather).sky
    assert sky.sun_direction[1] > 0.7
    assert 0.005 < sky.sun_color[1] < 0.3
    weather.close()


def test_the_climate_covers_the_sky() -> None:
    weather, air = made()
    clear = frame(weather).sky
    esper.create_entity(Climate(1.0, 1.0))
    esper.process(0.05)
    storm = frame(weather).sky
    assert sum(storm.sun_color) < 0.3 * sum(clear.sun_color)
    air.overcast = 0.0
    assert frame(weather).sky.sun_color == clear.sun_color
    weather.close()


def test_light_is_kept_while_nothing_moves() -> None:
    weather, air = made(speed=0.0)
    first = frame(weather).sky
    esper.process(1.0)
    assert frame(weather).sky is first
    air.turbidity = 5.0
    assert frame(weather).sky is not first
    assert isinstance(first, SkyLight)
    weather.close()


def test_snapshot_half_way_through_a_sunset() -> None:
    weather, _ = made(time="2025-06-21T19:30:00Z", speed=120.0)
    for _ in range(30):
        esper.process(0.033)
    taken = weather.snapshot()
    after = []
    for _ in range(2):
        weather.restore(taken)
        for _ in range(40):
            esper.process(0.033)
        after.append((weather.snapshot(), weather.sample((0, 0, 0)), frame(weather).sky))
    assert after[0][0] == after[1][0]
    assert after[0][1:] == after[1][1:]
    weather.close()


def test_bad_times_name_the_field() -> None:
    for bad in ("yesterday", "2025-06-21T25:00:00Z", math.nan, None, "1899-12-31", b"2025-01-01"):
        with pytest.raises(InvalidValueError, match=r"Atmosphere\.time"):
            Atmosphere(time=bad)  # type: ignore[arg-type]


def test_a_whole_weathers_overcast_dims_and_greys() -> None:
    weather, air = made(speed=0.0)
    skies = []
    for overcast in (0.0, 0.5, 1.0):
        weather.change_to(WholeWeather("so", 0.0, overcast=overcast), 0.0)
        skies.append(frame(weather).sky)
    suns = [sum(sky.sun_color) for sky in skies]
    assert suns[1] > 0.8 * suns[0] > 4.0 * suns[2]  # broken clouds leave the sky between them
    blue = [sky.zenith_color[2] / sky.zenith_color[0] for sky in skies]
    assert blue[0] > 2.0 > 1.3 > blue[2]
    air.overcast = 0.0
    assert frame(weather).sky.sun_color == skies[0].sun_color
    weather.close()


def test_a_whole_weathers_haze_whitens_the_horizon_and_sets_how_far_one_sees() -> None:
    weather, _ = made(speed=0.0)
    skies, seen = [], []
    for haze in (0.1, 0.5, 1.0):
        weather.change_to(WholeWeather("so", 0.0, haze=haze), 0.0)
        skies.append(frame(weather).sky)
        seen.append(weather.sample((0, 2, 0)).visibility)
    pure = [max(sky.horizon_color) / min(sky.horizon_color) for sky in skies]
    assert pure[0] > pure[1] > pure[2] and pure[2] - 1.0 < 0.7 * (pure[0] - 1.0)
    assert sum(skies[2].sun_color) < 0.7 * sum(skies[0].sun_color)
    assert seen == pytest.approx([50_000.0, haze_visibility(0.5), THICKEST])
    weather.change_to(WholeWeather("so", 0.0, haze=0.5, visibility=800.0), 0.0)
    assert weather.sample((0, 2, 0)).visibility == pytest.approx(800.0)
    assert haze_depth(0.0) == haze_depth(0.1) == 0.0
    weather.close()


def test_a_transition_makes_the_light_anew_in_small_steps() -> None:
    weather, _ = made(speed=0.0)
    weather.change_to("clear")
    weather.change_to("steady_rain", 20.0)
    levels = []
    for _ in range(60):
        esper.process(0.4)
        levels.append(sum(frame(weather).sky.sun_color))
    steps = np.abs(np.diff(levels))
    assert steps.max() < 0.12 < 1.5 < levels[0] - levels[-1]
    weather.close()


def test_fog_takes_the_suns_light_and_hands_it_on_from_all_round() -> None:
    weather, _ = made(speed=0.0)
    clear = frame(weather).sky
    fog = Fog(50_000.0)
    esper.create_entity(fog)
    assert frame(weather).sky.sun_color == clear.sun_color
    level = [weather.sample((0, 2, 0)).light]
    for visibility in (2000.0, 250.0, 50.0):
        fog.visibility = visibility
        level.append(weather.sample((0, 2, 0)).light)
    dull = frame(weather).sky
    assert max(dull.sun_color) < 1e-3
    assert level == sorted(level, reverse=True) and level[2] > 0.6 * level[0]
    assert max(dull.horizon_color) / min(dull.horizon_color) < 1.25
    weather.close()
    light = Lit(np.ones(3), np.full(3, 0.2), np.full(3, 0.6))
    for depth in (1e-9, 0.5, 5.0, 1e9):
        out = under_fog(light, 0.5, depth)
        total = out.sun * 0.5 + 0.5 * (out.zenith + out.horizon)
        assert np.allclose(total, 0.9 / (1.0 + 0.075 * depth), rtol=1e-6)


@pytest.mark.parametrize("field", ["latitude", "longitude"])
@pytest.mark.parametrize("value", [1e9, -181.0, math.nan, math.inf, None, "north"])
def test_places_out_of_range_change_nothing(field: str, value: object) -> None:
    weather, air = made(latitude=45.0, longitude=7.5)
    before = weather.snapshot()
    with pytest.raises(InvalidValueError, match=rf"Atmosphere\.{field}"):
        setattr(air, field, value)
    assert weather.snapshot() == before
    weather.close()


def test_a_sun_of_the_games_own_at_the_zenith_and_straight_below() -> None:
    weather = Weather()
    sun = Sun(direction=(0.0, 1.0, 0.0))
    esper.create_entity(sun)
    light = []
    for y in (1.0, -1.0):
        sun.direction = (0.0, y, 0.0)
        esper.process(0.05)
        light.append(weather.sample((0.0, 0.0, 0.0)).light)
    assert light[0] > light[1] >= 0.0 and all(map(math.isfinite, light))
    with pytest.raises(InvalidValueError, match=r"Sun\.direction"):
        sun.direction = (0.0, 0.0, 0.0)
    weather.close()


def test_the_year_at_the_poles_is_finite() -> None:
    weather, air = made(latitude=90.0)
    for month in range(1, 13):
        for latitude in (90.0, -90.0):
            air.latitude, air.time = latitude, f"2025-{month:02}-21T12:00:00Z"
            light = weather.light
            assert all(map(math.isfinite, (*light.sun_color, *light.zenith_color)))
    weather.close()
