"""What a world has of some kinds of components, asked for again only where it can have changed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import esper

from weather_ecs.components._base import Component, changed


class _Nothing:
    """No entity has one."""


def world_mark() -> object:
    """Another object when an entity or a component has come or gone in esper's current world.

    esper keeps its answers, this empty one too, until then. A deletion that is pending does not
    show.
    """
    return esper.get_component(_Nothing)


class Kinds:
    """Revisions and lists of some kinds: the same lists until one of them has changed."""

    def __init__(self, kinds: Sequence[type[Component]]) -> None:
        self._kinds = kinds
        self._mark: object = None
        self._change = -1
        self.lists: list[list[Any]] = []
        self.revisions: list[int] = []

    def look(self) -> None:
        """Bring both up to date."""
        mark = world_mark()
        if mark is not self._mark:
            self._mark, self.lists = mark, [esper.get_component(kind) for kind in self._kinds]
        if self._change != changed[0]:
            self._change, self.revisions = changed[0], [kind.revisions[0] for kind in self._kinds]
