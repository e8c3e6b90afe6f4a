"""How fast what rain can hit is moving: what splashes need to stay on a thing that goes on."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeAlias

from weather_ecs.frame import OccluderData

HOLD = 0.1  # s without a change after which a thing stands still; a game may move it less often
REST = 1e-3  # m/s, of a transform's entries: less is standing still

Motion: TypeAlias = tuple[float, ...]  # 12 numbers


@dataclass(slots=True)
class _Mover:
    """One occluder as it was seen last."""

    data: OccluderData
    changed: float  # s, when it was seen to have moved
    motion: Motion | None = None  # change of its transform in a second


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
                    # Of so few numbers numpy's arithmetic takes longer.
                    now, before = data.transform.ravel().tolist(), mover.data.transform.ravel()
                    pairs = zip(now[:12], before.tolist(), strict=False)
                    change = tuple([(a - b) / seconds for a, b in pairs])
                    mover.motion = change if max(map(abs, change)) > REST else None
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

    def of(self, data: OccluderData) -> Motion:
        """Of (3, 4), row by row: a point of the mesh, (x, y, z, 1), moves at so many m/s."""
        mover = self._movers.get(data.key)
        if mover is None or mover.motion is None or not self._moving(mover, self._time):
            return _STILL
        return mover.motion


_STILL: Motion = (0.0,) * 12
