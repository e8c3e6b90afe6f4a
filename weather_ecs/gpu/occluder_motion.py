"""How fast what rain can hit is moving: what splashes need to stay on a thing that goes on."""

from __future__ import annotations

from collections.abc import Iterable
from dataclasses import dataclass
from typing import TypeAlias

import numpy as np

from weather_ecs.frame import OccluderData

HOLD = 0.1  # s without a change after which a thing stands still; a game may move it less often
MANY = 24  # from here on numpy is quicker
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
        # A clock that was set back, by a snapshot, knows nothing of what was before.
        movers = self._movers if time >= self._time else {}
        self._movers = {}
        self._time = time
        changed: list[tuple[_Mover, OccluderData]] = []
        for data in occluders:
            mover = movers.get(data.key)
            if mover is None or mover.data.draw is not data.draw:
                mover = _Mover(data, time)
            elif mover.data is not data:
                changed.append((mover, data))
            self._movers[data.key] = mover
        if len(changed) > MANY:
            self._see_many(changed, time)
        else:
            for mover, data in changed:
                self._see(mover, data, time)
        self._moves = any(self._moving(mover, time) for mover in self._movers.values())

    @staticmethod
    def _see(mover: _Mover, data: OccluderData, time: float) -> None:
        """One that has been moved, or otherwise replaced, since it was looked at."""
        seconds = min(time - mover.changed, HOLD)
        if seconds > 0.0:
            # Of so few numbers numpy's arithmetic takes longer.
            now, before = data.transform.ravel().tolist(), mover.data.transform.ravel()
            pairs = zip(now[:12], before.tolist(), strict=False)
            change = tuple([(a - b) / seconds for a, b in pairs])
            mover.motion = change if max(map(abs, change)) > REST else None
            mover.changed = time
        mover.data = data

    @staticmethod
    def _see_many(changed: list[tuple[_Mover, OccluderData]], time: float) -> None:
        """`_see` for many."""
        change = np.array([data.transform for _, data in changed])
        change -= np.array([mover.data.transform for mover, _ in changed])
        seconds = np.array([min(time - mover.changed, HOLD) for mover, _ in changed])
        rates = change.reshape(-1, 16)[:, :12] / np.where(seconds > 0.0, seconds, 1.0)[:, None]
        moves = (np.abs(rates).max(axis=1) > REST).tolist()
        passed = (seconds > 0.0).tolist()
        for k, (mover, data) in enumerate(changed):
            mover.data = data
            if passed[k]:
                mover.motion = tuple(rates[k].tolist()) if moves[k] else None
                mover.changed = time

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
