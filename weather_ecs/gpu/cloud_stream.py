"""The stream of billboards to draw: each cloud's, sorted from the farthest to the nearest.

A cloud is sorted when it is drawn with billboards and the camera has moved against it, by one call
of NumPy; far clouds are drawn as impostors and not sorted at all.
"""

from __future__ import annotations

import math
from operator import is_

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.gpu.cloud_scene import CloudScene
from weather_ecs.gpu.cloud_store import CloudStore, StoredShape

WIDTH = 1024  # items in a row of the texture
_MOVED = 0.004  # of the distance to a billboard: less leaves the order as it was


class CloudStream:
    """(billboard, row of the cloud) pairs in a texture, filled once a draw."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._height = 4
        self.texture = self._make()
        self._sorted: dict[int, tuple[StoredShape, NDArray, NDArray[np.uint32]]] = {}
        self._used: set[int] = set()
        self._written: list[NDArray[np.uint32]] = []  # what the texture holds

    def _make(self) -> moderngl.Texture:
        texture = self._ctx.texture((WIDTH, self._height), 2, dtype="u4")
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        return texture

    def fill(self, scene: CloudScene, store: CloudStore, which: NDArray[np.intp]) -> NDArray:
        """Put in the clouds `which`, the k-th with row k; (m + 1,) where each begins."""
        begins = np.zeros(len(which) + 1, np.intp)
        if not len(which):
            return begins
        clouds = scene.clouds[which]
        shapes = [store.shapes[shape] for shape in clouds["shape"].tolist()]
        eyes = eyes_in_shapes(scene.center[which], clouds)
        each = zip(clouds["key"].tolist(), shapes, eyes, strict=True)
        orders = [self._order(*cloud) for cloud in each]
        np.cumsum([len(order) for order in orders], out=begins[1:])
        self._write(orders)
        return begins

    def fill_unsorted(self, scene: CloudScene, store: CloudStore, which: NDArray[np.intp]) -> int:
        """Put in the clouds `which` in any order of their billboards; how many these are."""
        shapes = [store.shapes[index] for index in scene.shapes[which].tolist()]
        orders = [np.arange(s.first, s.first + len(s.position), dtype=np.uint32) for s in shapes]
        return self._write(orders) if orders else 0

    def _write(self, orders: list[NDArray[np.uint32]]) -> int:
        counts = [len(order) for order in orders]
        total = sum(counts)
        if len(orders) == len(self._written) and all(map(is_, orders, self._written)):
            return total  # it is all there
        self._written = orders
        rows = -(-total // WIDTH)
        if rows > self._height:
            while self._height < rows:
                self._height *= 2
            self.texture.release()
            self.texture = self._make()
        if rows:
            pairs = np.zeros((rows * WIDTH, 2), np.uint32)
            pairs[:total, 0] = np.concatenate(orders)
            pairs[:total, 1] = np.repeat(np.arange(len(orders), dtype=np.uint32), counts)
            self.texture.write(pairs.tobytes(), viewport=(0, 0, WIDTH, rows))
        return total

    def _order(self, key: int, shape: StoredShape, eye: NDArray) -> NDArray[np.uint32]:
        self._used.add(key)
        known = self._sorted.get(key)
        if known is not None and known[0] is shape:
            moved = eye - known[1]
            near = max(math.sqrt(eye @ eye) - shape.reach, 0.05 * shape.reach)
            if float(moved @ moved) < (_MOVED * near) ** 2:
                return known[2]
        away = shape.position - eye.astype(np.float32)
        order = np.argsort(-np.einsum("ij,ij->i", away, away), kind="stable")
        if shape.sides is not None and abs(eye[1]) > -shape.base:
            order = order[~shape.sides[int(eye[1] > 0.0)][order]]
        found = (order + shape.first).astype(np.uint32)
        self._sorted[key] = (shape, eye, found)
        return found

    def beyond(self, scene: CloudScene, which: NDArray[np.intp], distance: float) -> NDArray:
        """(m,) how many of the first billboards of clouds `which` are farther off than that, m."""
        away, reach = scene.away[which], scene.reach[which]
        counts = np.zeros(len(which), np.intp)
        for k, index in enumerate(which.tolist()):
            if away[k] + reach[k] <= distance:
                continue
            shape, eye, order = self._sorted[int(scene.clouds["key"][index])]
            counts[k] = len(order)
            if away[k] - reach[k] < distance:
                way = shape.position[order - shape.first] - eye.astype(np.float32)
                far = np.sqrt(np.einsum("ij,ij->i", way, way)) * scene.clouds["scale"][index]
                counts[k] = np.count_nonzero(far > distance)
        return counts

    def forget_unused(self) -> None:
        """Drop the orders of clouds that were not drawn since the last call."""
        if len(self._sorted) > len(self._used):
            self._sorted = {k: v for k, v in self._sorted.items() if k in self._used}
        self._used.clear()

    def release(self) -> None:
        self._sorted.clear()
        self._written = []
        self.texture.release()


def eyes_in_shapes(center: NDArray, clouds: NDArray) -> NDArray[np.float64]:
    """(m, 3) the camera in the own axes of clouds' shapes, m; the inverse of
    physics/cloud_billboard.place. center: (m, 3) of the clouds, from the camera.
    """
    x, y, z = -center.T
    shear, heading = clouds["shear"].astype(np.float64), clouds["heading"].astype(np.float64)
    x = x - shear[:, 0] * y
    z = z - shear[:, 1] * y
    c, s = np.cos(heading), np.sin(heading)
    own = np.stack([(x * c - z * s) * clouds["mirror"], y, z * c + x * s], axis=1)
    found: NDArray[np.float64] = own / np.maximum(clouds["scale"].astype(np.float64), 1e-9)[:, None]
    return found
