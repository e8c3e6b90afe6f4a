"""Events: named, in their order, the same for the same steps."""

from __future__ import annotations

import esper
import pytest

from tests.worlds import fresh_world
from weather_ecs import Weather
from weather_ecs.components import Air, Climate, Observer, RainArea
from weather_ecs.events import (
    EVENTS,
    RAIN_BEGINS,
    RAIN_ENDS,
    SNOW_BEGINS,
    SNOW_ENDS,
    STATE_CHANGED,
    STRIKE,
    THUNDER,
    TRANSITION_FINISHED,
)
from weather_ecs.systems.events import state_name

pytestmark = pytest.mark.usefixtures("world")


class Log:
    """Writes down all events but those of lightning."""

    def __init__(self) -> None:
        self.lines: list[tuple] = []
        self._handlers = [self._handler(name) for name in EVENTS if name not in (STRIKE, THUNDER)]

    def _handler(self, name: str):
        def handle(*values: object) -> None:
            self.lines.append((name, *values))

        esper.set_handler(name, handle)  # esper holds handlers weakly
        return handle

    def names(self) -> list[str]:
        return [line[0] for line in self.lines]


def walk(observer: Observer, speed: float, seconds: int) -> None:
    for _ in range(seconds):
        x, y, z = observer.position
        observer.position = (x + speed, y, z)
        esper.process(1.0)


def test_walking_in_and_out_of_rain():
    with Weather():
        log = Log()
        observer = Observer(position=(-100.0, 1.7, 0.0))
        entity = esper.create_entity(observer)
        esper.create_entity(RainArea((0, 0), (40, 30), 8.0))
        walk(observer, 4.0, 50)
        assert log.names() == [RAIN_BEGINS, RAIN_ENDS]
        assert log.lines[0][1] == entity and log.lines[0][2] > 0.1
        assert log.lines[1][2] < 0.05


def test_snow_has_events_of_its_own():
    with Weather():
        log = Log()
        observer = Observer(position=(-100.0, 1.7, 0.0))
        esper.create_entity(observer)
        esper.create_entity(Air(-5.0, 0.9))
        esper.create_entity(RainArea((0, 0), (40, 30), 8.0))
        walk(observer, 4.0, 50)
        assert log.names() == [SNOW_BEGINS, SNOW_ENDS]


def test_what_is_so_from_the_beginning_is_no_event_and_two_observers_are_two():
    with Weather():
        log = Log()
        inside = esper.create_entity(Observer(position=(0.0, 1.7, 0.0)))
        outside = esper.create_entity(Observer(position=(300.0, 1.7, 0.0)))
        area = RainArea((0, 0), (40, 30), 8.0, onset=0.0)
        esper.create_entity(area)
        esper.process(5.0)
        assert log.lines == []
        area.center = (300.0, 0.0)
        esper.process(2.0)
        assert [line[:2] for line in log.lines] == [(RAIN_ENDS, inside), (RAIN_BEGINS, outside)]
        esper.delete_entity(outside)
        esper.process(2.0)
        assert len(log.lines) == 2


def test_the_state_crosses_its_names():
    with Weather():
        log = Log()
        climate = Climate(0.0, 1.0, 20.0)
        esper.create_entity(climate)
        for _ in range(25):
            esper.process(1.0)
        assert log.lines == [
            (STATE_CHANGED, *pair)
            for pair in (
                ("clear", "fair"), ("fair", "cloudy"), ("cloudy", "overcast"), ("overcast", "storm")
            )
        ]  # fmt: skip
        log.lines.clear()
        # Where two are equally near, the one that was stays.
        climate.initial = climate.final = 0.875
        esper.process(3.0)
        assert log.lines == []
        assert state_name(0.13, "clear") == "clear" and state_name(0.13, "fair") == "fair"


def test_a_transition_that_has_finished():
    with Weather() as weather:
        log = Log()
        weather.change_to("clear")
        weather.change_to("steady_rain", 3.0)
        esper.process(2.9)
        weather.change_to("snow", 4.0)
        esper.process(3.9)
        assert TRANSITION_FINISHED not in log.names()
        esper.process(0.2)
        assert (
            log.lines[-1] == (TRANSITION_FINISHED, "snow")
            and log.names().count(TRANSITION_FINISHED) == 1
        )


def story(cuts: tuple[float, ...]) -> list[tuple]:
    with fresh_world(), Weather(seed=9) as weather:
        log = Log()
        esper.create_entity(Observer())
        weather.change_to("clear")
        esper.process(2.0)
        weather.change_to("thunderstorm", 12.0)
        for dt in cuts:
            esper.process(dt)
        weather.change_to("snow", 10.0)
        for dt in cuts:
            esper.process(dt)
        return log.lines


def test_the_same_steps_give_the_same_events_however_they_are_cut():
    one = story((0.05,) * 400)
    assert one == story((0.05,) * 400) == story((0.5,) * 40) == story((10.0,) * 2)
    names = [line[0] for line in one]
    assert {RAIN_BEGINS, RAIN_ENDS, SNOW_BEGINS, STATE_CHANGED, TRANSITION_FINISHED} <= set(names)


def test_a_handler_that_raises_is_heard_of_and_keeps_nothing_back():
    with Weather() as weather:
        seen = []

        def fails(*values: object) -> None:
            raise RuntimeError("a handler's own mistake")

        def sees(name: str) -> None:
            seen.append(name)

        esper.set_handler(STATE_CHANGED, fails)
        esper.set_handler(TRANSITION_FINISHED, sees)
        weather.change_to("clear")
        esper.process(1.0)
        weather.change_to("fog", 2.0)
        before = weather.stats.time
        with pytest.raises(RuntimeError, match="own mistake"):
            esper.process(4.0)
        assert weather.stats.time == before + 4.0  # the step had been done
        esper.remove_handler(STATE_CHANGED, fails)
        esper.process(1.0)
        assert seen == ["fog"]


def test_restoring_is_no_event():
    with Weather() as weather:
        esper.create_entity(Observer())
        weather.change_to("clear")
        esper.process(2.0)
        dry = weather.snapshot()
        weather.change_to("steady_rain", 0.0)
        esper.process(3.0)
        log = Log()
        weather.restore(dry)
        esper.process(3.0)
        assert log.lines == []


def test_all_are_described():
    assert set(EVENTS) == {
        "rain_begins", "rain_ends", "snow_begins", "snow_ends", "state_changed",
        "transition_finished", "strike", "thunder",
    }  # fmt: skip
    assert all(EVENTS.values())
