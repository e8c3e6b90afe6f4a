"""`LightningSystem` a step at a time: strikes, their thunder, and who is still there to hear it."""

from __future__ import annotations

import math
from typing import Any

import esper
import pytest

from weather_ecs.clock import STEP
from weather_ecs.components import Lightning, Observer
from weather_ecs.physics.lightning import SOUND, thunder_delay
from weather_ecs.systems import LightningSystem, WeatherState
from weather_ecs.systems.lightning import called, settings_of
from weather_ecs.systems.strikes import STRIKE, THUNDER, StrikeField

pytestmark = pytest.mark.usefixtures("world")

HIGH = (0.0, 1000.0, 0.0)


class Sky:
    """A state and the system alone."""

    def __init__(self) -> None:
        self.state, self.system = WeatherState(5), LightningSystem()

    def run(self, steps: int = 1) -> list[tuple[str, tuple[Any, ...]]]:
        """What is told of in so many steps."""
        state = self.state
        for _ in range(steps):
            state.clock.advance(STEP)
            state.step = state.clock.steps
            self.system.run(state)
        told, state.events = state.events, []
        return told

    def until_thunder(self) -> int:
        """The step in which thunder is told of."""
        for _ in range(2000):
            if any(name == THUNDER for name, _ in self.run()):
                return self.state.step
        raise AssertionError("no thunder")


@pytest.fixture
def sky() -> Sky:
    return Sky()


def test_a_strike_is_told_of_once_with_all_who_see_it(sky: Sky) -> None:
    near = esper.create_entity(Observer((0.0, 2.0, 340.0)))
    far = esper.create_entity(Observer((0.0, 2.0, 90_000.0)))
    called(sky.state, (0.0, 0.0, 0.0), HIGH, 30.0)
    ((name, (strike, heard)),) = sky.run()
    assert (name, strike.step, strike.current, strike.number) == (STRIKE, 1, 30.0, 0)
    assert [each.observer for each in heard] == [near, far]
    for each in heard:
        assert each.delay == pytest.approx(each.distance / SOUND)
    assert sky.run(5) == []
    assert sky.state.strikes.struck == [strike]


def test_thunder_comes_after_the_sound_has_come(sky: Sky) -> None:
    observer = Observer((0.0, 2.0, 340.0))
    entity = esper.create_entity(observer)
    called(sky.state, (0.0, 0.0, 0.0), HIGH, 30.0)
    ((_, (strike, (heard,))),) = sky.run()
    observer.position = (0.0, 2.0, 9000.0)  # heard is what was seen
    sky.state.events.clear()
    due = strike.step + math.ceil(thunder_delay(heard.distance) / STEP)
    told = sky.run(due - sky.state.step - 1)
    assert told == []
    assert sky.run() == [(THUNDER, (entity, strike, heard.distance))]


def test_nobody_hears_who_is_gone_or_too_far(sky: Sky) -> None:
    gone = esper.create_entity(Observer((0.0, 2.0, 340.0)))
    leaving = esper.create_entity(Observer((0.0, 2.0, 350.0)))
    esper.create_entity(Observer((0.0, 2.0, 2000.0)))
    stays = esper.create_entity(Observer((0.0, 2.0, 360.0)))
    esper.create_entity(Lightning(audible=1000.0))
    called(sky.state, (0.0, 0.0, 0.0), HIGH, 30.0)
    sky.run()
    esper.delete_entity(gone, immediate=True)
    esper.delete_entity(leaving)
    told = sky.run(400)
    assert [(name, values[0]) for name, values in told] == [(THUNDER, stays)]


def test_strikes_are_forgotten_when_their_thunder_is_over(sky: Sky) -> None:
    esper.create_entity(Lightning(audible=3430.0))
    called(sky.state, (0.0, 0.0, 0.0), HIGH, 30.0)
    sky.run(round(9.0 / STEP))
    assert len(sky.state.strikes.struck) == 1
    sky.run(round(2.0 / STEP))
    assert sky.state.strikes.struck == []


def test_a_restored_field_is_listened_to_again(sky: Sky) -> None:
    """Thunder that is on its way is not in a snapshot: it follows from the strikes that are."""
    esper.create_entity(Observer((0.0, 2.0, 3000.0)))
    called(sky.state, (0.0, 0.0, 0.0), HIGH, 30.0)
    sky.run(20)
    wanted = sky.until_thunder()
    other = Sky()
    called(other.state, (0.0, 0.0, 0.0), HIGH, 30.0)
    other.run(20)
    field, steps = other.state.strikes.state(), other.state.clock.steps
    other.state.strikes = StrikeField.from_state(field, steps)
    assert other.until_thunder() == wanted
    assert not any(name == THUNDER for name, _ in other.run(200))


def test_called_strikes_aim_or_are_drawn_and_differ(sky: Sky) -> None:
    state = sky.state
    called(state, (5.0, 3.0, 1.0), None, None)
    called(state, None, HIGH, None)
    called(state, None, HIGH, None)
    (first, aimed), (second, drawn), (third, _) = [
        (strike, not drawn) for strike, drawn in state.strikes.due
    ]
    assert aimed and not drawn
    assert first.target == (5.0, 3.0, 1.0) and first.origin[1] == 1503.0
    assert second.target == third.target == (0.0, 0.0, 0.0)
    assert len({first.word, second.word, third.word}) == 3
    assert 3.0 <= second.current <= 300.0
    assert [strike.number for strike, _ in state.strikes.due] == [0, 1, 2]


def test_the_oldest_lightning_counts_and_else_the_defaults(sky: Sky) -> None:
    assert settings_of(sky.state).rate == Lightning().rate
    entity = esper.create_entity(Lightning(rate=3.0))
    esper.create_entity(Lightning(rate=4.0))
    assert settings_of(sky.state).rate == 3.0
    esper.delete_entity(entity)
    assert settings_of(sky.state).rate == 4.0
