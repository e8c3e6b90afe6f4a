"""`CloudShades`: what clouds take of each other's light, a few clouds in a frame."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from weather_ecs.physics.cloud_shade import Bodies, taken
from weather_ecs.systems.cloud_shapes import Shape, Vector

IN_TURN, PAIRS = 2, 300  # clouds that a frame looks at again, and beside how many others in all
AT_ONCE = 64  # new ones that one step does
SETTLING = 1.5  # s, in which a cloud comes to show what was found


class CloudShades:
    """Follows the clouds by their keys; those that are new are looked at at once."""

    def __init__(self) -> None:
        self._keys = np.zeros(0, np.int64)
        self._found = np.zeros((0, 2))  # of sun and sky
        self._shown = np.zeros((0, 2))
        self._next = 0
        self._time = 0.0  # s, the weather's clock
        self._known: dict[int, tuple[float, ...]] = {}  # of shapes by their keys, see `_size`
        self._sizes = np.zeros((0, 5))
        self._shapes: list[Shape] = []

    def put(self, rows: NDArray, shapes: list[Shape], light: Vector, time: float) -> None:
        """Write what is shown now into the column `shaded` of all clouds."""
        self._measure(shapes)
        bodies = self._bodies(rows)
        towards = np.array(light)
        if not np.array_equal(rows["key"], self._keys):
            fresh = self._remap(rows["key"])
            for start in range(0, len(fresh), AT_ONCE):
                part = fresh[start : start + AT_ONCE]
                self._found[part] = self._shown[part] = _of(bodies, part, towards)
        if len(rows):
            count = min(IN_TURN, max(PAIRS // len(rows), 1), len(rows))
            turn = (self._next + np.arange(count)) % len(rows)
            self._found[turn] = _of(bodies, turn, towards)
            self._next = int(turn[-1]) + 1
        passed = min(max(time - self._time, 0.0), 10.0)
        self._time = time
        self._shown += (self._found - self._shown) * -np.expm1(-passed / SETTLING)
        rows["shaded"] = self._shown

    def _measure(self, shapes: list[Shape]) -> None:
        if len(shapes) == len(self._shapes) and all(
            a is b for a, b in zip(shapes, self._shapes, strict=True)
        ):
            return
        self._known = {each.key: self._known.get(each.key) or _size(each) for each in shapes}
        self._sizes = np.array([self._known[each.key] for each in shapes]).reshape(-1, 5)
        self._shapes = list(shapes)

    def _bodies(self, rows: NDArray) -> Bodies:
        sizes = self._sizes[rows["shape"]]
        scale = np.maximum(rows["scale"].astype(np.float64), 1e-6)
        half = sizes[:, :3] * scale[:, None]
        there = rows["opacity"] * rows["growth"]
        center = rows["position"].copy()
        center[:, 1] += sizes[:, 4] * scale
        return Bodies(center, half, sizes[:, 3] * there / scale)

    def _remap(self, keys: NDArray) -> NDArray[np.intp]:
        """The clouds are other ones: keep what is known; returns the rows of the new ones."""
        order = np.argsort(self._keys, kind="stable")
        place = np.searchsorted(self._keys, keys, sorter=order)
        place = order[np.minimum(place, max(len(order) - 1, 0))] if len(order) else place
        known = self._keys[place] == keys if len(order) else np.zeros(len(keys), bool)
        found, shown = np.zeros((len(keys), 2)), np.zeros((len(keys), 2))
        if len(order):
            found[known], shown[known] = self._found[place[known]], self._shown[place[known]]
        self._keys, self._found, self._shown = keys.copy(), found, shown
        return np.flatnonzero(~known)


def _of(bodies: Bodies, which: NDArray[np.intp], light: NDArray) -> NDArray[np.float64]:
    own = Bodies(*(column[which] for column in bodies))
    return taken(own, bodies, light)


def _size(shape: Shape) -> tuple[float, ...]:
    """Of the ellipsoid whose matter lies as the seeds do: half sizes, m, how dense it is, 1/m, and
    how high it stands over the shape's middle, m.

    It has their mean height and their variance, which a full ellipsoid has a fifth of its square.
    """
    volumes = np.prod(shape.made.sizes, axis=1)
    weights = (volumes / volumes.sum())[:, None]
    centers, sizes = shape.made.centers, shape.made.sizes
    middle = (weights * centers).sum(0)
    variance = (weights * ((centers - middle) ** 2 + sizes**2 / 12.0)).sum(0)
    half = np.maximum(np.sqrt(5.0 * variance), 1e-3)
    filled = min(float(volumes.sum() / (4.0 / 3.0 * np.pi * np.prod(half))), 1.0)
    dense = filled * shape.model.opacity / max(shape.model.light_penetration, 1e-3)
    return (*half.tolist(), dense, float(middle[1]))
