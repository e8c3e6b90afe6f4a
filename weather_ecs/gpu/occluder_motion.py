"""How fast what rain can hit is moving: what splashes need to stay on a thing that goes on."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import OccluderData

HOLD = 0.1  # s without a change after which a thing stands still; a game may move it less often
REST = 1e-3  # m/s, of a transform's entries: less is standing still


@dataclass(slots=True)
class _Mover:
    """One occluder as it was seen last."""

    data: OccluderData
    changed: float  # s, when it was seen to have moved
    motion: NDArray[np.float64] | None = None  # (3, 4), change of its transform in a second


class OccluderMotion:
    """Velocities of occluders, from their transforms and the weather's clock."""

    def __init__(self) -> None:
        self._movers: dict[int, _Mover] = {}
        self._time = 0.0
        self._moves = False

    def follow(self, occluders: Iterable[OccluderData], time: float) -> None:
        """Look at where they are at `time`, s."""
        movers = self._movers
        self._movers = {}
        self._time = time
        for data in occluders:
            mover = movers.get(data.key)
            if mover is None or mover.data.draw is not data.draw:
                mover = _Mover(data, time)
            elif mover.data is not data:
                seconds = min(time - mover.changed, HOLD)
                if seconds > 0.0:
                    change = (data.transform - mover.data.transform)[:3] / seconds
                    fastest = max(map(abs, change.ravel().tolist()))
                    mover.motion = change if fastest > REST else None
                    mover.changed = time
                mover.data = data
            self._movers[data.key] = mover
        self._moves = any(self._moving(mover, time) for mover in self._movers.values())

    @staticmethod
    def _moving(mover: _Mover, time: float) -> bool:
        return mover.motion is not None and 0.0 <= time - mover.changed < HOLD

    def came_to_rest(self, time: float) -> bool:
        """Whether something that was moving when it was looked at no longer does."""
        return self._moves and not all(
            self._moving(mover, time)
            for mover in self._movers.values()
            if self._moving(mover, self._time)
        )

    @property
    def moves(self) -> bool:
        """Whether anything does."""
        return self._moves

    def of(self, data: OccluderData) -> NDArray[np.float64]:
        """(3, 4): a point of the mesh, (x, y, z, 1), moves at so many m/s."""
        mover = self._movers.get(data.key)
        if mover is None or mover.motion is None or not self._moving(mover, self._time):
            return _STILL
        return mover.motion


_STILL = np.zeros((3, 4))
_STILL.setflags(write=False)
