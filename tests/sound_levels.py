"""When nothing glides any more in a sound, and when one begins."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from demo_game.sound.overlap import RATE

SETTLING = 40  # blocks, after which nothing glides any more


def onset(signal: NDArray, floor: float) -> float:
    return float(np.argmax(np.abs(signal).max(axis=0) > floor)) / RATE
