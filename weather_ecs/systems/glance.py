"""What can change between two looks at a weather in one frame: all of it, and a glance at it.

A game asks for thousands of samples a frame, and each must know what the game has changed since
`esper.process`. To compare all kinds of components for each would cost more than the sample.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

import esper

from weather_ecs.components._base import Component, changed
from weather_ecs.systems.queries import leaving
from weather_ecs.systems.state import WeatherState


def look(state: WeatherState, kinds: Sequence[type[Component]]) -> tuple[Any, ...]:
    """All that can change: the kinds' revisions first, the lists of what there is of them last."""
    lists: list[Any] = [esper.get_component(kind) for kind in kinds]
    return (
        [kind.revisions[0] for kind in kinds],
        leaving(entity for pairs in lists for entity, _ in pairs),
        (state.clock.steps, state.clock.remainder),
        (state.fronts.number, state.fronts.revision, state.cloud_shapes.version),
        (state.clouds, state.course, state.drawn),
        lists,
    )


class _Nothing:
    """No entity has one."""


class Glance:
    """Says at next to no cost that nothing has changed; where it cannot tell, it says it has."""

    def __init__(self) -> None:
        self._kept: tuple[Any, ...] = ()
        self._now: tuple[Any, ...] = ()
        self._kept_probe: object = None
        self._probe: object = None

    def forget(self) -> None:
        """Something has changed that does not show."""
        self._kept_probe = None

    def keep(self) -> None:
        """All is known as `same` last found it."""
        self._kept, self._kept_probe = self._now, self._probe

    def same(self, state: WeatherState) -> bool:
        """Whether all is as it was when it was last kept."""
        # esper keeps its answers, this empty one too, until an entity or a component comes or goes
        # anywhere in its world; a deletion that is pending only shows in its set of those.
        dead = getattr(esper, "_dead_entities", None)
        self._probe = None if dead is None else esper.get_component(_Nothing)
        clock, fronts = state.clock, state.fronts
        self._now = (
            changed[0],
            clock.steps,
            clock.remainder,
            fronts.number,
            fronts.revision,
            state.cloud_shapes.version,
            state.clouds,
            state.course,
            state.drawn,
            len(dead or ()),
        )
        kept = self._kept_probe
        return kept is not None and kept is self._probe and self._now == self._kept
