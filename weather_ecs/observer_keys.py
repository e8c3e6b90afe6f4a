"""`ObserverKeys`: what the GPU side knows observers by."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any
from weakref import WeakKeyDictionary, finalize

from weather_ecs.components import Observer
from weather_ecs.errors import InvalidValueError

IMPLICIT = 0  # the observer of a game that names none


class ObserverKeys:
    """A number for every observer that was drawn for, as long as it lives; never used again."""

    def __init__(self) -> None:
        self._keys: WeakKeyDictionary[Observer, int] = WeakKeyDictionary()
        self._next = IMPLICIT + 1
        self._retired: list[int] = []

    def key(self, observer: Observer | None) -> int:
        """The observer's number, a new one where it has none."""
        if observer is None:
            return IMPLICIT
        key = self._keys.get(observer)
        if key is None:
            key = self._keys[observer] = self._next
            self._next += 1
            finalize(observer, self._retired.append, key).atexit = False
        return key

    def retired(self) -> Iterator[int]:
        """Numbers whose observers have gone; each comes again until the next one is asked for."""
        while self._retired:
            yield self._retired[0]  # others may come behind it meanwhile
            del self._retired[0]

    def __len__(self) -> int:
        return len(self._keys)


def check_observer(observer: Any) -> None:
    """Raises InvalidValueError for anything but an observer or None."""
    if observer is not None and not isinstance(observer, Observer):
        raise InvalidValueError("observer", observer, "an Observer component or None")
