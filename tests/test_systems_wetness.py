"""`WetnessSystem`: what it shows the grounds, and when."""

from __future__ import annotations

import esper
import numpy as np
import pytest

from weather_ecs.components import Air, RainArea, SnowFlakes
from weather_ecs.frame import SnowLook
from weather_ecs.physics.wetness import MM_PER_S
from weather_ecs.systems import WeatherState, WetnessSystem
from weather_ecs.systems.wetness import settling

pytestmark = pytest.mark.usefixtures("world")

HERE = (0.0, 0.0, 0.0)


class Stepper:
    """A state and the system alone, a fixed step at a time."""

    def __init__(self) -> None:
        self.state, self.system = WeatherState(0), WetnessSystem()

    def step(self, count: int = 20) -> None:
        state = self.state
        for _ in range(count):
            state.uids.commit()
            found = sorted(
                (state.uids.by_entity[entity], area)
                for entity, area in esper.get_component(RainArea)
                if esper.entity_exists(entity)
            )
            state.fronts.step(found)
            self.system.run(state)

    def lies(self) -> tuple[float, float]:
        """mm of water and of snow."""
        state = self.state
        grounds = state.wet_ground, state.snow_ground
        water, snow = (g.at(*HERE, 0.0, float(g.ticks)) for g in grounds)
        return water, snow


@pytest.fixture
def it() -> Stepper:
    return Stepper()


def test_the_ground_is_wet_after_a_full_second_and_not_before(it: Stepper) -> None:
    esper.create_entity(RainArea((0, 0), (30, 20), 36.0, onset=0.0))
    it.step(19)
    assert it.lies() == (0.0, 0.0)
    assert it.state.wet_ground.ticks == 0
    it.step(1)
    water, snow = it.lies()
    assert water == pytest.approx(36.0 * MM_PER_S, rel=0.01)
    assert snow == 0.0


@pytest.mark.parametrize("factor", [1.0, 5.0])
def test_in_the_cold_it_lies_as_snow_as_fast_as_the_flakes_say(it: Stepper, factor: float) -> None:
    esper.create_entity(RainArea((0, 0), (30, 20), 7.2, onset=0.0))
    esper.create_entity(Air(-8.0, 0.9))
    esper.create_entity(SnowFlakes(settling=factor))
    assert settling(it.state) == factor
    it.step(100)
    water, snow = it.lies()
    assert water == 0.0
    assert snow == pytest.approx(5.0 * factor * 7.2 * MM_PER_S, rel=0.01)


def test_without_flakes_of_its_own_snow_lies_as_it_looks(it: Stepper) -> None:
    assert settling(it.state) == SnowLook().settling


def test_warm_air_melts_what_lies(it: Stepper) -> None:
    area, air = RainArea((0, 0), (30, 20), 7.2, onset=0.0), Air(-8.0, 0.9)
    esper.create_entity(area, air)
    it.step(200)
    _, before = it.lies()
    area.rain_rate = 0.0
    it.step(200)
    assert it.lies()[1] == pytest.approx(before, rel=1e-3)
    air.temperature = 15.0
    it.step(400)
    assert it.lies()[1] < 0.9 * before


def test_areas_that_stand_are_the_same_rows(it: Stepper) -> None:
    """By which the ground sees at once that nothing has changed."""
    seen: list[np.ndarray] = []
    tick = it.state.wet_ground.tick
    it.state.wet_ground.tick = lambda rows, law=None: (seen.append(rows), tick(rows, law))[1]
    area = RainArea((0, 0), (30, 20), 36.0, onset=0.0)
    entity = esper.create_entity(area)
    it.step(60)
    area.rain_rate = 9.0
    it.step(20)
    esper.create_entity(Air(1.2, 1.0))  # sleet: a share of them is rain
    it.step(40)
    esper.delete_entity(entity)
    it.step(20)
    assert [rows is seen[0] for rows in seen] == [True] * 3 + [False] * 4
    assert seen[3]["rain_rate"] == [9.0]
    assert 0.0 < seen[4]["rain_rate"][0] < 9.0
    assert seen[4] is seen[5]
    assert len(seen[6]) == 0  # a deletion that is pending counts


def test_what_is_still_falling_is_not_on_the_ground_yet(it: Stepper) -> None:
    area = RainArea((0, 0), (30, 20), 0.0, onset=1.0, ceiling=200.0)
    esper.create_entity(area)
    it.step(20)
    area.rain_rate = 36.0
    it.step(200)  # the largest fall 200 m in 20 s
    assert it.lies()[0] == 0.0
    it.step(600)
    wet = it.lies()[0]
    assert 0.0 < wet < 40.0 * 36.0 * MM_PER_S
    area.rain_rate = 0.0
    it.step(200)
    assert it.lies()[0] > 1.2 * wet  # of what was in the air


def test_another_world_s_areas_are_none_of_its_own(it: Stepper) -> None:
    other = RainArea((0, 0), (30, 20), 36.0, onset=0.0)  # in no world, but counted with the others
    it.step(20)
    other.rain_rate = 9.0
    it.step(20)
    assert it.lies() == (0.0, 0.0)
