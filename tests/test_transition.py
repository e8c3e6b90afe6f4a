"""Between any two whole weathers, and out of the middle of it to a third: nothing jumps."""

from __future__ import annotations

import math

import esper
import pytest

from tests.worlds import fresh_world
from weather_ecs import Weather
from weather_ecs.components import Air, Fog, Lightning, RainArea, SkyLayer, Wind
from weather_ecs.systems.course import CLEARED, FINISHED, UNDER_WAY, Conditions
from weather_ecs.systems.transition import AFTER
from weather_ecs.weathers import WEATHERS

NAMES = list(WEATHERS)
SECONDS, STEP = 4.0, 0.2
IN_LOGARITHM = ("rain_radius", "visibility")
HAZY = 10_000.0  # m, beyond which nobody tells one visibility from another
ARRIVES = 0.12  # of the rain, that may come down in a STEP when its front does
FALLING = 3.0  # mm/h, of rain that still falls when none begins to


def values(now: Conditions) -> list[float]:
    """Every quantity as it glides."""
    return [
        math.log(value) if name in IN_LOGARITHM else value
        for name, value in zip(Conditions._fields, now, strict=True)
    ]


def largest_steps(weather: Weather) -> list[float]:
    """What each quantity may change by in a STEP of the course that has begun."""
    course = weather._state.course
    assert course is not None
    most = []
    for a, b, rate in zip(values(course.start), values(course.end), course.rates, strict=True):
        # Of Hermite's cubic: the smoothstep's steepest place, and the rate it begins with.
        most.append((1.5 * abs(b - a) / SECONDS + abs(rate)) * STEP + 1e-9)
    return most


def felt(weather: Weather) -> dict[str, float]:
    """What game code is told at a place."""
    here = weather.sample((3.0, 0.0, 3.0))
    return {
        "rain_rate": here.rain_rate + here.snow_rate,
        "temperature": here.temperature,
        "sight": math.log(min(here.visibility, HAZY)),
        "light": math.log(here.light),
        "humidity": here.humidity,
    }


@pytest.mark.parametrize("one", NAMES)
def test_every_pair_is_smooth_and_may_be_left_half_way(one: str) -> None:
    """The other eight in turn, each left at the steepest place for a third."""
    for other in NAMES:
        if other != one:
            third = NAMES[(NAMES.index(other) + 4) % len(NAMES)]
            with fresh_world(), Weather(seed=1) as weather:
                weather.change_to(one, 0.0)
                esper.process(STEP)
                follow(weather, other, third)


def follow(weather: Weather, other: str, third: str) -> None:
    """Set out for one weather, half-way for another, and look at every step."""
    names = Conditions._fields
    rain, warmth = names.index("rain_rate"), names.index("temperature")
    weather.change_to(other, SECONDS)
    most = largest_steps(weather)
    before, told = values(weather.whole.conditions), felt(weather)
    for k in range(30):
        if k == 10:
            rates = weather._state.course.rates_at(weather._state.clock.steps)
            weather.change_to(third, SECONDS)
            for name, old, new in zip(names, rates, weather._state.course.rates, strict=True):
                assert name == "rain_radius" or new == pytest.approx(old), name
            most = largest_steps(weather)
        esper.process(STEP)
        now, here = values(weather.whole.conditions), felt(weather)
        for name, a, b, limit in zip(names, before, now, most, strict=True):
            if name != "rain_radius":  # nothing falls while it jumps
                assert abs(b - a) <= limit, (other, third, k, name)
        limits = {
            "rain_rate": most[rain] + ARRIVES * max(before[rain], now[rain], FALLING),
            "temperature": most[warmth],
            # A STEP is a twentieth of the way; within two degrees snow becomes rain, which hides
            # a tenth as much.
            "sight": 1.8,
            "light": 0.25,
            "humidity": 0.08,
        }
        for name, limit in limits.items():
            assert abs(here[name] - told[name]) <= limit, (other, third, k, name)
        before, told = now, here
    assert weather.whole.progress == 1.0 and weather.whole.name == third
    end = values(WEATHERS[third].conditions(0.0))
    for name, a, b in zip(names, before, end, strict=True):
        assert name in ("rain_radius", "wind_heading") or a == pytest.approx(b), name


def test_the_weathers_own_entities_have_what_the_course_says() -> None:
    with fresh_world(), Weather(seed=2) as weather:
        weather.change_to("fair_cumulus")
        weather.change_to("thunderstorm", 10.0)
        esper.process(5.0)
        now, owned = weather.whole.conditions, weather.whole.entities
        assert set(owned) == {"air", "fog", "lightning", "rain", "wind"}
        air, wind = esper.component_for_entity(owned["air"], Air), owned["wind"]
        assert (air.temperature, air.humidity) == (now.temperature, now.humidity)
        blows = esper.component_for_entity(wind, Wind)
        assert (blows.speed, blows.gustiness, blows.veer) == (
            now.wind_speed,
            now.gustiness,
            now.veer,
        )
        assert blows.direction == pytest.approx(
            (math.cos(now.wind_heading), math.sin(now.wind_heading))
        )
        area = esper.component_for_entity(owned["rain"], RainArea)
        assert area.rain_rate == now.rain_rate == pytest.approx(20.0)
        assert area.radii == (now.rain_radius, now.rain_radius)
        assert esper.component_for_entity(owned["fog"], Fog).visibility <= now.visibility
        assert esper.component_for_entity(owned["lightning"], Lightning).rate == now.lightning


def test_a_course_goes_through_its_stages_and_then_leaves_the_fields_to_the_game() -> None:
    with fresh_world(), Weather(seed=3) as weather:
        weather.change_to("overcast_drizzle")
        assert weather._state.course.stage == CLEARED
        weather.change_to("clear", 4.0)
        course = weather._state.course
        layers = len(esper.get_component(SkyLayer))
        assert course.stage == UNDER_WAY and layers >= 2
        air = esper.component_for_entity(weather.whole.entities["air"], Air)
        air.temperature = -50.0
        esper.process(1.0)
        assert air.temperature > 0.0  # under way it is led
        esper.process(3.0)
        assert course.stage == FINISHED
        air.temperature = -50.0
        for _ in range(4):
            esper.process((AFTER - 1.0) / 4.0)
        assert course.stage == FINISHED and air.temperature == -50.0
        esper.process(2.0)
        assert course.stage == CLEARED
        assert len(esper.get_component(SkyLayer)) == len(WEATHERS["clear"].banks) < layers
