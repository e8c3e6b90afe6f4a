"""Flight: where a walker goes who has switched it on, to look at clouds from above and inside."""

from __future__ import annotations

import math
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

SPEED = 40.0  # m/s
FAST = 6.0  # times as fast with the key for running
RESPONSE = 3.0  # 1/s, how fast the speed follows the keys
HIGHEST, FARTHEST = 20_000.0, 30_000.0  # m over the ground, and away from the middle


class Keys(Protocol):
    """What the keys ask for."""

    @property
    def forward(self) -> float: ...
    @property
    def right(self) -> float: ...
    @property
    def run(self) -> bool: ...
    @property
    def jump(self) -> bool: ...


def velocity_of(
    velocity: NDArray[np.float64], yaw: float, pitch: float, keys: Keys, dt: float
) -> NDArray[np.float64]:
    """m/s after dt seconds: forward goes where the eyes look, the key for jumping up."""
    level = math.cos(pitch)
    ahead = np.array((-math.sin(yaw) * level, math.sin(pitch), -math.cos(yaw) * level))
    right = np.array((math.cos(yaw), 0.0, -math.sin(yaw)))
    way = keys.forward * ahead + keys.right * right + (0.0, 1.0 if keys.jump else 0.0, 0.0)
    length = float(np.linalg.norm(way))
    wanted = way / max(length, 1.0) * SPEED * (FAST if keys.run else 1.0)
    share = 1.0 - math.exp(-RESPONSE * dt)
    return velocity + share * (wanted - velocity)


def kept_in(position: NDArray[np.float64], floor: float) -> NDArray[np.float64]:
    """The place, or the nearest one that may be flown to."""
    x, y, z = position.tolist()
    away = math.hypot(x, z)
    share = min(1.0, FARTHEST / away) if away > 0.0 else 1.0
    return np.array((x * share, min(max(y, floor), floor + HIGHEST), z * share))
