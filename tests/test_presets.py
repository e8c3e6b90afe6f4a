"""Presets: names, order and the classes they claim."""

from __future__ import annotations

import dataclasses

import pytest

from weather_ecs.components import RainArea, Wind
from weather_ecs.physics.drops import extinction
from weather_ecs.physics.optics import extinction_to_visibility
from weather_ecs.presets import PRESETS, Preset

NAMES = ["clear", "drizzle", "light", "moderate", "heavy", "cloudburst"]


def test_names_and_growing_rates():
    assert list(PRESETS) == NAMES
    rates = [preset.rain_rate for preset in PRESETS.values()]
    winds = [preset.wind_speed for preset in PRESETS.values()]
    assert rates == sorted(rates)
    assert winds == sorted(winds)
    for name, preset in PRESETS.items():
        assert preset.name == name
        assert 0.0 <= preset.overcast <= 1.0
        assert preset.description


@pytest.mark.parametrize(
    ("name", "low", "high"),
    [
        ("clear", 0.0, 0.0),
        ("drizzle", 0.1, 1.0),
        ("light", 1.0, 2.5),
        ("moderate", 2.6, 7.6),
        ("heavy", 7.7, 50.0),
        ("cloudburst", 100.0, 250.0),
    ],
)
def test_rates_are_in_their_class(name, low, high):
    assert low <= PRESETS[name].rain_rate <= high


def test_a_cloudburst_shows_a_few_hundred_metres():
    visibility = extinction_to_visibility(extinction(PRESETS["cloudburst"].rain_rate))
    assert 300.0 < float(visibility) < 1000.0


@pytest.mark.parametrize("preset", PRESETS.values(), ids=NAMES)
def test_presets_make_and_change_components(preset: Preset):
    made = preset.area((3, 4), (20, 10), heading=0.5)
    assert made.rain_rate == preset.rain_rate
    assert made.heading == 0.5
    assert preset.wind((0, -2)).speed == preset.wind_speed
    assert preset.wind((0, -2)).direction == (0.0, -1.0)
    area, wind = RainArea((0, 0), (2, 1), 77.0), Wind((1, 0), 77.0)
    preset.apply()
    preset.apply(area)
    assert (area.rain_rate, wind.speed) == (preset.rain_rate, 77.0)
    preset.apply(wind=wind)
    assert wind.speed == preset.wind_speed


def test_presets_cannot_be_changed_by_accident():
    with pytest.raises(dataclasses.FrozenInstanceError):
        PRESETS["clear"].rain_rate = 3.0
