"""Quality levels, and the controller that glides between them."""

from __future__ import annotations

import math
import random
from collections.abc import Callable

import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from weather_ecs import Weather
from weather_ecs.errors import InvalidValueError
from weather_ecs.quality import (
    LEVELS,
    LOWEST_BUDGET,
    QUALITIES,
    STILL,
    AutoQuality,
    FrameCost,
    QualitySettings,
    settings_for,
)
from worlds import fresh_world

TARGET = 1000.0 / 60.0


def test_levels_grow():
    low, medium, high, ultra = (LEVELS[name] for name in QUALITIES[:4])
    assert [x.drops for x in (low, medium, high, ultra)] == [6_000, 14_000, 50_000, 120_000]
    assert [x.containers for x in (low, medium, high, ultra)] == [2, 4, 8, 16]
    for less, more in ((low, medium), (medium, high), (high, ultra)):
        assert less.heightmap_size < more.heightmap_size
    for name in QUALITIES:
        assert settings_for(name).name == name
        assert 0.0 < settings_for(name).budget <= 1.0


@pytest.mark.parametrize("name", ["best", "LOW", "", None, 3, b"low", ["low"], {}])
def test_unknown_levels_are_refused_with_the_names_there_are(name):
    with pytest.raises(InvalidValueError, match=r"quality.*low, medium, high, ultra, auto"):
        settings_for(name)


def test_a_game_may_bring_its_own_settings():
    own = QualitySettings("film", 1_000_000, 8, 2048, True)
    assert settings_for(own) is own
    assert settings_for(LEVELS["high"]) is LEVELS["high"]
    with fresh_world(), Weather(quality=own) as weather:
        assert weather.quality == weather.stats.quality == "film"
        weather.quality = "low"
        assert weather.quality == "low"
        weather.quality = QualitySettings("less", 1000, 1, 64, False)
        assert weather.quality == "less"
        with pytest.raises(InvalidValueError, match=r"QualitySettings\.drops"):
            weather.quality = QualitySettings("none", 0, 1, 64, False)
        assert weather.quality == "less"


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("name", "auto"),
        ("name", ""),
        ("name", None),
        ("name", []),
        ("drops", 0),
        ("drops", 8_000_001),
        ("drops", 1000.0),
        ("drops", True),
        ("containers", 0),
        ("heightmap_size", 8),
        ("heightmap_size", "512"),
        ("veil", 1),
        ("budget", 0.0),
        ("budget", math.nan),
    ],
)
def test_bad_settings_are_refused_by_field(field, value):
    own = {"name": "film", "drops": 1000, "containers": 2, "heightmap_size": 64, "veil": False}
    with pytest.raises(InvalidValueError, match=rf"QualitySettings\.{field}"):
        settings_for(QualitySettings(**(own | {field: value})))


@pytest.mark.parametrize("target", [0, -1, math.nan, math.inf, "fast"])
def test_bad_targets(target):
    with pytest.raises(InvalidValueError):
        AutoQuality(target)


def test_auto_begins_as_medium_and_ends_at_low_and_ultra():
    auto = AutoQuality()
    assert round(auto.settings().drops * auto.settings().budget) == LEVELS["medium"].drops
    assert auto.settings().drops * LOWEST_BUDGET == LEVELS["low"].drops
    assert auto.settings().drops == LEVELS["ultra"].drops


Machine = Callable[[float, int], tuple[float, float, float]]


def run(auto: AutoQuality, machine: Machine, frames: int) -> list[float]:
    """Feed `frames` frames of a machine that says (frame, GPU, CPU) ms for a budget."""
    trace = []
    for number in range(frames):
        auto.feed(*machine(auto.budget, number))
        trace.append(auto.budget)
    return trace


def machine(cost: float, other: float, sync: bool = False, noise: float = 0.0) -> Machine:
    """`cost` ms for the whole budget, `other` ms for the rest of the game."""
    rng = random.Random(5)

    def frame(budget: float, number: int) -> tuple[float, float, float]:
        gpu = cost * budget * (1.0 + noise * rng.uniform(-1, 1)) + 0.05
        rest = other * (1.0 + noise * rng.uniform(-1, 1))
        total = gpu + 0.3 + rest
        if sync:
            total = max(total, TARGET)
        return total, gpu, 0.3

    return frame


def steps_are_small(trace: list[float]) -> bool:
    return all(
        abs(b / a - 1.0) <= AutoQuality.RATE + 1e-12 for a, b in zip(trace, trace[1:], strict=False)
    )


