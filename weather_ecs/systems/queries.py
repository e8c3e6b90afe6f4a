"""What systems ask of esper: living entities, in the weather's own world, in a stable order."""

from __future__ import annotations

from collections.abc import Iterable
from typing import TypeVar

import esper

from weather_ecs.errors import WeatherError
from weather_ecs.systems.uids import Uids

C = TypeVar("C")


def alive(component_type: type[C], uids: Uids) -> list[tuple[int, C]]:
    """(uid, component) sorted by uid; entities whose deletion is pending are left out."""
    pairs = esper.get_component(component_type)
    if not pairs:
        return []
    exists, current = esper.entity_exists, uids.current()
    known = uids.found.get(component_type)
    # esper keeps its answers until something comes or goes; a pending deletion is no such thing.
    same = known is not None and known[0] is pairs and known[1] is current
    if known is not None and same and (uids.held or all(map(exists, known[2]))):
        return list(known[3])
    found = [(current[entity], component) for entity, component in pairs if exists(entity)]
    if len(found) > 1:
        found.sort(key=_first)
    if len(found) == len(pairs):
        uids.found[component_type] = (pairs, current, [pair[0] for pair in pairs], found)
    return list(found)


def living(component_type: type[C]) -> list[tuple[int, C]]:
    """(entity, component) sorted by entity, for what has no uid: the game's own things."""
    exists = esper.entity_exists
    pairs = [pair for pair in esper.get_component(component_type) if exists(pair[0])]
    pairs.sort(key=_first)
    return pairs


def leaving(entities: Iterable[int]) -> int:
    """How many are about to be deleted: of all, or of these where esper does not say.

    Its own set is asked: to ask about thousands of entities one by one in every sample is too slow.
    """
    dead = getattr(esper, "_dead_entities", None)
    return sum(not esper.entity_exists(e) for e in entities) if dead is None else len(dead)


def _first(pair: tuple[int, object]) -> int:
    return pair[0]


class in_world:  # no generator: that takes three times as long, in every frame
    """Work on another of esper's worlds and come back. Raises WeatherError if it is gone."""

    __slots__ = ("_before", "_name")

    def __init__(self, name: str) -> None:
        self._name, self._before = name, name

    def __enter__(self) -> None:
        self._before, name = esper.current_world, self._name
        if self._before == name:
            return
        if name not in esper.list_worlds():
            raise WeatherError(f"the esper world {name!r} of this weather was deleted")
        esper.switch_world(name)

    def __exit__(self, *error: object) -> None:
        if self._before != self._name:
            esper.switch_world(self._before)
