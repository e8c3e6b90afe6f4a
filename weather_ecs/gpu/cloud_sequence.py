"""What is drawn of the clouds, back to front, as runs that one call draws."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

# How an item is drawn. Billboards count in the stream, pictures in the rows of quads.
BILLBOARDS, SOFT, PICTURE, FADING, LIT, LIT_FADING = range(6)
PICTURES = (PICTURE, FADING, LIT, LIT_FADING)


class Between(NamedTuple):
    """Something that is drawn among the clouds, at its distance from the camera in m."""

    distance: float
    draw: Callable[[], None]


class Items(NamedTuple):
    """Clouds in the order of drawing, (n,) each; an item from 9 to 9 draws nothing."""

    kinds: NDArray[np.intp]
    begins: NDArray[np.intp]
    ends: NDArray[np.intp]

    def part(self, first: int, last: int) -> Items:
        """The items from `first` to before `last`."""
        return Items(self.kinds[first:last], self.begins[first:last], self.ends[first:last])

    def shows(self, first: int, last: int, kinds: tuple[int, ...]) -> bool:
        """Whether any from `first` to before `last` is of these kinds, and draws something."""
        part = self.part(first, last)
        kinds_found, begins, ends = (numbers.tolist() for numbers in part)
        found = zip(kinds_found, begins, ends, strict=True)
        return any(end > begin and kind in kinds for kind, begin, end in found)

    def parted(self, middles: NDArray[np.intp]) -> tuple[Items, Items]:
        """What of each comes before its middle, and what after."""
        return self._replace(ends=middles), self._replace(begins=middles)


def runs(items: Items) -> Iterator[tuple[int, int, int]]:
    """(kind, begin, end) of neighbours of one kind that follow on each other."""
    # NumPy's calls take longest over the few items that there are.
    first = last = 0
    now = -1
    kinds, begins, ends = (numbers.tolist() for numbers in items)
    for kind, begin, end in zip(kinds, begins, ends, strict=True):
        if end <= begin:
            continue
        if kind != now or begin != last:
            if last > first:
                yield now, first, last
            now, first = kind, begin
        last = end
    if last > first:
        yield now, first, last
