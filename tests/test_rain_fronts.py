"""Showers that begin and end in a living weather: samples, ground, gauges, snapshots; no OpenGL."""

from __future__ import annotations

import copy
from typing import Any

import esper
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from tests.worlds import fresh_world
from weather_ecs import Weather
from weather_ecs.components import RainArea, RainGauge
from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.front import LONG, SETTLED, water_arrived
from weather_ecs.systems.rain_fronts import RainFronts

pytestmark = pytest.mark.usefixtures("world")

CEILING, RATE = 100.0, 25.0


def make(rate: float, **fields: Any) -> RainArea:
    area = RainArea(
        (0, 0), (60, 60), rate, ceiling=CEILING, onset=fields.pop("onset", 1.0), **fields
    )
    esper.create_entity(area)
    return area


def run(seconds: float) -> None:
    for _ in range(round(seconds / 0.25)):
        esper.process(0.25)


def test_an_area_that_is_new_has_its_rain_at_once():
    weather = Weather()
    make(RATE)
    esper.process(0.1)
    assert weather.sample((0, 0, 0)).rain_rate == RATE
    assert weather._frame().fronts == {}


def test_a_shower_that_begins_comes_down_by_its_drops_speeds():
    weather = Weather()
    area = make(0.0)
    run(5)
    area.rain_rate = RATE
    assert weather.sample((0, 0, 0)).rain_rate == 0.0
    assert weather._frame().fronts == {0: (0.0, LONG, 0.0, 0.0)}
    seen = []
    for second in range(1, 60):
        run(1)
        rates = [weather.sample((3, y, 1)).rain_rate for y in (0.0, 40.0, 99.9)]
        expected = water_arrived([100.0, 60.0, 0.1], (second, LONG, 0.0, 0.0), RATE) * RATE
        assert rates == pytest.approx(expected.tolist())
        seen.append(rates[0])
    assert seen[9] == 0.0 < seen[11]  # 100 m at 9.4 m/s
    assert np.all(np.diff(seen) >= 0.0) and seen[-1] == RATE
    run(100)
    assert weather._frame().fronts == {} and weather._state.fronts._fronts == {}


def test_one_that_ends_rains_out_small_drops_last():
    weather = Weather()
    area = make(RATE)
    run(5)
    area.rain_rate = 0.0
    assert weather.sample((0, 0, 0)).rain_rate == pytest.approx(RATE)
    run(20)
    expected = float(water_arrived(100.0, (-1.0, 20.0, 0.0, 0.0), RATE)) * RATE
    assert weather.sample((0, 0, 0)).rain_rate == pytest.approx(expected)
    assert 0.0 < expected < 0.5 * RATE
    assert weather._frame().areas["rain_rate"].tolist() == [RATE]  # it is still in the air
    assert weather.sample((0, 0, 0)).visibility > 1000.0
    run(150)
    assert weather._frame().areas["rain_rate"].tolist() == [0.0]
    assert weather._frame().fronts == {}
    assert weather.sample((0, 0, 0)).rain_rate == 0.0


def test_a_short_shower_passes_a_height_as_one():
    """What fell for 3 s: spells before and after it; the water is that of 3 s in all."""
    weather = Weather()
    area = make(0.0)
    run(1)
    area.rain_rate = RATE
    run(3)
    area.rain_rate = 0.0
    total = 0.0
    for _ in range(400):
        esper.process(0.25)
        total += weather.sample((0, 0, 0)).rain_rate * 0.25
    assert total == pytest.approx(3.0 * RATE, rel=0.02)


def test_a_third_spell_runs_together_with_the_oldest():
    weather = Weather()
    area = make(0.0)
    for rate in (RATE, 0.0, RATE, 0.0, RATE, 0.0):
        run(2)
        area.rain_rate = rate
    run(2)
    (dry,) = weather._frame().fronts.values()
    assert dry == pytest.approx((4.0, LONG, -1.0, 2.0))


def test_the_onset_is_a_share_of_the_fall_time():
    weather = Weather()
    quick, none = make(0.0, onset=0.25), make(0.0, onset=0.0)
    run(1)
    quick.rain_rate, none.rain_rate = 10.0, 5.0
    assert weather.sample((0, 0, 0)).rain_rate == 5.0
    run(5)
    expected = float(water_arrived(100.0, (20.0, LONG, 0.0, 0.0), 10.0)) * 10.0
    assert weather.sample((0, 0, 0)).rain_rate == pytest.approx(5.0 + expected)
    none.rain_rate = 0.0
    assert weather.sample((0, 0, 0)).rain_rate == pytest.approx(expected)


def test_changes_between_two_rains_are_immediate():
    weather = Weather()
    area = make(RATE)
    run(1)
    area.rain_rate = 2.0
    assert weather.sample((0, 0, 0)).rain_rate == 2.0
    assert weather._frame().fronts == {}


