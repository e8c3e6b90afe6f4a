"""Wet ground in snapshots: kept, restored, and bad states refused."""

from __future__ import annotations

import json

import esper
import numpy as np
import pytest

from tests.worlds import fresh_world, let_pass
from weather_ecs import Weather
from weather_ecs.components import Occluder, RainArea
from weather_ecs.errors import InvalidValueError
from weather_ecs.systems.wet_ground import STEPS, WetGround

pytestmark = pytest.mark.usefixtures("world")


# Snapshots


def wet_weather() -> Weather:
    weather = Weather(seed=5)
    esper.create_entity(RainArea((0, -70), (70, 45), 25.0, soft_edge=12.0))
    esper.create_entity(RainArea((200, 0), (85, 48), 15.0, soft_edge=24, velocity=(5, 0)))
    return weather


def test_a_snapshot_holds_the_wet_ground_and_goes_on_alike():
    with wet_weather() as first:
        let_pass(47.3, 0.1)
        data = first.snapshot()
        assert len(data) < 4096
        assert first.snapshot() == data
        points = [(x, 0.0, z) for x in range(-80, 400, 37) for z in (-80, -30, 10)]
        wet = [first.sample(p).wetness for p in points]
        let_pass(31, 0.1)
        later = first.snapshot()
    with fresh_world(), Weather() as second:
        second.restore(data)
        assert [second.sample(p).wetness for p in points] == wet
        assert second.snapshot() == data
        let_pass(31, 0.1)
        assert second.snapshot() == later


def test_restoring_replaces_the_ground_and_says_so():
    with wet_weather() as weather:
        dry = weather.snapshot()
        let_pass(30)
        before = weather._frame().wetness.number
        assert weather.sample((0, 0, -70)).wetness > 0.0
        weather.restore(dry)
        assert weather.sample((0, 0, -70)).wetness == 0.0
        assert weather._frame().wetness.number != before


def test_neither_asking_nor_occluders_show_in_a_snapshot():
    def run(asks: bool) -> bytes:
        with fresh_world(), wet_weather() as weather:
            if asks:
                vertices = np.eye(3) * 9.0 + (0, 5, 0)
                esper.create_entity(Occluder(vertices, [0, 1, 2], dynamic=True))
            for _ in range(50):
                esper.process(0.3)
                if asks:
                    weather.sample((0, 0, -70))
                    weather._frame()
            return weather.snapshot()

    assert run(True) == run(False)


def state() -> dict:
    with fresh_world(), wet_weather() as weather:
        let_pass(20)
        return json.loads(json.dumps(weather._state.wet_ground.state()))


GOOD = state()


def test_a_state_comes_back():
    ground = WetGround.from_state(GOOD)
    assert json.loads(json.dumps(ground.state())) == GOOD
    assert ground.steps in range(STEPS)


AREA = [0, [0, 0], [1, 1], 0, 5.0, 1, 400]
LEVEL = {
    "level": 0,
    "places": [[0], [0]],
    "codes": "00" * 128,
    "resting": {"ages": [5], "codes": "a0" + "00" * 63, "places": [[1], [0]]},
    "melt": 0.0,
    "rows": [],
    "since": GOOD["ticks"] - 3,
    "way": [[2, [AREA]], [1, [AREA], [[0, 1, 4.0]]]],
}
NONE = {"ages": [], "codes": "", "places": [[], []]}
RAINED = {**LEVEL, "since": GOOD["ticks"], "way": [], "rows": [AREA]}


def test_the_level_that_the_bad_ones_are_made_of_is_good():
    WetGround.from_state({**GOOD, "levels": [LEVEL]})
    WetGround.from_state({**GOOD, "levels": [{**LEVEL, "places": [[], []], "codes": ""}]})
    WetGround.from_state({**GOOD, "levels": [RAINED]})


BAD = [
    ("steps", STEPS),
    ("steps", -1),
    ("ticks", 1.5),
    ("melt", -1.0),
    ("melt", 0),
    ("levels", {}),
    ("levels", [1]),
    ("levels", [LEVEL] * 2),
    ("levels", [{k: v for k, v in LEVEL.items() if k != "codes"}]),
    *[
        ("levels", [{**RAINED, name: value}])
        for name, value in (
            ("rows", None),
            ("rows", [AREA[:6]]),
            ("rows", [[0, [0, 0], [1, 1], 0, 0.0, 1, 400]]),
            ("rows", [[0, [0, 0], [1, 2], 0, 5.0, 1, 400]]),
            ("rows", [[0.5, [0, 0], [1, 1], 0, 5.0, 1, 400]]),
            ("rows", [AREA, AREA]),
        )
    ],
    *[
        ("levels", [{**LEVEL, name: value}])
        for name, value in (
            ("since", 10**9),
            ("rows", [AREA]),
            ("way", None),
            ("way", [[3]]),
            ("way", [[2, [AREA]]]),
            ("way", [[4, [AREA]]]),
            ("way", [[3, [AREA]], [0, [AREA]]]),
            ("way", [[3.0, [AREA]]]),
            ("way", [[3, [AREA], []]]),
            ("way", [[3, [AREA], [[0, 1]]]]),
            ("way", [[3, [AREA], [[0, 1, 0.0]]]]),
            ("way", [[1, [AREA]]] * 7),
            ("melt", 2.0),
            ("melt", "fast"),
            ("level", 99),
            ("level", 0.0),
            ("codes", "00" * 127),
            ("codes", "zz" * 128),
            ("codes", "ff" * 128),
            ("codes", 5),
            ("places", [[0], [2**40]]),
            ("places", [[0, 0], [0, 0]]),
            ("places", [[0]]),
            ("places", [[0], [0.5]]),
            ("places", 7),
            ("resting", None),
            ("resting", {**LEVEL["resting"], "ages": [-1]}),
            ("resting", {**LEVEL["resting"], "ages": [5000]}),
            ("resting", {**LEVEL["resting"], "ages": []}),
            ("resting", {**LEVEL["resting"], "codes": "01" + "00" * 63}),
            ("resting", {**LEVEL["resting"], "codes": "00" * 64}),
            ("resting", {**LEVEL["resting"], "places": [[0], [0]]}),
        )
    ],
    ("levels", [{**RAINED, "rows": [], "places": [[], []], "codes": "", "resting": NONE}]),
    ("levels", [{**LEVEL, "places": [[1, -1], [0, 0]], "codes": "00" * 256}]),
]


@pytest.mark.parametrize(("name", "value"), BAD)
def test_bad_states_are_refused(name, value):
    with pytest.raises(InvalidValueError):
        WetGround.from_state({**GOOD, name: value})
    with pytest.raises(InvalidValueError):
        WetGround.from_state({k: v for k, v in GOOD.items() if k != name})
