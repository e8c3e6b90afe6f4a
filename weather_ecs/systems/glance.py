"""What can change between two looks at a weather in one frame: all of it, and a glance at it.

A game asks for thousands of samples a frame, and each must know what the game has changed since
`esper.process`. To compare all kinds of components for each would cost more than the sample.
"""

from __future__ import annotations

from typing import Any

import esper

from weather_ecs.components._base import changed
from weather_ecs.systems.kinds import Kinds, world_mark
from weather_ecs.systems.queries import leaving
from weather_ecs.systems.state import WeatherState


def look(state: WeatherState, kinds: Kinds) -> tuple[Any, ...]:
    """All that can change: the kinds' revisions first, the lists of what there is of them last."""
    kinds.look()
    lists = kinds.lists
    return (
        kinds.revisions,
        leaving(entity for pairs in lists for entity, _ in pairs),
        (state.clock.steps, state.clock.remainder),
        (state.fronts.number, state.fronts.revision, state.cloud_shapes.version),
        (state.clouds, state.course, state.drawn),
        lists,
    )


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
        # A deletion that is pending only shows in esper's set of those.
        dead = getattr(esper, "_dead_entities", None)
        self._probe = None if dead is None else world_mark()
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