def test_the_gauge_integrates_what_comes_down():
    weather = Weather()
    area, gauge = make(0.0), RainGauge((0, 0, 0), window=200.0)
    esper.create_entity(gauge)
    run(1)
    area.rain_rate = RATE
    for _ in range(400):
        esper.process(0.1)
    times = np.arange(400) * 0.1 + 0.05
    curve = [float(water_arrived(100.0, (t, LONG, 0.0, 0.0), RATE)) for t in times]
    assert gauge.rate * 41.0 == pytest.approx(RATE * sum(curve) * 0.1, rel=0.01)
    assert weather.stats.rain_rate_here > 0.0


def test_the_ground_gets_wet_when_the_rain_is_down():
    weather = Weather()
    area = make(0.0)
    run(2)
    area.rain_rate = RATE
    run(9)
    assert weather.sample((0, 0, 0)).wetness == 0.0
    run(60)
    assert weather.sample((0, 0, 0)).wetness > 0.1


@pytest.mark.parametrize("moments", [(3.0, 8.0), (3.0, 30.0), (12.5, 0.35)])
def test_a_snapshot_half_way_goes_on_to_the_same_bytes(moments: tuple[float, float]) -> None:
    before, after = moments
    weather = Weather(seed=2)
    area = make(0.0, velocity=(1.0, 0.0))
    run(2)
    area.rain_rate = RATE
    run(before)
    area.rain_rate = 0.0  # not yet seen by a step
    data = weather.snapshot()
    assert len(data) < 1500
    with fresh_world(), Weather(seed=9) as twin:
        twin.restore(data)
        assert twin.snapshot() == data
        run(after)
        expected = twin.snapshot()
        rates = [twin.sample((x, 0, 0)).rain_rate for x in range(0, 60, 9)]
        fronts = dict(twin._frame().fronts)
    run(after)
    assert weather.snapshot() == expected
    assert [weather.sample((x, 0, 0)).rain_rate for x in range(0, 60, 9)] == rates
    assert dict(weather._frame().fronts) == fronts


def test_areas_that_go_are_forgotten():
    weather = Weather()
    area = RainArea((0, 0), (9, 9), 0.0)
    entity = esper.create_entity(area)
    run(1)
    area.rain_rate = 3.0
    run(1)
    assert weather._state.fronts._fronts
    esper.delete_entity(entity, immediate=True)
    run(1)
    assert weather._state.fronts.state()["fronts"] == weather._state.fronts.state()["rates"] == []


@settings(
    deadline=None, max_examples=25, suppress_health_check=[HealthCheck.function_scoped_fixture]
)
@given(
    st.lists(st.tuples(st.sampled_from([0.0, 1.0, 50.0]), st.floats(0.0, 10.0)), max_size=12),
    st.floats(0.0, 1.0),
)
def test_any_changes_stay_within_the_rates(
    changes: list[tuple[float, float]], onset: float
) -> None:
    with fresh_world(), Weather() as weather:
        area = make(50.0, onset=onset)
        for rate, seconds in changes:
            area.rain_rate = rate
            esper.process(seconds)
            assert 0.0 <= weather.sample((0, 0, 0)).rain_rate <= 50.0
            found = RainFronts.from_state(weather._state.fronts.state())
            assert found.state() == weather._state.fronts.state()


def good() -> dict[str, Any]:
    spells = [[None, 4], [7, None]]
    return {"steps": 9, "rates": [[1, 0.0], [3, 2.5]], "fronts": [[1, 25.0, spells]]}


@pytest.mark.parametrize(
    ("path", "value"),
    [
        (("steps",), 2),
        (("steps",), -1),
        (("steps",), 1.5),
        (("rates",), 5),
        (("rates", 0, 0), 3),
        (("rates", 0, 1), -1.0),
        (("rates", 0, 1), 2.0),  # it rains: the last spell has ended
        (("fronts", 0, 0), 2),
        (("fronts", 0, 1), 0.0),
        (("fronts", 0, 1), 2e4),
        (("fronts", 0, 2), []),
        (("fronts", 0, 2, 0), [None]),
        (("fronts", 0, 2, 0, 1), 8),
        (("fronts", 0, 2, 0, 1), None),
        (("fronts", 0, 2, 1, 0), None),
        (("fronts", 0, 2, 1, 1), True),
    ],
)
def test_bad_fronts_are_refused(path: tuple[Any, ...], value: Any) -> None:
    state = good()
    assert RainFronts.from_state(copy.deepcopy(state)).state() == state
    at: Any = state
    for key in path[:-1]:
        at = at[key]
    at[path[-1]] = value
    with pytest.raises(InvalidValueError, match="fronts"):
        RainFronts.from_state(state)
    with pytest.raises(InvalidValueError, match="fronts"):
        RainFronts.from_state({"steps": 1})


def test_a_settled_area_has_no_spells():
    fronts = RainFronts()
    assert fronts.dry(0, RainArea((0, 0), (5, 5)), 0.0) == SETTLED
