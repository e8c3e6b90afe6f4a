"""The schedule, the processor that runs it, and the uids all systems go by."""

from __future__ import annotations

import math

import esper
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.worlds import fresh_world
from weather_ecs.components import PointLight, RainArea, Wind
from weather_ecs.errors import InvalidValueError, WeatherError
from weather_ecs.systems import SCHEDULE, WeatherProcessor, WeatherState, scheduled
from weather_ecs.systems.queries import alive, in_world, living
from weather_ecs.systems.uids import Uids

pytestmark = pytest.mark.usefixtures("world")


def test_the_schedule_is_one_table_with_a_reason_in_every_row():
    orders = [row.order for row in SCHEDULE]
    assert orders == sorted(set(orders))
    for row in SCHEDULE:
        assert row.system.__name__.endswith("System")
        assert row.phase in ("step", "frame")
        assert len(row.reason) > 10
    names = [row.system.__name__ for row in SCHEDULE]
    assert names.index("WindSystem") < names.index("RainAreaSystem") < len(names) - 1
    assert names[-1] == "ExtractSystem"
    assert len(scheduled("step")) + len(scheduled("frame")) == len(SCHEDULE)


class Spy:
    def __init__(self, name: str, log: list[str]) -> None:
        self.name, self.log = name, log

    def run(self, state: WeatherState) -> None:
        self.log.append(self.name)


def spied() -> tuple[WeatherProcessor, list[str]]:
    log: list[str] = []
    processor = WeatherProcessor(
        WeatherState(0),
        [Spy("a", log), Spy("b", log)],
        [Spy("frame", log)],
        lambda: log.append("after"),
    )
    esper.add_processor(processor)
    return processor, log


def test_steps_come_before_the_frame_and_in_order():
    _, log = spied()
    esper.process(0.1)
    assert log == ["a", "b", "a", "b", "frame", "after"]
    log.clear()
    esper.process(0.01)
    assert log == ["frame", "after"]


@pytest.mark.parametrize("dt", [-0.1, math.nan, math.inf, None, "1", True])
def test_a_bad_dt_runs_nothing(dt):
    _, log = spied()
    with pytest.raises(InvalidValueError, match="dt"):
        esper.process(dt)
    assert log == []


def test_a_pause_in_the_debugger_is_two_hundred_steps():
    _, log = spied()
    esper.process(1e12)
    assert log.count("a") == 200


def test_other_arguments_of_the_game_pass_by():
    processor, log = spied()
    esper.process(0.05, "more", key=1)
    assert log.count("a") == 1
    processor.process(dt=0.05)
    assert log.count("a") == 2


def test_looking_gives_the_uids_that_a_commit_makes():
    uids = Uids()
    esper.create_entity(RainArea((0, 0), (2, 1)))
    esper.create_entity(Wind())
    esper.create_entity()
    esper.create_entity(PointLight())
    looked = dict(uids.current())
    assert looked == {1: 0, 2: 1, 4: 2}
    assert uids.by_entity == {}
    uids.commit()
    assert uids.by_entity == looked
    assert uids.next == 3


lives = st.lists(st.tuples(st.sampled_from("cdlpx"), st.integers(0, 9)), max_size=40)


def play(story: list[tuple[str, int]], looks: bool) -> tuple[list[int], int]:
    """Create, delete (at once or pending), process; looking in between if `looks`."""
    with fresh_world():
        uids, mine = Uids(), []
        for deed, number in story:
            if deed == "c":
                mine.append(esper.create_entity(RainArea((number, 0), (2, 1))))
            elif deed == "l" and looks:
                uids.current()
                alive(RainArea, uids)
            elif mine and deed in "dx" and esper.entity_exists(mine[number % len(mine)]):
                esper.delete_entity(mine[number % len(mine)], immediate=deed == "x")
            elif deed == "p":
                if number % 2:
                    esper.clear_dead_entities()
                uids.commit()
        esper.clear_dead_entities()
        uids.commit()
        return sorted(uids.by_entity.values()), uids.next


@settings(deadline=None)
@given(lives)
def test_looking_never_shows_in_the_uids(story):
    assert play(story, looks=True) == play(story, looks=False)


def test_a_cleared_database_begins_new_lives():
    uids = Uids()
    esper.create_entity(RainArea((0, 0), (2, 1)))
    uids.commit()
    esper.clear_database()
    entity = esper.create_entity(RainArea((0, 0), (2, 1)))
    assert entity == 1
    uids.commit()
    assert uids.by_entity == {1: 1}


def test_queries_leave_out_what_is_dying():
    first = esper.create_entity(RainArea((0, 0), (2, 1)))
    second = esper.create_entity(RainArea((0, 0), (2, 1)))
    esper.delete_entity(first)
    assert [entity for entity, _ in living(RainArea)] == [second]
    assert len(alive(RainArea, Uids())) == 1
    assert living(Wind) == []


def test_working_on_another_world_and_back():
    here = esper.current_world
    with fresh_world() as there:
        esper.switch_world(here)
        with in_world(there):
            assert esper.current_world == there
            esper.create_entity(Wind())
        assert esper.current_world == here
        assert living(Wind) == []
        with pytest.raises(KeyError, match="mine"), in_world(there):
            raise KeyError("mine")
        assert esper.current_world == here
    with pytest.raises(WeatherError, match="deleted"), in_world(there):
        raise AssertionError("there is no such world")
    assert there not in esper.list_worlds()
