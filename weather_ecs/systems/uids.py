"""`Uids`: names of entities that outlive a process, for snapshots and for the GPU's records."""

from __future__ import annotations

from typing import Any

import esper

from weather_ecs.components import SNAPSHOT_COMPONENTS
from weather_ecs.systems.kinds import world_mark

_KINDS = tuple(SNAPSHOT_COMPONENTS.values())


class Uids:
    """Numbers the entities that carry weather components in the order they are first seen.

    esper's own ids differ between two processes and between a game and its server. Whatever
    depends on an order uses that of the uids: for entities that got their weather when they were
    created it is that of the entity ids.
    """

    def __init__(self) -> None:
        self.by_entity: dict[int, int] = {}  # as of the last commit
        self.next = 0
        self._current: dict[int, int] = {}  # as a commit would make it now
        self.found: dict[type, tuple] = {}  # what `systems.queries` has found with these numbers
        self.held = False  # while only the systems run: they commit what they make
        self._lists: tuple[list[Any], ...] = ()
        self._mark: object = None  # of the world, when the lists were asked for
        self._counter: object = None

    def current(self) -> dict[int, int]:
        """Uid of every entity with weather, new ones included.

        Looking commits to nothing: how often a game draws must not show in its snapshots.
        """
        if self.held:
            return self._current
        # esper.clear_database() starts the entity ids again, with a new counter: the same id is
        # then another entity. There is no public sign of it.
        counter = getattr(esper, "_entity_count", None)
        if counter is not self._counter:
            if self._counter is not None:
                self.by_entity = {}
            self._counter = counter
            self._lists = ()
        mark = world_mark()
        if self._lists and mark is self._mark:
            return self._current
        lists = tuple([esper.get_component(kind) for kind in _KINDS])
        known = self.by_entity
        found = {pair[0] for pairs in lists for pair in pairs}
        entities = sorted(filter(esper.entity_exists, found))
        current = {entity: known[entity] for entity in entities if entity in known}
        following = self.next
        for entity in entities:
            if entity not in current:
                current[entity] = following
                following += 1
        self._lists, self._mark = lists, mark
        self._current = current
        return current

    def commit(self) -> None:
        """Number the new entities for good and forget those that are gone."""
        held, self.held = self.held, False
        dead = getattr(esper, "_dead_entities", True)
        if dead and not all(map(esper.entity_exists, self._current)):
            self._lists = ()  # a deletion is pending, of which the lists say nothing
        current = self.current()
        self.held = held
        if current is not self.by_entity:
            self.by_entity = current
            self.next = max(self.next, max(current.values(), default=-1) + 1)

    def assign(self, by_entity: dict[int, int], following: int) -> None:
        """Take over the numbers of a snapshot."""
        self.by_entity = dict(by_entity)
        self.next = following
        self._lists = ()
