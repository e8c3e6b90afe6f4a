"""The impacts of one observer's rain: a bounded ring that the compute kernel appends to."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

RECORD_BYTES = 48  # place and time; normal and diameter; speed, weight, seed
COUNT_BYTES = 12  # total, total when the frame began, dropped
IMPACT_DTYPE = np.dtype(
    [
        ("position", "f4", 3),  # m
        ("time", "f4"),  # s, the weather's clock
        ("normal", "f4", 3),
        ("diameter", "f4"),  # mm
        ("speed", "f4"),  # m/s
        ("weight", "f4"),  # real drops that it stands for
        ("seed", "f4"),  # in [0, 1)
        ("unused", "f4"),
    ]
)


class ImpactList:
    """Room for `capacity` impacts, old ones overwritten; no more than that in one frame."""

    def __init__(self, ctx: moderngl.Context, capacity: int) -> None:
        self._ctx = ctx
        self.capacity = capacity
        self.counts = ctx.buffer(data=b"\0" * COUNT_BYTES)
        # A time far back, so that what was never written is old.
        empty = np.zeros(capacity, IMPACT_DTYPE)
        empty["time"] = -1e6
        self.records = ctx.buffer(data=empty)

    def begin_frame(self) -> None:
        """From here on this frame's room is counted; nothing is read back."""
        self._ctx.copy_buffer(self.counts, self.counts, 4, read_offset=0, write_offset=4)

    def bind(self) -> None:
        self.counts.bind_to_storage_buffer(2)
        self.records.bind_to_storage_buffer(3)

    def read(self) -> tuple[NDArray, int, int]:
        """(records, how many were met in all, how many found no room); waits: for tests."""
        total, _, dropped = np.frombuffer(self.counts.read(), np.uint32).tolist()
        return np.frombuffer(self.records.read(), IMPACT_DTYPE), total, dropped

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self.records.release()
        self.counts.release()
