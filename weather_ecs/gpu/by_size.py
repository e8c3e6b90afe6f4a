"""Things that are made for a size of the picture: one for each size in use, and no more."""

from __future__ import annotations

from collections.abc import Callable, Hashable
from typing import Generic, TypeVar

from weather_ecs.gpu.keeper import Releasable

KEPT = 64  # times that others are asked for, until one is given back
SIZES = 4  # that are kept, at most

Thing = TypeVar("Thing", bound=Releasable)


class BySize(Generic[Thing]):
    """Observers may have pictures of several sizes, in turns; a window is resized for good."""

    def __init__(self) -> None:
        self._kept: dict[Hashable, Thing] = {}  # the one that was asked for last comes last
        self._asked: dict[Hashable, int] = {}  # when
        self._times = 0

    def get(self, size: Hashable, make: Callable[[], Thing]) -> Thing:
        """What is kept for a size, or else made for it."""
        self._times += 1
        thing = self._kept.pop(size, None)
        if thing is None:
            if len(self._kept) >= SIZES:
                self._drop(next(iter(self._kept)))
            thing = make()
        self._kept[size], self._asked[size] = thing, self._times
        oldest = next(iter(self._kept))
        if self._asked[oldest] + KEPT < self._times:
            self._drop(oldest)
        return thing

    def _drop(self, size: Hashable) -> None:
        del self._asked[size]
        self._kept.pop(size).release()

    def __len__(self) -> int:
        return len(self._kept)

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for size in list(self._kept):
            self._drop(size)
