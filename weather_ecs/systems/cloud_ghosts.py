"""`CloudGhosts`: clouds that a game has taken away, as they dissolve; only a picture."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import CLOUD_DTYPE
from weather_ecs.systems.cloud_layer import FORMING, TICK
from weather_ecs.systems.cloud_shapes import Shape
from weather_ecs.systems.cloud_view import ease

SEEN = 0.25  # opacity times growth below which a cloud that goes leaves nothing behind
LASTING = FORMING * TICK  # s

_NO_ROWS = np.zeros(0, CLOUD_DTYPE)


class CloudGhosts:
    """Rows of clouds that no longer are, which drift on while they dissolve."""

    def __init__(self) -> None:
        self._rows = _NO_ROWS  # as they were when they were taken away
        self._since = np.zeros(0)  # s, the weather's clock then
        self.shapes: list[Shape] = []  # that the rows' indices mean

    def __len__(self) -> int:
        return len(self._rows)

    def take(self, rows: NDArray, shapes: list[Shape], kept: NDArray, time: float) -> None:
        """Of these rows, those go whose key is not in `kept`, at a time of the weather's clock."""
        gone = ~np.isin(rows["key"], kept) & (rows["opacity"] * rows["growth"] > SEEN)
        if gone.any():
            fresh = rows[gone]
            fresh["shape"] += len(self.shapes)
            self._rows = np.concatenate((self._rows, fresh))
            self._since = np.concatenate((self._since, np.full(len(fresh), time)))
            self.shapes += shapes

    def at(self, time: float) -> NDArray:
        """The rows at a time."""
        passed = time - self._since
        left = (passed >= 0.0) & (passed < LASTING)
        if not left.all():
            self._rows, self._since, passed = self._rows[left], self._since[left], passed[left]
            used, self._rows["shape"] = np.unique(self._rows["shape"], return_inverse=True)
            self.shapes = [self.shapes[k] for k in used.tolist()]
        rows = self._rows.copy()
        rows["position"] += rows["velocity"] * passed[:, None]
        rows["growth"] *= ease(1.0 - passed / LASTING)
        return rows

    def clear(self) -> None:
        """Nothing is left."""
        self._rows, self._since, self.shapes = _NO_ROWS, np.zeros(0), []
