"""`WeatherProcessor` where something goes wrong, and what it hands on."""

from __future__ import annotations

from collections.abc import Callable

import esper
import pytest

from weather_ecs.components import RainArea
from weather_ecs.systems import WeatherProcessor, WeatherState

pytestmark = pytest.mark.usefixtures("world")


class Does:
    """A system that does what it is given."""

    def __init__(self, deed: Callable[[WeatherState], object]) -> None:
        self.run = deed


def made(*steps: Callable[[WeatherState], object]) -> WeatherProcessor:
    processor = WeatherProcessor(WeatherState(0), [Does(s) for s in steps], [], lambda: None)
    esper.add_processor(processor)
    return processor


class Told:
    """What was told; esper keeps handlers weakly. A 3 raises."""

    def __init__(self) -> None:
        self.log: list[int] = []

    def hear(self, value: int) -> None:
        self.log.append(value)
        if value == 3:
            raise KeyError(value)


@pytest.fixture
def told() -> Told:
    log = Told()
    esper.set_handler("told", log.hear)
    return log


def test_every_step_has_its_number() -> None:
    seen: list[int] = []
    processor = made(lambda state: seen.append(state.step))
    esper.process(0.12)
    esper.process(0.01)
    esper.process(0.12)
    assert seen == [1, 2, 3, 4, 5]
    assert processor.state.clock.steps == 5


def test_a_system_that_fails_leaves_the_numbers_of_entities_open() -> None:
    """New entities get theirs at the next process, not never."""
    broken = [True]

    def fail(state: WeatherState) -> None:
        assert state.uids.held
        if broken[0]:
            raise RuntimeError("a system of tomorrow")

    processor = made(fail)
    with pytest.raises(RuntimeError):
        esper.process(0.05)
    uids = processor.state.uids
    assert not uids.held
    entity = esper.create_entity(RainArea((0, 0), (20, 10)))
    broken[0] = False
    esper.process(0.05)
    assert uids.by_entity == {entity: 0}


def test_entities_are_numbered_before_the_first_step() -> None:
    entity = esper.create_entity(RainArea((0, 0), (20, 10)))
    seen: list[dict[int, int]] = []
    made(lambda state: seen.append(dict(state.uids.by_entity)))
    esper.process(0.05)
    assert seen == [{entity: 0}]


def test_events_are_told_after_all_steps_in_their_order(told: Told) -> None:
    def happen(state: WeatherState) -> None:
        assert told.log == []
        state.events.append(("told", (10 * state.step,)))

    made(happen)
    esper.process(0.1)
    assert told.log == [10, 20]
    esper.process(0.0)
    assert told.log == [10, 20]


def test_a_handler_that_raises_keeps_no_event_back(told: Told) -> None:
    """What came after it is told by the next process, and nothing twice."""
    processor = made()
    processor.state.events += [("told", (value,)) for value in (2, 3, 4)]
    with pytest.raises(KeyError):
        esper.process(0.0)
    assert told.log == [2, 3]
    esper.process(0.0)
    assert told.log == [2, 3, 4]


def test_an_event_that_comes_of_another_is_told_too(told: Told) -> None:
    processor = made()

    def answer(value: int) -> None:
        if value == 1:
            processor.state.events.append(("told", (5,)))

    esper.set_handler("told", answer)
    processor.state.events.append(("told", (1,)))
    esper.process(0.0)
    assert told.log == [1, 5]