@pytest.mark.parametrize("noise", [0.0, 0.1, 0.3])
@pytest.mark.parametrize(
    ("cost", "other"), [(20.0, 10.0), (100.0, 6.0), (300.0, 10.0), (12.0, 8.0), (40.0, 14.0)]
)
def test_it_settles_where_the_frame_fits(cost, other, noise):
    auto = AutoQuality()
    trace = run(auto, machine(cost, other, noise=noise), 1500)
    assert steps_are_small(trace)
    end = trace[-500:]
    assert max(end) <= min(end) * (1.02 + noise)
    frame = machine(cost, other)(auto.budget, 0)[0]
    assert frame <= TARGET * 1.06 or auto.budget == LOWEST_BUDGET
    if auto.budget < 0.99 and auto.budget > LOWEST_BUDGET:
        assert frame >= TARGET * 0.75


def test_a_fast_machine_gets_all():
    assert run(AutoQuality(), machine(3.0, 5.0), 400)[-1] == 1.0
    assert run(AutoQuality(), machine(3.0, 5.0, sync=True), 400)[-1] == 1.0


def test_a_slow_machine_gets_the_least():
    trace = run(AutoQuality(), machine(900.0, 5.0), 400)
    assert trace[-1] == LOWEST_BUDGET
    assert steps_are_small(trace)


def test_a_game_that_is_slow_by_itself_keeps_its_rain():
    auto = AutoQuality()
    start = auto.budget
    trace = run(auto, machine(8.0, 40.0), 600)
    assert set(trace) == {start}


def test_behind_vertical_sync_it_does_not_swing():
    """No room is to be seen there: 13 ms of game leave 3.7 ms, and the wait hides it."""
    for noise in (0.0, 0.05):
        trace = run(AutoQuality(), machine(40.0, 13.0, sync=True, noise=noise), 6000)
        assert steps_are_small(trace)
        late = trace[1500:]
        turns = sum(
            (b - a) * (c - b) < 0 for a, b, c in zip(late, late[1:], late[2:], strict=False)
        )
        assert turns <= 40
        assert max(late) <= 1.5 * min(late)


def test_when_the_scene_gets_lighter_the_rain_comes_back():
    auto = AutoQuality()
    low = run(auto, machine(100.0, 12.0), 800)[-1]
    high = run(auto, machine(30.0, 4.0), 800)[-1]
    assert high > 2.0 * low


@pytest.mark.parametrize(
    "bad",
    [
        (math.nan, 1.0, 1.0),
        (10.0, math.nan, 1.0),
        (10.0, 1.0, math.nan),
        (0.0, 1.0, 1.0),
        (-5.0, 1.0, 1.0),
        (math.inf, 1.0, 1.0),
        (60_000.0, 1.0, 1.0),
        (10.0, 0.0, 0.0),
        (10.0, -1.0, 2.0),
        (10.0, 5.0, -1.0),
        (10.0, math.inf, 0.0),
    ],
)
def test_frames_that_say_nothing_change_nothing(bad):
    one, other = AutoQuality(), AutoQuality()
    frame = machine(60.0, 8.0, noise=0.1)
    for number in range(300):
        figures = frame(one.budget, number)
        assert one.feed(*figures) == other.feed(*figures)
        other.feed(*bad)
    assert one.budget == other.budget
    assert one.budget != AutoQuality().budget


@settings(deadline=None, max_examples=40)
@given(st.lists(st.tuples(st.floats(), st.floats(), st.floats()), max_size=150))
def test_any_figures_keep_the_budget_in_its_range(trace):
    auto = AutoQuality()
    before = auto.budget
    for figures in trace:
        after = auto.feed(*figures)
        assert LOWEST_BUDGET <= after <= 1.0
        assert abs(after / before - 1.0) <= AutoQuality.RATE + 1e-12
        before = after


def test_the_same_figures_give_the_same_budget():
    a, b = (run(AutoQuality(), machine(70.0, 9.0, noise=0.3), 500) for _ in range(2))
    assert a == b


def test_a_game_that_never_calls_process_is_told_once(caplog):
    still, moving = FrameCost(), FrameCost()
    moving.processed()
    for draw in range(3 * STILL):
        assert not caplog.records or draw >= STILL
        still.begin(draw / 60)
        moving.begin(draw / 60)
    (record,) = caplog.records
    assert record.name == "weather_ecs" and "esper.process(dt) never ran" in record.getMessage()
