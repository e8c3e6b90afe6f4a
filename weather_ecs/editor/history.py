"""Undo and redo: the states that something was in, which share what they have in common."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Hashable
from dataclasses import dataclass
from typing import Generic, TypeVar

T = TypeVar("T")

MOST_STEPS = 10_000  # kept; of more the oldest are forgotten
MOST_BYTES = 256 * 1024 * 1024  # that the steps take about; of more too, but for the last one


@dataclass(frozen=True, slots=True)
class Step(Generic[T]):
    """One thing that was done: what it is called, and the states before and after it."""

    label: str
    before: T
    after: T
    bytes: int = 0  # about, that `after` does not share with `before`


class History(Generic[T]):
    """A state with what it was before. States are values: they are replaced, never changed.

    Steps that follow each other under the same `merge` key become one, until `end_gesture`: all
    that one drag of a slider does is undone together. `weigh` says how many bytes a state has that
    the one before it does not share.
    """

    def __init__(
        self,
        state: T,
        most: int = MOST_STEPS,
        weigh: Callable[[T, T], int] = lambda before, after: 0,
    ) -> None:
        self._state = state
        self._done: deque[Step[T]] = deque()
        self._most, self._weigh, self._bytes = most, weigh, 0
        self._undone: list[Step[T]] = []
        self._merge: Hashable | None = None

    @property
    def state(self) -> T:
        """What there is now."""
        return self._state

    @property
    def undo_label(self) -> str | None:
        """What undo would take back; None for nothing."""
        return self._done[-1].label if self._done else None

    @property
    def redo_label(self) -> str | None:
        """What redo would do again; None for nothing."""
        return self._undone[-1].label if self._undone else None

    @property
    def steps(self) -> tuple[str, ...]:
        """Labels of what was done, from the oldest, for a list of the past."""
        return tuple(step.label for step in self._done)

    def push(self, label: str, state: T, merge: Hashable | None = None) -> None:
        """Go on to another state; what was undone can no more be redone."""
        last = self._done[-1] if self._done else None
        if merge is not None and merge == self._merge and last is not None and not self._undone:
            self._bytes -= last.bytes
            self._done.pop()
            step = Step(last.label, last.before, state, self._weigh(last.before, state))
        else:
            step = Step(label, self._state, state, self._weigh(self._state, state))
        self._done.append(step)
        self._bytes += step.bytes
        while len(self._done) > self._most or (self._bytes > MOST_BYTES and len(self._done) > 1):
            self._bytes -= self._done.popleft().bytes
        self._undone.clear()
        self._state, self._merge = state, merge

    def end_gesture(self) -> None:
        """What comes now is a step of its own, whatever its key."""
        self._merge = None

    def undo(self) -> bool:
        """Go back by a step; whether there was one."""
        self._merge = None
        if not self._done:
            return False
        step = self._done.pop()
        self._undone.append(step)
        self._bytes -= step.bytes
        self._state = step.before
        return True

    def redo(self) -> bool:
        """Do again what was undone last; whether there was anything."""
        self._merge = None
        if not self._undone:
            return False
        step = self._undone.pop()
        self._done.append(step)
        self._bytes += step.bytes
        self._state = step.after
        return True

    def reset(self, state: T) -> None:
        """Another state without a past."""
        self._done.clear()
        self._undone.clear()
        self._bytes = 0
        self._state, self._merge = state, None
