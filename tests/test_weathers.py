"""Whole weathers and the ways between them, without OpenGL."""

from __future__ import annotations

import math

import esper
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.worlds import fresh_world, let_pass
from weather_ecs import Weather, presets
from weather_ecs.components import Air, RainArea, SkyLayer, Wind
from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.glide import glide, glide_rate
from weather_ecs.physics.oktas import (
    CLOSED,
    FOOTPRINTS,
    SLANT,
    count_for,
    share_of,
    shown_footprint,
)
from weather_ecs.systems.cloud_place import QUANTUM
from weather_ecs.weathers import WEATHERS, CloudBank, WholeWeather

pytestmark = pytest.mark.usefixtures("world")

NAMES = list(WEATHERS)


# How quantities glide


@given(
    st.floats(-50, 50), st.floats(-5, 5), st.floats(-50, 50), st.floats(0.1, 1000), st.floats(0, 1)
)
def test_a_glide_begins_and_ends_as_it_has_to_and_its_rate_is_its_slope(a, v, b, seconds, u):
    assert glide(a, v, b, seconds, 0.0) == a
    assert glide(a, v, b, seconds, seconds) == b
    assert glide_rate(a, v, b, seconds, 0.0) == pytest.approx(v)
    assert glide_rate(a, v, b, seconds, seconds) == 0.0
    h = 1e-4 * seconds
    t = min(max(u * seconds, h), seconds - 2.0 * h)
    slope = (glide(a, v, b, seconds, t + h) - glide(a, v, b, seconds, t - h)) / (2.0 * h)
    assert glide_rate(a, v, b, seconds, t) == pytest.approx(slope, rel=1e-3, abs=1e-3)


# The table


def test_the_named_ones_are_what_their_names_say():
    assert NAMES == [
        "clear", "fair_cumulus", "overcast_drizzle", "steady_rain", "showers", "thunderstorm",
        "snow", "blizzard", "fog",
    ]  # fmt: skip
    for name in ("clear", "fair_cumulus", "fog"):
        assert WEATHERS[name].rain_rate == 0.0
    assert WEATHERS["overcast_drizzle"].rain_rate < 0.5  # AMS
    assert 2.5 < WEATHERS["steady_rain"].rain_rate < 7.6
    assert WEATHERS["thunderstorm"].rain_rate > 7.6
    assert [n for n in NAMES if WEATHERS[n].lightning] == ["thunderstorm"]
    assert WEATHERS["fog"].visibility < 1000.0  # WMO
    assert WEATHERS["blizzard"].wind_speed > 15.6  # NWS
    states = [WEATHERS[n].state for n in NAMES]
    assert len(set(states)) == len(states) and min(states) == 0.0 and max(states) == 1.0


def test_each_is_put_up_whole_at_once():
    for name, whole in WEATHERS.items():
        with fresh_world(), Weather(seed=1) as weather:
            weather.change_to(name, 300.0)
            here = weather.sample((0, 0, 0))
            assert here.rain_rate + here.snow_rate == pytest.approx(whole.rain_rate), name
            frozen = name in ("snow", "blizzard")
            assert (here.snow_rate > here.rain_rate) == (frozen and whole.rain_rate > 0.0)
            assert here.temperature == whole.temperature and here.humidity == whole.humidity
            assert here.visibility <= whole.visibility * 1.001
            esper.process(1.0)
            assert weather.stats.clouds == sum(bank.bank().clouds for bank in whole.banks)
            assert weather.stats.state == pytest.approx(whole.state)


@pytest.mark.parametrize(
    ("weather", "transition"),
    [("sunny", 1.0), (None, 1.0), (5, 1.0), ("clear", -1.0), ("clear", math.nan),
     ("clear", math.inf), ("clear", "long"), (b"clear", 1.0)],
)  # fmt: skip
def test_bad_changes_are_refused_and_change_nothing(weather, transition):
    with Weather(seed=1) as it:
        it.change_to("fair_cumulus")
        let_pass(3)
        before = it.snapshot()
        with pytest.raises(InvalidValueError):
            it.change_to(weather, transition)
        assert it.snapshot() == before


@pytest.mark.parametrize(
    "fields",
    [{"state": 2.0}, {"rain_rate": -1.0}, {"wind_from": 400.0}, {"visibility": math.nan},
     {"banks": (1,)}, {"name": ""}, {"humidity": "wet"}, {"lightning": 1.5}],
)  # fmt: skip
def test_weathers_of_ones_own_are_checked(fields):
    with pytest.raises(InvalidValueError):
        WholeWeather(**{"name": "mine", "state": 0.5, **fields})


def test_bad_banks_are_refused():
    for models, base, oktas in (
        (("cotton",), 900.0, 4.0),
        ((), 900.0, 4.0),
        (("cumulus",), -5.0, 4.0),
        (("cumulus",), 900.0, 9.0),
    ):
        with pytest.raises(InvalidValueError):
            CloudBank(models, base, oktas)


# Whose is what


def test_the_games_own_things_are_not_touched():
    with Weather() as weather:
        area = RainArea((5, 5), (20, 10), 7.0)
        wind = Wind((0, 1), 3.0)
        air = Air(31.0, 0.2)
        mine = [esper.create_entity(each) for each in (area, wind, air)]
        weather.change_to("clear")
        weather.change_to("snow", 5.0)
        let_pass(8)
        assert (area.center, area.rain_rate, wind.speed, air.temperature) == (
            (5, 5),
            7.0,
            3.0,
            31.0,
        )
        assert weather.sample((5000, 0, 0)).temperature == 31.0  # the oldest counts
        weather.close()
        assert all(map(esper.entity_exists, mine))
        assert len(esper.get_component(RainArea)) == 1 and not esper.get_component(SkyLayer)


