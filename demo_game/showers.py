"""Showers with lulls between them: what share of a preset's rain falls at a time."""

from __future__ import annotations

import random

PERIOD = 75.0  # s between two lulls, on average
JITTER = 7.5  # s that each comes earlier or later, so that 60 to 90 s lie between two
FIRST = 56.0  # s, middle of the first one, on average
CALM = 9.0  # s before and after the middle in which the rain rests
EASE = 7.0  # s in which it eases, and in which it picks up again
LEAST, MOST = 0.05, 0.15  # share of the rain that falls in a lull


class Showers:
    """A function of time alone, the same for the same seed."""

    def __init__(self, seed: int = 0) -> None:
        self._seed = seed
        self._number, self._middle, self._depth = self._lull(0)

    def share(self, time: float) -> float:
        """Share of the preset's rain rate at `time` (s), 1 in a shower."""
        self._turn_to(time)
        left = min(max((abs(time - self._middle) - CALM) / EASE, 0.0), 1.0)
        left = left * left * (3.0 - 2.0 * left)
        return self._depth + left * (1.0 - self._depth)

    def is_lull(self, time: float) -> bool:
        """Whether the rain eases or rests; false from when it picks up."""
        self._turn_to(time)
        return -CALM - EASE <= time - self._middle < CALM

    def _turn_to(self, time: float) -> None:
        # A lull is shorter than half the least gap, so the nearest one is all that counts.
        number = max(round((time - FIRST) / PERIOD), 0)
        if number != self._number:
            self._number, self._middle, self._depth = self._lull(number)

    def _lull(self, number: int) -> tuple[int, float, float]:
        chance = random.Random(f"{self._seed} {number}")
        middle = FIRST + number * PERIOD + chance.uniform(-JITTER, JITTER)
        return number, middle, chance.uniform(LEAST, MOST)
