"""The impacts of one observer's rain: a bounded ring that the compute kernel appends to."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

COUNT_BYTES = 16  # written and dropped, ever; the same when the frame began
# After these: the work groups for what has sunk in a step, three words, and how much that is; then
# the same at rest, to copy from. As in impact_counts.glsl.
_STEP, _AT_REST = 16, 32
SMALLEST, LARGEST = 4096, 65_536  # impacts; every reader goes over the whole list
SUNK_BYTES = 16  # a drop's place before the step, and which it is
IMPACT_DTYPE = np.dtype(
    [
        ("position", "f4", 3),  # m
        ("time", "f4"),  # s, the weather's clock in its epoch, see impact_times.py
        ("normal", "f4", 3),
        ("diameter", "f4"),  # mm
        ("speed", "f4"),  # m/s
        ("weight", "f4"),  # real drops that it stands for
        ("seed", "f4"),  # in [0, 1)
        ("ride", "f4"),  # velocity of what was hit, see physics/ride.py
    ]
)


class ImpactList:
    """Room for `capacity` impacts, old ones overwritten; no more than that in one frame.

    `step`: how many drops of a container may sink in one step.
    """

    def __init__(self, ctx: moderngl.Context, capacity: int, step: int | None = None) -> None:
        self._ctx = ctx
        self.capacity = capacity
        self.step = capacity if step is None else step
        self.time: float | None = None  # s, the weather's clock at the last update
        words = np.zeros(12, np.uint32)
        words[9:11] = 1
        self.counts = ctx.buffer(data=words)
        self.sunk = ctx.buffer(reserve=SUNK_BYTES * self.step)
        self.records = ctx.buffer(data=self._empty())

    def _empty(self) -> NDArray:
        # A time far back, so that what was never written is old.
        empty = np.zeros(self.capacity, IMPACT_DTYPE)
        empty["time"] = -1e6
        return empty

    def clear(self) -> None:
        """Forget what has been hit."""
        self.records.orphan()
        self.records.write(self._empty())

    def begin_frame(self) -> None:
        """From here on this frame's room is counted; nothing is read back."""
        self._ctx.copy_buffer(self.counts, self.counts, 8, read_offset=0, write_offset=8)

    def begin_step(self) -> None:
        """Nothing of a container has sunk yet; binds what its step and `find` write."""
        counts = self.counts
        self._ctx.copy_buffer(counts, counts, 16, read_offset=_AT_REST, write_offset=_STEP)
        counts.bind_to_storage_buffer(2)
        self.records.bind_to_storage_buffer(3)
        self.sunk.bind_to_storage_buffer(4)

    def find(self, program: Any) -> None:
        """Find what has been hit by the drops that have sunk in this step."""
        program.run_indirect(self.counts, _STEP)

    def read(self) -> tuple[NDArray, int, int]:
        """(records, how many there were in all, how many found no room); waits: for tests."""
        written, dropped, *_ = np.frombuffer(self.counts.read(), np.uint32).tolist()
        return np.frombuffer(self.records.read(), IMPACT_DTYPE), written + dropped, dropped

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self.records.release()
        self.sunk.release()
        self.counts.release()


def list_for(
    ctx: moderngl.Context, drops: int, known: ImpactList | None, capacity: int | None = None
) -> ImpactList:
    """A list with room for what so many drops hit: `known`, if it has; of very many, the newest.

    capacity: that of the list, whatever the drops.
    """
    room = min(max(SMALLEST, drops // 4), LARGEST) if capacity is None else capacity
    # At 10 m/s a sixteenth of the drops comes down in a step of 0.1 s, of 16 m or higher.
    step = min(room, max(drops // 16, 1024)) if capacity is None else capacity
    if known is not None:
        if known.capacity >= room and known.step >= step:
            return known
        known.release()
    return ImpactList(ctx, room, step)
