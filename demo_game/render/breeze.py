"""How the wind moves what grows: its past, so that gusts cross the meadow, and its phases."""

from __future__ import annotations

import math
from collections import deque

import numpy as np
from numpy.typing import NDArray

PAST, STEP = 16, 0.5  # speeds that shaders know, s between them; also in breeze.glsl
LONGEST = 1.0  # s, that things move at once
PERIOD = 20.0 * math.pi  # the shaders' factors of the phases are tenths
WAVE = 0.35  # rad/m, of the waves in grass
SLOWEST = 3.0  # m/s, at which gusts come over the land
HASTE = 0.7  # 1/s, at which their speed follows that of the strongest


class Breeze:
    """Integrates the wind of the frames; the phases do, so that a change of wind is no jump."""

    def __init__(self) -> None:
        self.way = (1.0, 0.0)  # (x, z), where it blows to
        self.sway = 0.0  # rad
        self.wave = 0.0  # rad
        self.front = SLOWEST  # m/s, of gusts over the land
        self._time: float | None = None
        self._past: deque[tuple[float, float]] = deque()

    def advance(self, time: float, wind: tuple[float, float, float]) -> float:
        """The wind of a frame, m/s; returns the seconds since the last one, LONGEST at most."""
        speed = math.hypot(wind[0], wind[2])
        passed = 0.0 if self._time is None else time - self._time
        if self._time is None or not 0.0 <= passed <= LONGEST:
            self._past.clear()
        self._time, passed = time, min(max(passed, 0.0), LONGEST)
        if speed > 1e-6:
            self.way = (wind[0] / speed, wind[2] / speed)
        self._past.append((time, speed))
        while self._past[0][0] < time - PAST * STEP and len(self._past) > 1:
            self._past.popleft()
        strongest = max(it for _, it in self._past)
        self.front += (max(strongest, SLOWEST) - self.front) * min(HASTE * passed, 1.0)
        slow = min(speed, 20.0)
        self.sway = (self.sway + passed * (1.1 + 0.06 * slow)) % PERIOD
        self.wave = (self.wave + passed * WAVE * 0.8 * max(slow, 1.0)) % PERIOD
        return passed

    def past(self) -> NDArray:
        """(PAST,) f8 speeds, m/s, the present one first; of before the first frame, as then."""
        known = np.array(self._past)
        ages = np.arange(PAST) * STEP
        return np.interp(-ages, known[:, 0] - known[-1, 0], known[:, 1])
