"""`WetLevel`: what areas of about one size have rained, entered in leaps or not."""

from __future__ import annotations

import math

import numpy as np
import pytest

from weather_ecs.errors import InvalidValueError
from weather_ecs.frame import AREA_DTYPE
from weather_ecs.physics.ground_law import WATER, GroundLaw, SnowLaw
from weather_ecs.physics.wetness import MM_PER_S
from weather_ecs.systems.wet_level import LONGEST, MOST_STRETCHES, NO_AREAS, WetLevel
from weather_ecs.systems.wet_tiles import level_of

RADIUS = 20.0
LEVEL = level_of(RADIUS, RADIUS)


def rows(x: float = 0.0, rate: float = 10.0) -> np.ndarray:
    found = np.array([(1, (x, 0.0), (RADIUS, RADIUS), 0.0, rate, 5.0, 400.0)], AREA_DTYPE)
    found.setflags(write=False)
    return found


def ticked(level: WetLevel, areas: np.ndarray, ticks: int, law: GroundLaw = WATER) -> int:
    """Let ticks pass with the same areas; returns the number of the last."""
    last = level.since + level._pending
    for _ in range(ticks):
        last += 1
        level.tick(areas, last, law)
    return last


@pytest.mark.parametrize("ticks", [1, LONGEST - 1, LONGEST, LONGEST + 1, 3 * LONGEST + 7])
def test_steady_rain_wets_as_the_law_has_it(ticks: int) -> None:
    level = WetLevel(LEVEL, 0)
    last = ticked(level, rows(), ticks)
    wanted = WATER.settle_one(0.0, 10.0 * MM_PER_S, float(ticks))
    assert level.at(0.0, 0.0, 0.0, last) == pytest.approx(wanted, rel=5e-3)
    assert level.at(500.0, 0.0, 0.0, last) == 0.0
    assert level.since == LONGEST * (ticks // LONGEST)


def test_many_places_are_as_one_by_one_whether_it_stood_or_moved() -> None:
    rng = np.random.default_rng(4)
    x, z = rng.uniform(-40.0, 60.0, (2, 60))
    y = np.zeros(60)
    for way in (0.0, 0.7):
        level = WetLevel(LEVEL, 0)
        for k in range(1, 10):
            level.tick(rows(way * k), k)
        found = level.many(x, y, z, 9)
        single = [level.at(*place, 9) for place in zip(x, y, z, strict=True)]
        assert found == pytest.approx(single, abs=1e-9)
        assert found.max() > 0.01


def test_an_area_that_passes_leaves_a_track_and_less_of_it_behind() -> None:
    level = WetLevel(LEVEL, 0)
    for k in range(1, 61):
        level.tick(rows(2.0 * k), k)
    behind, here, ahead = (level.at(x, 0.0, 0.0, 60) for x in (60.0, 130.0, 175.0))
    assert ahead == 0.0
    assert behind > 2.0 * here > 0.0
    # Less than under an area that stood for as long as it takes to pass: an edge is soft.
    stood = WATER.settle_one(0.0, 10.0 * MM_PER_S, 2.0 * RADIUS / 2.0)
    assert 0.7 * stood < behind < stood


def test_few_stretches_are_kept_however_it_changes() -> None:
    level = WetLevel(LEVEL, 0)
    for k in range(1, 40):
        level.tick(rows(rate=10.0 + 5.0 * (k % 3)), k)
        assert len(level.stretches) <= MOST_STRETCHES
    mean = WATER.settle_one(0.0, 15.0 * MM_PER_S, 39.0)
    assert level.at(0.0, 0.0, 0.0, 39) == pytest.approx(mean, rel=0.03)


def test_it_is_dry_before_rain_and_long_after() -> None:
    level = WetLevel(LEVEL, 0)
    assert level.is_dry
    last = ticked(level, rows(rate=0.5), 3)
    assert not level.is_dry
    while not level.is_dry:
        last = ticked(level, NO_AREAS, 1)
        assert last < 36_000
    assert level.at(0.0, 0.0, 0.0, last) == 0.0


def test_another_melt_counts_from_then_on() -> None:
    level = WetLevel(LEVEL, 0, SnowLaw())
    last = ticked(level, rows(), 30, SnowLaw())
    lies = 30.0 * 10.0 * MM_PER_S
    assert level.at(0.0, 0.0, 0.0, last) == pytest.approx(lies, rel=5e-3)
    last = ticked(level, NO_AREAS, 10, SnowLaw(0.004))
    assert level.at(0.0, 0.0, 0.0, last) == pytest.approx(lies - 0.04, rel=0.02)


def test_what_the_gpu_gets_is_the_same_until_something_is_entered() -> None:
    level, areas = WetLevel(LEVEL, 0), rows()
    ticked(level, areas, 5)
    data = level.data()
    ticked(level, areas, 5)
    assert level.data() is data
    assert (data.since, len(data.places)) == (0, 0)  # the rows say the rest
    ticked(level, areas, LONGEST)
    assert level.data() is not data
    assert level.data().since == LONGEST and level.data().water.max() > 0.01
    # One on its way is as it is now.
    moving = WetLevel(LEVEL, 0)
    for k in range(1, 6):
        moving.tick(rows(2.0 * k), k)
    assert moving.data().since == 5
    assert moving.data().water.max() == pytest.approx(5.0 * 10.0 * MM_PER_S, rel=0.1)


@pytest.mark.parametrize("way", [0.0, 0.7])
def test_it_goes_on_alike_from_its_state(way: float) -> None:
    level = WetLevel(LEVEL, 0)
    for k in range(1, 25):
        level.tick(rows(way * k, 10.0 if k < 12 else 14.0), k)
    other = WetLevel.from_state(level.state(), 24, lambda melt: WATER)
    assert other.state() == level.state()
    for k in range(25, 60):
        for each in (level, other):
            each.tick(rows(way * k, 14.0), k)
    assert other.state() == level.state()
    assert other.at(3.0, 0.0, 1.0, 59) == level.at(3.0, 0.0, 1.0, 59)


@pytest.mark.parametrize(
    ("field", "value"),
    [
        ("melt", 2.0), ("melt", math.inf), ("since", 9), ("since", -1), ("rows", [[1]]),
        ("way", [[0, []]]), ("way", [[1, []]] * 7), ("way", {}), ("level", 99), ("codes", "zz"),
    ],
)  # fmt: skip
def test_bad_states_are_refused(field: str, value: object) -> None:
    level = WetLevel(LEVEL, 0)
    ticked(level, rows(), 3)
    state = level.state()
    assert WetLevel.from_state(state, 3, lambda melt: WATER).state() == state
    with pytest.raises(InvalidValueError):
        WetLevel.from_state({**state, field: value}, 3, lambda melt: WATER)
