"""The letter and the showers: pure, without a window; and that the walk with it is a fair game."""

from __future__ import annotations

import math
from collections.abc import Iterator

import esper
import numpy as np
import pytest

from demo_game.entities import CEILING, CENTER, RADII, SOFT_EDGE
from demo_game.letter import (
    DRYING,
    GROWING_WET,
    HAND_IN,
    PICK_UP,
    PICKED_UP,
    RUINED_AT,
    Letter,
    State,
    water_rate,
)
from demo_game.letter_words import duration, end_texts, words
from demo_game.place import Place, layout
from demo_game.player import RUN_SPEED, WALK_SPEED
from demo_game.showers import LEAST, MOST, Showers
from tests.worlds import fresh_world
from weather_ecs import Weather
from weather_ecs.components import Occluder, RainArea, Wind
from weather_ecs.presets import PRESETS

TABLE, MAILBOX = (4.0, 1.0, -60.0), (-25.0, 0.5, -160.0)
OPEN = (0.0, 0.5, -100.0)
DT = 1 / 60


def carried() -> Letter:
    letter = Letter(TABLE, MAILBOX)
    assert step(letter, 0.0, at=TABLE) == PICKED_UP
    return letter


def step(letter, dt, rain=0.0, *, at=OPEN, speed=0.0, sheltered=False):
    return letter.update(dt, at, speed=speed, rain_rate=rain, sheltered=sheltered)


def time_to_ruin(rain: float, speed: float, dt: float = DT) -> float:
    letter, time = carried(), 0.0
    while letter.state is State.CARRIED and time < 3600.0:
        step(letter, dt, rain, speed=speed)
        time += dt
    return time


def test_it_lies_on_the_table_until_somebody_comes_near() -> None:
    letter = Letter(TABLE, MAILBOX)
    for at in ((4.0, 0.0, -60.0 + PICK_UP + 0.1), (4.0, -3.0, -60.0), MAILBOX):
        assert step(letter, 1.0, 100.0, at=at) is None
        assert letter.state is State.LYING
    assert letter.water == letter.time == 0.0
    assert letter.goal == (4.0, -60.0)
    assert step(letter, 1.0, 100.0, at=(4.0, 0.2, -60.0 + PICK_UP - 0.1)) == PICKED_UP
    assert letter.state is State.CARRIED
    assert letter.wetness == 0.0
    assert letter.goal == (-25.0, -160.0)


@pytest.mark.parametrize("rain", [2.0, 10.0, 50.0])
def test_in_the_open_it_is_ruined_when_the_paper_is_full(rain: float) -> None:
    # Half of the rain of an hour in 3600 s; standing, and a run of 6.5 m/s, which meets twice it.
    standing = RUINED_AT / (0.5 * rain / 3600.0)
    assert standing == pytest.approx(576.0 / rain)
    assert time_to_ruin(rain, 0.0) == pytest.approx(standing, abs=2 * DT)
    assert time_to_ruin(rain, 6.5) == pytest.approx(standing / 2.0, abs=2 * DT)
    half = carried()
    step(half, standing / 2.0, rain)
    assert half.wetness == pytest.approx(0.5)


def test_running_is_wetter_by_the_second_and_drier_by_the_way() -> None:
    walked, ran = water_rate(25.0, WALK_SPEED), water_rate(25.0, RUN_SPEED)
    assert ran > 1.3 * walked
    assert ran / RUN_SPEED < 0.6 * walked / WALK_SPEED


def test_under_a_roof_it_stays_dry_and_a_wet_one_dries_slowly() -> None:
    letter = carried()
    for _ in range(600):
        step(letter, 0.1, 0.0, sheltered=True)
    assert letter.wetness == 0.0
    step(letter, 10.0, 25.0)
    wet = letter.water
    assert wet == pytest.approx(0.5 * 25.0 / 360.0)
    step(letter, 60.0, 0.0)  # in the open, but not in the rain, nothing changes
    assert letter.water == wet
    step(letter, 30.0, 0.0, sheltered=True)
    assert letter.water == pytest.approx(wet - DRYING / 120.0)
    step(letter, 3600.0, 0.0, sheltered=True)
    assert letter.wetness == 0.0


def test_it_is_delivered_near_the_mailbox_only() -> None:
    letter = carried()
    x, y, z = MAILBOX
    step(letter, 1.0, at=(x + HAND_IN + 0.05, y, z))
    step(letter, 1.0, at=(x, y + 5.0, z))
    assert letter.state is State.CARRIED
    step(letter, 1.0, 1.0, at=(x, y, z + HAND_IN - 0.05))
    assert letter.state is State.DELIVERED
    assert letter.ended
    assert letter.goal is None
    assert letter.time == 3.0
    wetness = letter.wetness
    step(letter, 3600.0, 100.0)  # what is in the box stays as it is
    assert (letter.state, letter.wetness) == (State.DELIVERED, wetness)


