"""`Stretch`: some seconds in which rain areas went on as they did, and how that is recognised."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

NEAR = 0.25  # cells that an area may be off the line it has followed
JUMP = 8.0  # cells in a tick, more is a leap to another place
CHANGE = 0.02  # of a rain rate that is the same rate
RAMP = 0.08  # of a rain rate in a tick, more is a jump

# Columns of AREA_DTYPE as plain numbers: key, x, z, a, b, heading, rate, edge, ceiling.
_CENTER, _RATE = slice(1, 3), 6
_SHAPE = np.array([True, False, False, True, True, True, False, True, True])


def columns(rows: NDArray) -> NDArray[np.float64]:
    """Rows of AREA_DTYPE as (n, 9) plain numbers; the keys' bits are only good for comparing."""
    return np.ascontiguousarray(rows).view(np.float64).reshape(len(rows), 9)


@dataclass(slots=True)
class Stretch:
    """Areas that went from `first` to `last`, evenly, in some ticks."""

    first: NDArray  # AREA_DTYPE
    last: NDArray  # the same areas; the same array where nothing has moved or changed
    ticks: int

    @property
    def still(self) -> bool:
        """Whether the areas stood all the time."""
        return self.first is self.last

    def goes_on(self, rows: NDArray, cell: float) -> bool:
        """Take in another tick, if the areas have come to `rows` as they went so far."""
        if self.still:
            if rows is not self.last and not _equal(rows, self.last):
                return False
            self.first = self.last = rows
            self.ticks += 1
            return True
        if len(rows) != len(self.last):
            return False
        start, end, now = columns(self.first), columns(self.last), columns(rows)
        if not _same_areas(now, end):
            return False
        off = np.abs(now - end - (end - start) / self.ticks)
        if off[:, _CENTER].max(initial=0.0) > NEAR * cell:
            return False
        if (off[:, _RATE] > CHANGE * now[:, _RATE]).any():
            return False
        self.last, self.ticks = rows, self.ticks + 1
        return True


def begin(rows: NDArray, before: NDArray, cell: float) -> Stretch:
    """A stretch of one tick, to `rows`, after a tick that ended at `before`."""
    if not len(rows) or len(rows) != len(before):
        return Stretch(rows, rows, 1)
    now, was = columns(rows), columns(before)
    if not _same_areas(now, was):
        return Stretch(rows, rows, 1)
    moved = np.abs(now[:, _CENTER] - was[:, _CENTER]).max()
    change = np.abs(now[:, _RATE] - was[:, _RATE]) > RAMP * now[:, _RATE]
    if moved > JUMP * cell or (not moved and change.any()):
        return Stretch(rows, rows, 1)
    first = rows.copy()
    first["center"] = before["center"]
    first["rain_rate"] = np.where(change, rows["rain_rate"], before["rain_rate"])
    if np.array_equal(first, rows):
        return Stretch(rows, rows, 1)
    first.setflags(write=False)
    return Stretch(first, rows, 1)


def _equal(one: NDArray, other: NDArray) -> bool:
    return len(one) == len(other) and one.tobytes() == other.tobytes()


def _same_areas(one: NDArray, other: NDArray) -> bool:
    return not ((one.view(np.int64) != other.view(np.int64)) & _SHAPE).any()
