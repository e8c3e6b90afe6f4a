"""Snow on things that move, asked of a field that says how much falls where."""

from __future__ import annotations

import math
from dataclasses import replace
from types import SimpleNamespace

import numpy as np
import pytest

from weather_ecs.components import Occluder
from weather_ecs.frame import FrameData
from weather_ecs.physics.snow_cover import DEGREE_DAY
from weather_ecs.systems.thing_snow import ThingSnow

RATE = 7.2  # mm/h of water, 2 mm in 1000 s
FROST = FrameData()
FROST = replace(
    FROST, air=replace(FROST.air, wet_bulb=-3.0), flakes=replace(FROST.flakes, settling=1.0)
)


class Field:
    """Snow falls everywhere; keeps where it was asked."""

    def __init__(self) -> None:
        self.asked: list[tuple[float, float, float]] = []

    def at(self, x: float, y: float, z: float) -> SimpleNamespace:
        self.asked.append((x, y, z))
        return SimpleNamespace(snow_rate=RATE)


def box(transform: np.ndarray | None = None) -> Occluder:
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (0, 2) for z in (-3, 3)], np.float32)
    return Occluder(corners, np.array([0, 1, 3, 0, 3, 2], np.uint32), transform)


def later(seconds: float, frame: FrameData = FROST) -> FrameData:
    return replace(frame, time=seconds)


def leaning(angle: float, x: float = 0.0, y: float = 0.0, z: float = 0.0) -> np.ndarray:
    """Turned about z, then moved."""
    c, s = math.cos(angle), math.sin(angle)
    return np.array([[c, -s, 0, x], [s, c, 0, y], [0, 0, 1, z], [0, 0, 0, 1.0]])


def test_two_millimetres_of_water_lie_two_centimetres_deep() -> None:
    snow, thing, field = ThingSnow(), box(), Field()
    assert snow.depth(thing, field, later(50.0)) == 0.0  # the first question begins the count
    assert snow.depth(thing, field, later(1050.0)) == pytest.approx(0.02)
    assert snow.depth(thing, field, later(1050.0)) == pytest.approx(0.02)
    assert field.asked == [(0.0, pytest.approx(2.3), 0.0)]  # 0.3 m over its top, once


def test_every_thing_has_snow_of_its_own() -> None:
    snow, early, late, field = ThingSnow(), box(), box(), Field()
    snow.depth(early, field, later(0.0))
    snow.depth(late, field, later(500.0))
    assert snow.depth(early, field, later(1000.0)) == pytest.approx(0.02)
    assert snow.depth(late, field, later(1000.0)) == pytest.approx(0.01)


def test_a_clock_set_back_begins_anew() -> None:
    snow, thing, field = ThingSnow(), box(), Field()
    snow.depth(thing, field, later(0.0))
    assert snow.depth(thing, field, later(1000.0)) > 0.0
    assert snow.depth(thing, field, later(400.0)) == 0.0
    assert snow.depth(thing, field, later(900.0)) == pytest.approx(0.01)


def test_what_melts_is_less_and_never_below_nothing() -> None:
    mild = replace(FROST, air=replace(FROST.air, wet_bulb=0.25))
    snow, thing, field = ThingSnow(), box(), Field()
    snow.depth(thing, field, later(0.0, mild))
    left = (RATE / 3600.0 - 0.25 * DEGREE_DAY) * 1000.0 / 100.0
    assert snow.depth(thing, field, later(1000.0, mild)) == pytest.approx(left)
    warm = replace(FROST, air=replace(FROST.air, wet_bulb=5.0))
    assert snow.depth(thing, field, later(2000.0, warm)) == 0.0


def test_snow_slides_off_what_leans_and_none_stays_there() -> None:
    snow, thing, field = ThingSnow(), box(), Field()
    snow.depth(thing, field, later(0.0))
    lay = snow.depth(thing, field, later(1000.0))
    thing.transform = leaning(math.radians(70.0))  # its own up points up by 0.34
    assert snow.depth(thing, field, later(1000.5)) == pytest.approx(lay / math.e)


def test_the_top_of_a_leaning_thing_is_its_highest_corner() -> None:
    field, turn = Field(), math.radians(30.0)
    snow, thing = ThingSnow(), box(leaning(turn, 10.0, 5.0, -4.0))
    snow.depth(thing, field, later(0.0))
    snow.depth(thing, field, later(1.0))
    middle = 10.0 - math.sin(turn), -4.0
    highest = 5.0 + math.sin(turn) + 2.0 * math.cos(turn)
    (x, y, z), *_ = field.asked
    assert (x, y, z) == pytest.approx((middle[0], highest + 0.3, middle[1]), abs=1e-6)


def test_a_thing_that_draws_itself_is_asked_where_it_stands() -> None:
    thing = Occluder(draw=lambda *_: None, transform=leaning(0.0, 3.0, 1.0, 2.0))
    snow, field = ThingSnow(), Field()
    snow.depth(thing, field, later(0.0))
    assert snow.depth(thing, field, later(500.0)) == pytest.approx(0.01)
    assert field.asked == [(3.0, 1.3, 2.0)]
