"""`Keeper`: OpenGL objects that are given back together."""

from __future__ import annotations

from typing import Protocol, TypeVar


class Releasable(Protocol):
    """What holds OpenGL objects."""

    def release(self) -> object: ...


Thing = TypeVar("Thing", bound=Releasable)


class Keeper:
    """Holds what was made, oldest first."""

    def __init__(self) -> None:
        self._made: list[Releasable] = []

    def keep(self, thing: Thing) -> Thing:
        """Hold a thing; returns it."""
        self._made.append(thing)
        return thing

    def release(self) -> None:
        """Give everything back, the latest first; twice does no harm."""
        while self._made:
            self._made.pop().release()
