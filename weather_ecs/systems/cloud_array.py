"""`CloudArray`: the clouds of one layer as arrays, in the order in which they came."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weather_ecs.systems.cloud_mix import Kind

WHOLE = -1  # as `born`: it came in whole; as `dying`: it is not dissolving
_COLUMNS = ("x", "z", "serial", "kind", "born", "dying")
_SPARE = 256  # kinds without a cloud that may be kept
_NONE = np.zeros(0, np.int64)


class CloudArray:
    """Columns of equal length; what is derived from them is kept until they change."""

    __slots__ = (*_COLUMNS, "_counts", "_extent", "_index", "_standing", "kinds", "version")

    def __init__(self) -> None:
        self.x = self.z = _NONE  # quanta of the drifting frame
        self.serial = _NONE  # of the layer, rising
        self.kind = _NONE  # index into `kinds`
        self.born = _NONE  # tick in which it began to form, or WHOLE
        self.dying = _NONE  # tick in which it began to dissolve, or WHOLE
        self.kinds: list[Kind] = []
        self._index: dict[Kind, int] = {}
        self.version = 0  # another one whenever anything has changed
        self._standing: int | None = None
        self._extent: tuple[int, int, int, int] | None = None
        self._counts: dict[float, int] | None = None  # standing ones by sky

    def __len__(self) -> int:
        return len(self.x)

    # Questions

    @property
    def standing(self) -> int:
        """Number of clouds that are not dissolving."""
        if self._standing is None:
            self._standing = int(np.count_nonzero(self.dying == WHOLE))
        return self._standing

    @property
    def extent(self) -> tuple[int, int, int, int]:
        """Least and greatest x, least and greatest z, of at least one cloud; quanta."""
        if self._extent is None:
            x, z = self.x, self.z
            self._extent = int(x.min()), int(x.max()), int(z.min()), int(z.max())
        return self._extent

    def skies(self) -> list[float]:
        """States of the skies whose clouds are standing."""
        return sorted(self._count())

    def count_of(self, sky: float) -> int:
        """Number of standing clouds of a sky."""
        return self._count().get(sky, 0)

    def oldest(self, sky: float | None = None) -> int:
        """Row of the first that came, of those standing; of one sky, or of all."""
        stands = self.dying == WHOLE
        if sky is not None:
            stands &= np.isin(self.kind, [k for k, of in enumerate(self.kinds) if of.sky == sky])
        return int(np.argmax(stands))

    def _count(self) -> dict[float, int]:
        if self._counts is None:
            numbers = np.bincount(self.kind[self.dying == WHOLE], minlength=len(self.kinds))
            counts: dict[float, int] = {}
            for kind, number in zip(self.kinds, numbers.tolist(), strict=True):
                if number:
                    counts[kind.sky] = counts.get(kind.sky, 0) + number
            self._counts = counts
        return self._counts

    # Changes

    def add(self, kinds: list[Kind], places: NDArray, serials: NDArray, born: int) -> None:
        """Clouds come: at places (n, 2) in quanta, in the tick `born` or WHOLE."""
        new = np.array([self._number(kind) for kind in kinds], np.int64)
        state = np.full(len(kinds), born, np.int64)
        fresh = (places[:, 0], places[:, 1], serials, new, state, np.full_like(state, WHOLE))
        for name, values in zip(_COLUMNS, fresh, strict=True):
            setattr(self, name, np.concatenate((getattr(self, name), values)))
        self._changed()

    def remove(self, rows: NDArray) -> None:
        """Clouds are gone."""
        keep = np.ones(len(self), bool)
        keep[rows] = False
        for name in _COLUMNS:
            setattr(self, name, getattr(self, name)[keep])
        if len(self.kinds) > 2 * len(self) + _SPARE:
            self._forget_kinds()
        self._changed()

    def dissolve(self, row: int, tick: int) -> None:
        """A cloud begins to dissolve."""
        self.dying = self.dying.copy()
        self.dying[row] = tick
        self._changed()

    def drop_gone(self, tick: int) -> None:
        """Those that began to dissolve in this tick or before are gone."""
        if self.standing < len(self):
            gone = (self.dying != WHOLE) & (self.dying <= tick)
            if gone.any():
                self.remove(np.flatnonzero(gone))

    def replace(self, columns: list[NDArray], kinds: list[Kind]) -> None:
        """Take over all columns, in the order of their names at the top of this class."""
        for name, values in zip(_COLUMNS, columns, strict=True):
            setattr(self, name, values)
        self.kinds = kinds
        self._index = {kind: k for k, kind in enumerate(kinds)}
        self._changed()

    def _number(self, kind: Kind) -> int:
        known = self._index.get(kind)
        if known is None:
            known = self._index[kind] = len(self.kinds)
            self.kinds.append(kind)
        return known

    def _forget_kinds(self) -> None:
        """Leave out the kinds of which there is no cloud."""
        used, self.kind = np.unique(self.kind, return_inverse=True)
        self.kinds = [self.kinds[k] for k in used.tolist()]
        self._index = {kind: k for k, kind in enumerate(self.kinds)}

    def _changed(self) -> None:
        self.version += 1
        self._standing = self._extent = self._counts = None