def test_a_game_moves_the_rain_along_and_may_take_it_away():
    with Weather() as weather:
        weather.change_to("showers", center=(100, 200))
        entity = weather.whole.entities["rain"]
        area = esper.component_for_entity(entity, RainArea)
        assert area.center == (100, 200)
        area.center = (9000, 0)
        weather.change_to("thunderstorm", 2.0)
        let_pass(3)
        assert area.center == (9000, 0) and area.rain_rate == 40.0
        esper.delete_entity(entity, immediate=True)
        let_pass(3)
        assert "rain" not in weather.whole.entities
        weather.change_to("steady_rain", 1.0)
        let_pass(2)
        assert weather.sample((0, 0, 0)).rain_rate == pytest.approx(5.0)


def test_nothing_is_there_before():
    with Weather() as weather:
        assert weather.whole is None
        assert presets.WEATHERS is WEATHERS


# Amounts of clouds


def covered(weather: Weather, uid: int, side: float) -> float:
    """Share of a layer's middle that its clouds shade from above: the seeds' ellipses, rastered."""
    state = weather._state
    record = state.clouds.layers[uid]
    layer = next(lay for _, lay in esper.get_component(SkyLayer))
    models = state.models.of_skies(layer.skies, state.uids)
    cells = 220
    at = (np.arange(cells) + 0.5) / cells * 0.6 * side - 0.3 * side
    shaded = np.zeros((cells, cells), bool)
    array = record.array
    for row in range(len(array)):
        kind = array.kinds[array.kind[row]]
        made = state.cloud_shapes.get(models[(kind.sky, kind.model)], kind.number).made
        x = array.x[row] * QUANTUM + record.offset[0]
        z = array.z[row] * QUANTUM + record.offset[1]
        for (cx, _, cz), (width, _, depth) in zip(made.centers, made.sizes, strict=True):
            u = ((at - x - cx) / (0.5 * width)) ** 2
            w = ((at - z - cz) / (0.5 * depth)) ** 2
            near_x, near_z = np.flatnonzero(u < 1.0), np.flatnonzero(w < 1.0)
            if len(near_x) and len(near_z):
                inside = u[near_x][None, :] + w[near_z][:, None] < 1.0
                shaded[np.ix_(near_z, near_x)] |= inside
    return float(shaded.mean())


@pytest.mark.parametrize(
    ("models", "base"),
    [(("cumulus",), 900.0), (("stratocumulus",), 1200.0), (("stratus",), 300.0),
     (("altocumulus",), 3500.0), (("altostratus",), 3000.0), (("cirrostratus",), 8000.0)],
)  # fmt: skip
@pytest.mark.parametrize(
    ("oktas", "low", "high"), [(1.5, 0.7, 2.6), (3.5, 2.5, 4.6), (6.0, 4.9, 7.4), (8.0, 7.4, 8.0)]
)
def test_clouds_cover_as_many_oktas_as_they_are_to(models, base, oktas, low, high):
    shares = []
    for seed in (1, 2):
        with fresh_world(), Weather(seed=seed) as weather:
            bank = CloudBank(models, base, oktas)
            weather.change_to(WholeWeather("x", 0.5, banks=(bank,)))
            esper.process(0.05)
            uid = weather._state.course.layers[0].uid
            overhead = covered(weather, uid, bank.bank().side)
            # At a slant the same clouds cover more.
            shares.append(8.0 * (1.0 - (1.0 - overhead) ** SLANT.get(models[0], 1.0)))
    assert low <= np.mean(shares) <= high, shares


def test_counts_follow_the_share():
    assert count_for(0.0, 1.0, 400.0) == 0
    assert count_for(8.0, 1.0, 400.0) == round(-400.0 * math.log(1.0 - CLOSED))
    assert set(FOOTPRINTS) == set(presets.CLOUD_MODELS)
    assert share_of(9.0) == 1.0
    assert shown_footprint("cumulus") == SLANT["cumulus"] * FOOTPRINTS["cumulus"]
    assert shown_footprint("stratus") == FOOTPRINTS["stratus"]


@settings(deadline=None, max_examples=25)
@given(st.lists(st.tuples(st.sampled_from(NAMES), st.floats(0, 20), st.floats(0, 9)), max_size=6))
def test_any_sequence_of_changes_keeps_everything_finite(changes):
    with fresh_world(), Weather(seed=6) as weather:
        for name, seconds, wait in changes:
            weather.change_to(name, seconds)
            esper.process(wait)
            here = weather.sample((10.0, 0.0, 10.0))
            assert all(math.isfinite(v) for v in here[:2]) and here.visibility > 0.0
            weather.snapshot()


def test_rain_of_a_closed_sky_has_no_edge_within_a_days_walk() -> None:
    """It falls as far as the sheet of cloud reaches, and as hard in most of that."""
    for name in ("steady_rain", "overcast_drizzle", "snow", "blizzard"):
        whole = WEATHERS[name]
        widest = max(bank.bank().side for bank in whole.banks)
        assert whole.rain_radius >= 0.45 * widest
        esper.switch_world(f"wide {name}")
        weather = Weather()
        weather.change_to(name)
        esper.process(0.05)
        here = weather.sample((0.0, 2.0, 0.0))
        there = weather.sample((-9000.0, 2.0, 9000.0))
        assert here.rain_rate + here.snow_rate == pytest.approx(whole.rain_rate)
        assert there.rain_rate + there.snow_rate == pytest.approx(whole.rain_rate)
        weather.close()
        esper.switch_world("default")
        esper.delete_world(f"wide {name}")