def test_a_ruined_letter_is_ruined_also_at_the_mailbox() -> None:
    letter = carried()
    step(letter, 60.0, 50.0, at=MAILBOX)
    assert letter.state is State.RUINED
    assert letter.wetness == 1.0
    step(letter, 3600.0, sheltered=True)
    step(letter, 1.0, at=MAILBOX)
    assert letter.state is State.RUINED


def test_again() -> None:
    letter = carried()
    step(letter, 60.0, 50.0)
    assert letter.state is State.RUINED
    letter.again()
    assert (letter.state, letter.wetness, letter.time) == (State.LYING, 0.0, 0.0)
    assert step(letter, 1.0, at=TABLE) == PICKED_UP
    said = [step(letter, 0.5, 25.0) for _ in range(40)]
    assert [text for text in said if text] == [text for _, text in GROWING_WET]


def test_warnings_come_once_on_the_way_up() -> None:
    letter = carried()
    said = []
    for _ in range(3):
        said += [step(letter, 1.0, 25.0) for _ in range(18)]
        said += [step(letter, 300.0, 0.0, sheltered=True)]
    assert [text for text in said if text] == [text for _, text in GROWING_WET]


def test_frames_of_any_length_give_the_same_letter() -> None:
    rng = np.random.default_rng(4)
    letters = carried(), carried(), carried()
    for rain in rng.uniform(0.0, 30.0, 20).tolist():
        sheltered = rain < 8.0
        fallen = 0.0 if sheltered else rain
        for letter, steps in zip(letters, (60, 60, 7), strict=True):
            for _ in range(steps):
                step(letter, 1.0 / steps, fallen, speed=2.0, sheltered=sheltered)
    assert letters[0].water == letters[1].water
    assert letters[0].water == pytest.approx(letters[2].water, rel=1e-9)
    assert letters[0].water > 0.0


def test_every_state_has_its_words() -> None:
    letter = Letter(TABLE, MAILBOX)
    seen = {words(letter)[0]}
    step(letter, 0.0, at=TABLE)
    for wetness in (0.0, 0.1, 0.4, 0.7, 0.9):
        letter.water = wetness * RUINED_AT
        for rain, sheltered in ((0.0, False), (0.0, True), (9.0, False)):
            step(letter, 0.01, rain, sheltered=sheltered)
            seen.add(words(letter)[0])
    step(letter, 60.0, 50.0)
    seen |= {words(letter)[0], words(delivered(0.5))[0]}
    assert len(seen) == 1 + 5 * 3 + 2
    assert end_texts(letter)[0] != end_texts(delivered(0.0))[0]
    assert len({end_texts(delivered(wet))[1] for wet in (0.0, 0.3, 0.9)}) == 3
    assert duration(12.4) == "12 s"
    assert duration(75.0) == "1 min 15 s"


def delivered(wetness: float) -> Letter:
    letter = carried()
    letter.water = wetness * RUINED_AT
    step(letter, 20.0, at=MAILBOX)
    assert letter.state is State.DELIVERED
    return letter


# Showers and their lulls


def test_lulls_come_every_minute_or_so_and_the_rain_never_jumps() -> None:
    showers = Showers(3)
    times = np.arange(0.0, 1800.0, 0.05)
    share = np.array([showers.share(float(time)) for time in times])
    assert share[times < 30.0].min() == 1.0  # the preset as it is, to begin with
    assert share.max() == 1.0
    assert LEAST - 1e-9 <= share.min() <= MOST + 1e-9
    assert np.abs(np.diff(share)).max() < 0.02
    begins = times[1:][(share[1:] < 0.5) & (share[:-1] >= 0.5)]
    gaps = np.diff(begins)
    assert len(begins) > 20
    assert 59.0 <= gaps.min() < gaps.max() <= 91.0
    assert gaps.std() > 2.0
    assert 0.15 < (share < 0.5).mean() < 0.45
    easing = np.array([showers.is_lull(float(time)) for time in times])
    assert (share[~easing & (share < 1.0)] > share.min()).all()
    assert np.diff(share)[easing[:-1] & easing[1:]].max() <= 1e-12  # only eases or rests


def test_showers_follow_the_seed_and_the_time_alone() -> None:
    times = np.random.default_rng(0).uniform(0.0, 2000.0, 400).tolist()
    one, two, other = Showers(7), Showers(7), Showers(8)
    forward = {time: one.share(time) for time in sorted(times)}
    assert [two.share(time) for time in times] == [forward[time] for time in times]
    assert [other.share(time) for time in times] != [forward[time] for time in times]


# The way from the cabin to the mailbox


