"""`WeatherProcessor`: the weather's one place in esper's list of processors."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, Protocol

import esper

from weather_ecs.systems.state import WeatherState


class System(Protocol):
    """What the schedule runs."""

    def run(self, state: WeatherState) -> None:
        """Do one step's, or one frame's, work."""


class WeatherProcessor(esper.Processor):
    """Steps the weather's clock and runs the schedule; called by `esper.process(dt)`."""

    def __init__(
        self,
        state: WeatherState,
        step: list[System],
        frame: list[System],
        after: Callable[[], None],
    ) -> None:
        self.state = state
        self._step = step
        self._frame = frame
        self._after = after

    def process(self, dt: float, *args: Any, **kwargs: Any) -> None:
        """Let `dt` seconds pass. Raises InvalidValueError, and does nothing, for a bad dt."""
        state = self.state
        due = state.clock.advance(dt)
        state.uids.commit()
        first = state.clock.steps - due + 1
        state.uids.held = True
        try:
            for k in range(due):
                state.step = first + k
                for system in self._step:
                    system.run(state)
        finally:
            state.uids.held = False
        for system in self._frame:
            system.run(state)
        self._after()
        self._tell()

    def _tell(self) -> None:
        """Hand the events over to esper, in their order; a handler that raises keeps none back."""
        events = self.state.events
        while events:
            name, values = events.pop(0)
            esper.dispatch_event(name, *values)
