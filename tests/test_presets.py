"""Presets: names, order and the classes they claim."""

from __future__ import annotations

import dataclasses

import pytest

from weather_ecs.components import Air, Fog, RainArea, Wind
from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.drops import extinction
from weather_ecs.physics.optics import (
    CONTRAST,
    air_extinction,
    extinction_to_visibility,
    falling_extinction,
)
from weather_ecs.physics.phase import share_at, wet_bulb
from weather_ecs.presets import PRESETS, Preset, find

RAINS = ["clear", "drizzle", "light", "moderate", "heavy", "cloudburst"]
NAMES = [*RAINS, "sleet", "light_snow", "heavy_snow", "blizzard", "fog"]
SNOWS = ["light_snow", "heavy_snow", "blizzard"]


def share(preset: Preset) -> float:
    return share_at(preset.temperature, preset.humidity)


def seen(preset: Preset) -> float:
    """m, through air and what falls."""
    snow = preset.rain_rate * share(preset)
    falls = falling_extinction(preset.rain_rate - snow, snow)
    return CONTRAST / (air_extinction(preset.visibility) + falls)


def test_names_and_growing_rates():
    assert list(PRESETS) == NAMES
    rates = [PRESETS[name].rain_rate for name in RAINS]
    winds = [PRESETS[name].wind_speed for name in RAINS]
    assert rates == sorted(rates)
    assert winds == sorted(winds)
    for name, preset in PRESETS.items():
        assert preset.name == name
        assert 0.0 <= preset.overcast <= 1.0
        assert preset.description


@pytest.mark.parametrize("spelling", ["light_snow", "light snow", "Light-Snow", " LIGHT  snow "])
def test_names_in_any_spelling(spelling):
    assert PRESETS[spelling] is find(spelling) is PRESETS["light_snow"]
    assert spelling in PRESETS
    assert PRESETS.get(spelling) is PRESETS["light_snow"]


@pytest.mark.parametrize("name", ["", "snow", "lightsnow", 3, None])
def test_a_name_that_is_none(name):
    assert name not in PRESETS and PRESETS.get(name) is None
    assert PRESETS.get(name, "clear") == "clear"
    with pytest.raises(KeyError, match=r"no preset .*there are clear, drizzle"):
        PRESETS[name]
    with pytest.raises(InvalidValueError, match="heavy_snow"):
        find(name)


@pytest.mark.parametrize(
    ("name", "low", "high"),
    [
        ("clear", 0.0, 0.0),
        ("drizzle", 0.1, 1.0),
        ("light", 1.0, 2.5),
        ("moderate", 2.6, 7.6),
        ("heavy", 7.7, 50.0),
        ("cloudburst", 100.0, 250.0),
        ("light_snow", 0.1, 1.0),
        ("heavy_snow", 2.5, 10.0),
        ("fog", 0.0, 0.0),
    ],
)
def test_rates_are_in_their_class(name, low, high):
    assert low <= PRESETS[name].rain_rate <= high


def test_a_cloudburst_shows_a_few_hundred_metres():
    visibility = extinction_to_visibility(extinction(PRESETS["cloudburst"].rain_rate))
    assert 300.0 < float(visibility) < 1000.0


@pytest.mark.parametrize(
    ("name", "low", "high"),
    [
        ("clear", 45_000.0, 50_000.0),
        ("drizzle", 1000.0, 5000.0),  # mist
        ("light_snow", 1000.0, 5000.0),
        ("heavy_snow", 200.0, 500.0),
        ("blizzard", 50.0, 400.0),
        ("fog", 50.0, 1000.0),
    ],
)
def test_one_sees_as_far_as_the_class_says(name, low, high):
    assert low < seen(PRESETS[name]) <= high


def test_temperature_makes_rain_sleet_or_snow():
    assert all(share(PRESETS[name]) == 0.0 for name in RAINS)
    assert all(share(PRESETS[name]) > 0.95 for name in SNOWS)
    assert 0.4 < share(PRESETS["sleet"]) < 0.6
    sleet = PRESETS["sleet"]
    assert float(wet_bulb(sleet.temperature, sleet.humidity)) == pytest.approx(0.8, abs=0.15)


def test_a_blizzard_is_a_storm():
    assert PRESETS["blizzard"].wind_speed >= 15.6
    assert all(p.wind_speed < 15.6 for name, p in PRESETS.items() if name != "blizzard")


@pytest.mark.parametrize("preset", PRESETS.values(), ids=NAMES)
def test_presets_make_and_change_components(preset: Preset):
    made = preset.area((3, 4), (20, 10), heading=0.5)
    assert made.rain_rate == preset.rain_rate
    assert made.heading == 0.5
    assert preset.wind((0, -2)).speed == preset.wind_speed
    assert preset.wind((0, -2), veer=0.3).direction == (0.0, -1.0)
    assert preset.wind().gustiness == preset.gustiness
    assert preset.air().temperature == preset.temperature
    assert preset.fog(draw=True).visibility == preset.visibility
    area, wind, air, fog = RainArea((0, 0), (2, 1), 77.0), Wind((1, 0), 77.0), Air(-50.0), Fog(3.0)
    preset.apply()
    preset.apply(area)
    assert (area.rain_rate, wind.speed) == (preset.rain_rate, 77.0)
    preset.apply(wind=wind)
    assert (wind.speed, wind.gustiness) == (preset.wind_speed, preset.gustiness)
    assert (air.temperature, fog.visibility) == (-50.0, 3.0)
    preset.apply(air=air, fog=fog)
    assert (air.temperature, air.humidity) == (preset.temperature, preset.humidity)
    assert fog.visibility == preset.visibility


def test_presets_cannot_be_changed_by_accident():
    with pytest.raises(dataclasses.FrozenInstanceError):
        PRESETS["clear"].rain_rate = 3.0
