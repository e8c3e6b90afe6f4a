"""`Timeline`: snapshots of a run, close enough together that any moment is near one of them."""

from __future__ import annotations

import bisect

MOST = 96  # snapshots that are kept
FIRST_SPACING = 100  # fixed steps between two of them at first: 5 s
LARGEST = 64 * 1024 * 1024  # bytes of all of them


class Timeline:
    """Snapshots by fixed step, of one run from its start on.

    When there are too many every other one goes and the spacing doubles, so that the memory is
    bounded however long a run is, and going back costs at most a spacing's steps.
    """

    def __init__(self, most: int = MOST, spacing: int = FIRST_SPACING) -> None:
        self._most, self._first = most, spacing
        self.spacing = spacing  # steps
        self._steps: list[int] = []
        self._data: list[bytes] = []

    def __len__(self) -> int:
        return len(self._steps)

    @property
    def steps(self) -> tuple[int, ...]:
        """Where the snapshots are."""
        return tuple(self._steps)

    @property
    def size(self) -> int:
        """Bytes of all snapshots."""
        return sum(map(len, self._data))

    def clear(self) -> None:
        """Forget everything; the spacing is that of a new run."""
        self._steps, self._data = [], []
        self.spacing = self._first

    def wants(self, step: int) -> bool:
        """Whether a snapshot at this step would be worth having."""
        if step % self.spacing:
            return False
        place = bisect.bisect_left(self._steps, step)
        return place == len(self._steps) or self._steps[place] != step

    def until_next(self, step: int) -> int:
        """Steps from here to the next one that is wanted, 1 or more."""
        return self.spacing - step % self.spacing

    def add(self, step: int, data: bytes) -> None:
        """Keep a snapshot; one of the same step is replaced."""
        place = bisect.bisect_left(self._steps, step)
        if place < len(self._steps) and self._steps[place] == step:
            self._data[place] = data
            return
        self._steps.insert(place, step)
        self._data.insert(place, data)
        while len(self._steps) > self._most or (self.size > LARGEST and len(self._steps) > 2):
            self._thin()

    def before(self, step: int) -> tuple[int, bytes] | None:
        """The last snapshot at a step or before it."""
        place = bisect.bisect_right(self._steps, step) - 1
        return None if place < 0 else (self._steps[place], self._data[place])

    def _thin(self) -> None:
        """Double the spacing; the start stays."""
        self.spacing *= 2
        kept = [k for k, step in enumerate(self._steps) if k == 0 or step % self.spacing == 0]
        if len(kept) == len(self._steps):  # all of them lie on the wider grid as well
            kept = kept[::2]
        self._steps = [self._steps[k] for k in kept]
        self._data = [self._data[k] for k in kept]