@pytest.fixture(scope="module")
def weather(place: Place) -> Iterator[tuple[Weather, RainArea]]:
    with fresh_world():
        area = RainArea(center=CENTER, radii=RADII, soft_edge=SOFT_EDGE, ceiling=CEILING)
        esper.create_entity(area)
        esper.create_entity(Wind((1.0, 0.0), 4.0))
        for _, vertices, indices, dynamic in place.occluders():
            if not dynamic:
                esper.create_entity(Occluder(vertices, indices))
        with Weather() as it:
            yield it, area


def way_from_porch(place: Place) -> np.ndarray:
    """(n, 2) points a tenth of a metre apart: down the steps, past the cabin, along the path."""
    x, _, z = place.porch
    path = place.path[place.path[:, 1] < -64.0]
    corners = np.concatenate([[(x, z), (6.0, -55.0), (-2.0, -58.0)], path, [layout.MAILBOX]])
    lengths = np.hypot(*np.diff(corners, axis=0).T)
    along = np.concatenate([[0.0], np.cumsum(lengths)])
    at = np.arange(0.0, along[-1], 0.1)
    return np.stack([np.interp(at, along, corners[:, k]) for k in (0, 1)], 1)


def carry(place, weather, preset: str, speed: float, showers: float | None = None) -> Letter:
    """Carry a letter all the way; `showers`: leave the porch so many s after a lull has begun."""
    it, area = weather
    letter = Letter(place.letter, place.mailbox)
    letter.update(0.0, place.letter, speed=0.0, rain_rate=0.0, sheltered=True)
    rain, time = Showers(0), 0.0
    if showers is not None:
        time = next(t / 10 for t in range(3000) if rain.is_lull(t / 10)) + showers
    area.rain_rate = PRESETS[preset].rain_rate
    esper.process(0.0)
    for x, z in way_from_porch(place).tolist():
        dt = 0.1 / speed
        time += dt
        y = place.height(x, z)
        here = it.sample((x, y + 1.1, z))
        share = 1.0 if showers is None else rain.share(time)
        letter.update(
            dt, (x, y, z), speed=speed, rain_rate=share * here.rain_rate, sheltered=here.sheltered
        )
    return letter


def test_the_porch_is_dry_and_the_yard_is_not(place, weather) -> None:
    it, area = weather
    area.rain_rate = 25.0
    esper.process(0.0)
    x, y, z = place.porch
    assert it.sample((x, y + 1.1, z)).sheltered
    assert it.sample((place.letter[0], place.letter[1], place.letter[2])).rain_rate == 0.0
    assert it.sample((-6.0, place.height(-6.0, -70.0) + 1.1, -70.0)).rain_rate == 25.0


@pytest.mark.parametrize(
    ("preset", "speed", "showers", "state"),
    [
        ("heavy", WALK_SPEED, None, State.RUINED),
        ("heavy", RUN_SPEED, None, State.DELIVERED),  # just
        ("heavy", WALK_SPEED, 4.0, State.DELIVERED),  # in the gap between showers
        ("heavy", WALK_SPEED, 15.0, State.RUINED),  # too late
        ("cloudburst", RUN_SPEED, None, State.RUINED),
        ("cloudburst", RUN_SPEED, 6.0, State.DELIVERED),
        ("moderate", RUN_SPEED, None, State.DELIVERED),
        ("light", WALK_SPEED, None, State.DELIVERED),
        ("clear", WALK_SPEED, None, State.DELIVERED),
    ],
)
def test_the_skill_is_to_wait(place, weather, preset, speed, showers, state) -> None:
    letter = carry(place, weather, preset, speed, showers)
    assert letter.state is state, letter.wetness


def test_waiting_for_the_lull_is_worth_it(place, weather) -> None:
    assert carry(place, weather, "heavy", RUN_SPEED).wetness > 0.75
    assert carry(place, weather, "heavy", RUN_SPEED, 7.0).wetness < 0.2


def test_how_wet_it_gets_is_what_the_way_and_the_rain_say(place, weather) -> None:
    wet = {
        speed: carry(place, weather, "moderate", speed).wetness for speed in (WALK_SPEED, RUN_SPEED)
    }
    assert 0.05 < wet[RUN_SPEED] < wet[WALK_SPEED] < 1.0
    ratio = (1.0 + WALK_SPEED / 6.5) / (1.0 + RUN_SPEED / 6.5) * RUN_SPEED / WALK_SPEED
    assert wet[WALK_SPEED] / wet[RUN_SPEED] == pytest.approx(ratio, rel=0.01)
    light = carry(place, weather, "light", WALK_SPEED).wetness
    assert light / wet[WALK_SPEED] == pytest.approx(
        PRESETS["light"].rain_rate / PRESETS["moderate"].rain_rate, rel=0.05
    )
    assert math.isclose(carry(place, weather, "clear", WALK_SPEED).wetness, 0.0)
