"""`Clock`: the weather's own time, in fixed steps, that can be paused and sped up."""

from __future__ import annotations

import math
from typing import Any

from weather_ecs.components._base import flag, number, to_float
from weather_ecs.errors import InvalidValueError

STEP = 0.05  # s, length of a fixed step
LONGEST = 10.0  # s, what a longer frame counts as: somebody stopped in a debugger
FASTEST = 1000.0  # greatest speed
MOST_STEPS = 2**53  # beyond, a float no longer counts steps

_SLACK = 1e-9  # s, so that three frames of 1/60 s are one step whatever their rounding
_check_speed = number(0.0, FASTEST)
_check_paused = flag()
_DT = "a finite number of seconds >= 0"


class Clock:
    """Counts fixed steps; what is left over of a frame's time waits for the next frame.

    Time is the count times STEP, so that it is as exact after a year as on the first day.
    """

    __slots__ = ("_paused", "_speed", "dropped", "remainder", "steps")

    def __init__(self) -> None:
        self.steps = 0  # fixed steps done
        self.remainder = 0.0  # s, 0 <= remainder < STEP
        self.dropped = 0.0  # s of game time that frames beyond LONGEST left out
        self._paused = False
        self._speed = 1.0

    @property
    def time(self) -> float:
        """Seconds of weather since its start, remainder included."""
        return self.steps * STEP + self.remainder

    @property
    def paused(self) -> bool:
        """A paused clock stands still, whatever time passes."""
        return self._paused

    @paused.setter
    def paused(self, value: bool) -> None:
        self._paused = _check_paused("paused", value)

    @property
    def speed(self) -> float:
        """Seconds of weather in a second of the game, 0 to 1000."""
        return self._speed

    @speed.setter
    def speed(self, value: float) -> None:
        self._speed = _check_speed("speed", value)

    def advance(self, dt: Any) -> int:
        """Let `dt` seconds of the game pass; returns the number of fixed steps that are due.

        Raises InvalidValueError, and leaves the clock as it was, if dt is negative or not finite.
        """
        seconds = to_float("dt", dt, _DT)
        if not 0.0 <= seconds < math.inf:
            raise InvalidValueError("dt", dt, _DT)
        if self._paused:
            return 0
        if seconds > LONGEST:
            self.dropped = min(self.dropped + (seconds - LONGEST), 1e300)
            seconds = LONGEST
        total = self.remainder + seconds * self._speed
        due = int((total + _SLACK) / STEP)
        self.remainder = min(max(total - due * STEP, 0.0), math.nextafter(STEP, 0.0))
        self.steps = min(self.steps + due, MOST_STEPS)
        return due

    def state(self) -> dict[str, Any]:
        """All there is to a clock, as plain values."""
        return {
            "dropped": self.dropped,
            "paused": self._paused,
            "remainder": self.remainder,
            "speed": self._speed,
            "steps": self.steps,
        }

    @classmethod
    def from_state(cls, state: dict[str, Any]) -> Clock:
        """The clock that `state` was taken of. Raises InvalidValueError for anything else."""
        clock = cls()
        if not isinstance(state, dict) or set(state) != set(clock.state()):
            raise InvalidValueError("clock", state, f"the fields {sorted(clock.state())}")
        steps = state["steps"]
        if type(steps) is not int or not 0 <= steps <= MOST_STEPS:
            raise InvalidValueError("clock.steps", steps, f"a whole number in [0, {MOST_STEPS}]")
        clock.steps = steps
        clock.remainder = number(0.0, math.nextafter(STEP, 0.0))("remainder", state["remainder"])
        clock.dropped = number(0.0, 1e300)("dropped", state["dropped"])
        clock.paused = state["paused"]
        clock.speed = state["speed"]
        return clock
