"""Whole weathers on their way into each other."""

from __future__ import annotations

import itertools
import json
import math

import esper
import numpy as np
import pytest

from tests.worlds import fresh_world, let_pass
from weather_ecs import Weather, snapshot
from weather_ecs.components import SkyLayer
from weather_ecs.errors import InvalidValueError, SnapshotError
from weather_ecs.systems.course import LIMITS, Conditions, Course
from weather_ecs.weathers import WEATHERS, WholeWeather, heading_of

pytestmark = pytest.mark.usefixtures("world")

NAMES = list(WEATHERS)


def conditions(weather: Weather) -> Conditions:
    now = weather.whole
    assert now is not None
    return now.conditions


# Transitions


@pytest.mark.parametrize(("one", "other"), list(itertools.permutations(NAMES, 2))[::5])
def test_any_two_glide_into_each_other_in_the_time_given(one, other):
    with fresh_world(), Weather(seed=2) as weather:
        weather.change_to(one)
        let_pass(1, 1.0)
        start = conditions(weather)
        weather.change_to(other, 20.0)
        seen = [conditions(weather)]
        for _ in range(80):
            esper.process(0.25)
            seen.append(conditions(weather))
        assert weather.whole.progress == 1.0
        end = WEATHERS[other].conditions(0.0)
        for name, a, b in zip(Conditions._fields, start, end, strict=True):
            values = np.array([getattr(each, name) for each in seen])
            if name == "rain_radius" and not (start.rain_rate and end.rain_rate):
                # Rain that comes or goes keeps its size: no edge of it passes over anybody.
                assert values == pytest.approx(a if start.rain_rate else b)
                continue
            assert values[0] == pytest.approx(a) and values[-1] == pytest.approx(b)
            if name in ("visibility", "rain_radius"):
                values, a, b = np.log(values), math.log(a), math.log(b)
            # A smoothstep: monotonous, at most half as fast again as the mean, without a jump.
            steps = np.diff(values) * np.sign(b - a)
            assert steps.min() >= -1e-9, name
            assert steps.max() <= 1.5 * abs(b - a) / 80.0 + 1e-9, name
            assert abs(np.diff(steps)).max() <= 6.2 * abs(b - a) / 80.0**2 + 1e-9, name
        before, after = weather.whole.progress, seen[-1]
        let_pass(2)
        assert (weather.whole.progress, conditions(weather)) == (before, after)


def test_interrupted_half_way_it_goes_on_from_there_without_a_jump_in_value_or_rate():
    with Weather(seed=2) as weather:
        weather.change_to("clear")
        weather.change_to("blizzard", 20.0)
        seen = []
        for k in range(160):
            if k == 40:
                weather.change_to("fog", 30.0)
            esper.process(0.25)
            seen.append(conditions(weather))
        for name in ("wind_speed", "temperature", "humidity", "state", "haze"):
            values = np.array([getattr(each, name) for each in seen])
            rates = np.diff(values)
            assert abs(np.diff(rates)).max() < 0.12 * abs(rates).max(), name
            assert values[-1] == pytest.approx(getattr(WEATHERS["fog"], name))
        assert abs(np.diff([np.log(each.visibility) for each in seen])).max() < 0.2


@pytest.mark.parametrize("limits", LIMITS.items())
def test_wild_interruptions_stay_within_the_limits(limits):
    name, (low, high) = limits
    with Weather(seed=3) as weather:
        weather.change_to("clear")
        for k in range(30):
            weather.change_to(NAMES[(5 * k) % len(NAMES)], 1.0 + k % 3)
            esper.process(0.45)
            assert low <= getattr(conditions(weather), name) <= high


def test_the_wind_turns_the_short_way():
    with Weather() as weather:
        weather.change_to(WholeWeather("a", 0.1, wind_from=350.0, wind_speed=5.0, veer=0.0))
        first = weather.sample((0, 0, 0)).wind
        assert first[0] == pytest.approx(5 * math.sin(math.radians(10)), abs=0.9)
        assert first[2] > 0.0  # from the north, which is -z
        weather.change_to(WholeWeather("b", 0.1, wind_from=20.0, wind_speed=5.0, veer=0.0), 10.0)
        for _ in range(20):
            esper.process(0.5)
            assert weather.sample((0, 0, 0)).wind[2] > 3.0
        assert math.cos(conditions(weather).wind_heading - heading_of(20.0)) == pytest.approx(1.0)


