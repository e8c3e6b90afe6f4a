"""What a world has of kinds of components: looked up again only where it can have changed."""

from __future__ import annotations

import esper

from weather_ecs.components import Fog, RainArea, Wind
from weather_ecs.systems.kinds import Kinds, world_mark
from weather_ecs.systems.queries import in_world


def test_the_mark_is_another_when_something_comes_or_goes() -> None:
    mark = world_mark()
    area = RainArea((0, 0), (5, 4))
    assert world_mark() is mark
    entity = esper.create_entity(area)
    came = world_mark()
    assert came is not mark
    area.rain_rate = 3.0
    esper.delete_entity(entity)
    assert world_mark() is came  # a pending deletion does not show
    esper.clear_dead_entities()
    assert world_mark() is not came


def test_every_world_has_its_own_mark() -> None:
    here = world_mark()
    esper.switch_world("elsewhere")
    there = world_mark()
    with in_world("default"):
        assert world_mark() is here
    assert there is world_mark() is not here
    esper.switch_world("default")
    esper.delete_world("elsewhere")


def test_lists_and_revisions_are_those_of_esper_and_the_components() -> None:
    kinds = Kinds((RainArea, Wind))
    kinds.look()
    assert kinds.lists == [[], []]
    area, wind = RainArea((0, 0), (5, 4)), Wind()
    first, second = esper.create_entity(area), esper.create_entity(wind)
    kinds.look()
    lists, revisions = kinds.lists, kinds.revisions
    assert lists == [[(first, area)], [(second, wind)]]
    assert revisions == [RainArea.revision(), Wind.revision()]
    kinds.look()
    assert kinds.lists is lists and kinds.revisions is revisions
    Fog()  # of another kind
    kinds.look()
    assert kinds.lists is lists and kinds.revisions == revisions
    wind.speed = 3.0
    kinds.look()
    assert kinds.lists is lists
    assert kinds.revisions == [revisions[0], Wind.revision()] != revisions
    esper.remove_component(first, RainArea)
    kinds.look()
    assert kinds.lists == [[], [(second, wind)]]