def test_no_time_at_all_is_at_once():
    with Weather() as weather:
        weather.change_to("clear")
        weather.change_to("steady_rain", 0.0)
        assert conditions(weather) == WEATHERS["steady_rain"].conditions(
            conditions(weather).wind_heading
        )
        assert weather.sample((0, 0, 0)).temperature == 11.0


def test_clouds_become_those_of_the_new_weather_and_empty_layers_go():
    with Weather(seed=4) as weather:
        weather.change_to("fair_cumulus")
        let_pass(2)
        weather.change_to("overcast_drizzle", 30.0)
        let_pass(30)
        weather.change_to("clear", 20.0)
        let_pass(120, 1.0)
        wanted = sum(bank.bank().clouds for bank in WEATHERS["clear"].banks)
        assert weather.stats.clouds == pytest.approx(wanted, abs=3)
        assert len(esper.get_component(SkyLayer)) == 1


def test_how_time_is_cut_does_not_matter():
    found = []
    for cuts in ((0.05,) * 400, (0.5,) * 40, (10.0,) * 2, (0.07, 0.13, 0.3) * 40):
        with fresh_world(), Weather(seed=3) as weather:
            weather.change_to("clear")
            weather.change_to("thunderstorm", 15.0)
            for dt in cuts:
                esper.process(dt)
            assert weather.stats.time == pytest.approx(20.0)
            document = weather._state
            found.append(json.dumps([document.course.state(), document.wet_ground.state()]))
            found.append(conditions(weather))
    assert len(set(found[::2])) == 1 and len(set(found[1::2])) == 1


def test_a_snapshot_half_way_goes_on_to_the_byte():
    with Weather(seed=5) as first:
        first.change_to("fair_cumulus")
        let_pass(5)
        first.change_to("thunderstorm", 40.0)
        let_pass(17.3, 0.1)
        first.change_to("snow", 25.0)
        let_pass(9.1, 0.1)
        data = first.snapshot()
        assert len(data) < 16_000
        now = first.whole
        let_pass(40, 0.1)
        later = first.snapshot()
    with fresh_world(), Weather() as second:
        second.restore(data)
        assert second.whole.conditions == now.conditions and second.whole.name == "snow"
        assert second.snapshot() == data
        let_pass(40, 0.1)
        assert second.snapshot() == later


@pytest.mark.parametrize("part", ["rain", "layer"])
def test_what_the_game_has_just_deleted_is_led_nowhere(part):
    """Deleted, as esper does it, at the next process only."""
    with Weather() as weather:
        weather.change_to("steady_rain")
        let_pass(1)
        gone = weather.whole.entities["rain"]
        if part == "layer":
            gone = min(entity for entity, _ in esper.get_component(SkyLayer))
        esper.delete_entity(gone)
        weather.change_to("showers", 5.0)
        assert gone not in weather.whole.entities.values()
        let_pass(8)
        assert weather.whole.progress == 1.0
        assert weather.sample((0, 0, 0)).rain_rate > 0.0
        assert not esper.entity_exists(gone)


def test_a_rate_that_leads_too_far_stays_in_its_limits():
    """No weather comes to such a rate, but a snapshot may hold it."""
    with Weather() as weather:
        weather.change_to("clear")
        weather.change_to("fog", 100.0)
        document = snapshot.decode(weather.snapshot())
        document["course"]["rates"] = [1e9] * len(document["course"]["rates"])
        weather.restore(snapshot.encode(document))
        let_pass(10)
        for name, value in weather.whole.conditions._asdict().items():
            low, high = LIMITS[name]
            assert low <= value <= high


def test_bad_courses_in_snapshots_are_refused():
    with Weather() as weather:
        weather.change_to("clear")
        weather.change_to("fog", 10.0)
        let_pass(2)
        good = json.loads(json.dumps(weather._state.course.state()))
        now = weather._state.clock.steps
        assert Course.from_state(good, now).state() == good
        for field, value in (
            ("name", 5), ("start", []), ("end", [1.0] * 3), ("began", -1), ("steps", 0.5),
            ("rates", None), ("stage", 9), ("owned", {"moon": 1}), ("layers", [[1, 2]]),
            ("layers", {}), ("start", [9.0] * 13), ("began", now + 1),
        ):  # fmt: skip
            with pytest.raises(InvalidValueError):
                Course.from_state({**good, field: value}, now)
        with pytest.raises(SnapshotError):
            weather.restore(b"WECS nonsense")
