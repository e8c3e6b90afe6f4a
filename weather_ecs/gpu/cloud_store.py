"""The clouds' shapes on the GPU: billboards and seeds in textures, brought up to date by shape."""

from __future__ import annotations

from dataclasses import dataclass
from operator import is_not

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import CloudShapeData
from weather_ecs.gpu.cloud_sides import Mask, hidden_sides
from weather_ecs.physics.cloud_images import IMAGE_DETAIL
from weather_ecs.physics.cloud_spread import Spread

ROW = 256  # items in a row of a texture


@dataclass(slots=True)
class StoredShape:
    """A shape as the GPU knows it."""

    data: CloudShapeData
    first: int  # of its billboards in the texture, a multiple of ROW
    seeds: int  # its first seed, a multiple of ROW
    low: NDArray[np.float64]  # (3,) m, of the box round its seeds
    high: NDArray[np.float64]
    half: NDArray[np.float64]  # (3,) half of that box's sizes, m
    base: float  # m, its underside
    position: NDArray[np.float32]  # (n, 3) of the billboards, m
    spread: Spread
    reach: float  # m, of the sphere round the centre that holds every billboard
    detail: float  # 0 to 1: how much of the picture's resolution it needs
    wide: float  # m, of a billboard in the middle of their order by width
    wide_top: float  # the same with those that only who is above it sees
    before: NDArray[np.float32]  # absorptions that it comes from
    sides: tuple[Mask, Mask] | None  # billboards hidden from below, and from above
    fresh: float = 1.0  # share of those it has now
    versions: int = 0  # counts what changes its picture


class ItemTexture:
    """A float texture of items, `texels` each, in rows of ROW; rows are taken and given back."""

    def __init__(self, ctx: moderngl.Context, texels: int) -> None:
        self._ctx, self._texels = ctx, texels
        self._data = np.zeros((4, ROW, texels, 4), np.float32)
        self._taken = np.zeros(4, bool)
        self.texture = self._make()

    def _make(self) -> moderngl.Texture:
        size = (ROW * self._texels, len(self._data))
        texture = self._ctx.texture(size, 4, self._data.tobytes(), dtype="f4")
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        return texture

    def take(self, items: NDArray[np.float32]) -> int:
        """Put (n, texels, 4) in; the index of the first."""
        rows = max(-(-len(items) // ROW), 1)
        row = self._find(rows)
        while row < 0:
            grown = np.zeros_like(self._data)
            self._data = np.concatenate([self._data, grown])
            self._taken = np.concatenate([self._taken, np.zeros(len(grown), bool)])
            row = self._find(rows)
        self._taken[row : row + rows] = True
        self.put(row * ROW, items)
        return row * ROW

    def _find(self, rows: int) -> int:
        """First of so many free rows in line, or -1."""
        free = np.concatenate([[0], np.cumsum(~self._taken)])
        runs = np.flatnonzero(free[rows:] - free[:-rows] == rows)
        return int(runs[0]) if len(runs) else -1

    def put(self, first: int, items: NDArray[np.float32]) -> None:
        """Replace items from `first`, the beginning of a row, on."""
        row, rows = first // ROW, max(-(-len(items) // ROW), 1)
        part = self._data[row : row + rows].reshape(rows * ROW, self._texels, 4)
        part[: len(items)] = items
        if self.texture.height < len(self._data):
            self.texture.release()
            self.texture = self._make()
        else:
            box = (0, row, ROW * self._texels, rows)
            self.texture.write(self._data[row : row + rows].tobytes(), viewport=box)

    def give(self, first: int, count: int) -> None:
        row = first // ROW
        self._taken[row : row + max(-(-count // ROW), 1)] = False

    def release(self) -> None:
        self.texture.release()


class CloudStore:
    """All shapes of the frames drawn lately; `shapes` is aligned with the frame's tuple."""

    FADE = 1.0  # s, in which a new absorption comes in

    def __init__(self, ctx: moderngl.Context) -> None:
        self.billboards = ItemTexture(ctx, 6)
        self.seeds = ItemTexture(ctx, 2)
        self.shapes: list[StoredShape] = []
        self.half = np.zeros((0, 3))
        self.base = self.reach = self.thick = self.detail = np.zeros(0)
        self.wide = self.wide_top = np.zeros(0)
        self.low = self.high = np.zeros((0, 3))
        self.keys, self.counts = np.zeros(0, np.int64), np.zeros(0, np.intp)
        self._known: dict[int, StoredShape] = {}
        self._tuple: tuple[CloudShapeData, ...] = ()
        self._fading: set[int] = set()

    def update(self, shapes: tuple[CloudShapeData, ...], dt: float) -> None:
        """Take over the shapes of a frame, `dt` s after the last."""
        self._fade(dt)
        if shapes is self._tuple:
            return
        self._tuple = shapes
        before, stored = self.shapes, []
        for data in shapes:
            known = self._known.get(data.key)
            if known is not None and known.data is not data:
                known = self._renew(known, data)
            stored.append(known or self._add(data))
        self.shapes = stored
        if len(before) != len(stored) or any(map(is_not, before, stored)):
            self.half = np.array([s.half for s in stored]).reshape(-1, 3)
            self.base = np.array([s.base for s in stored])
            self.reach = np.array([s.reach for s in stored])
            self.detail = np.array([s.detail for s in stored])
            self.wide = np.array([s.wide for s in stored])
            self.wide_top = np.array([s.wide_top for s in stored])
            self.low = np.array([s.low for s in stored]).reshape(-1, 3)
            self.high = np.array([s.high for s in stored]).reshape(-1, 3)
            self.keys = np.array([s.data.key for s in stored], np.int64)
            self.counts = np.array([len(s.position) for s in stored], np.intp)
            self.thick = np.array([1.0 / max(s.data.penetration, 1e-3) for s in stored])
        if len(self._known) > len(shapes):
            living = {data.key for data in shapes}
            for key in [key for key in self._known if key not in living]:
                self._drop(key)

    def _fade(self, dt: float) -> None:
        for key in list(self._fading):
            shape = self._known[key]
            shape.fresh = min(shape.fresh + dt / self.FADE, 1.0)
            if shape.fresh >= 1.0:
                self._fading.discard(key)

    def _add(self, data: CloudShapeData) -> StoredShape:
        b = data.billboards
        seeds = self.seeds.take(_seed_items(data, data.absorbed))
        position = np.ascontiguousarray(b["position"], np.float32)
        reach = np.column_stack([b["size"][:, 0], b["size"][:, 1], b["size"][:, 0]]) * 0.5
        low = (position - reach).min(0) if len(b) else np.zeros(3)
        high = (position + reach).max(0) if len(b) else np.ones(3)
        base = float((data.centers[:, 1] - 0.5 * data.sizes[:, 1]).min()) if len(b) else 0.0
        low[1] = max(low[1], min(base, float(high[1]) - 1e-3) - 0.1 * (high[1] - low[1]))
        spread = Spread.over(position, b["seed"], data.centers, data.sizes)
        items = _items(data, seeds)
        _put_light(items, spread, data, data.absorbed)
        sides = hidden_sides(data)
        usual = b[~(sides[0] | sides[1])] if sides else b
        shape = StoredShape(
            data,
            self.billboards.take(items),
            seeds,
            *_box(data),
            np.maximum(0.5 * (high - low), 1e-3).astype(np.float64),
            base,
            position,
            spread,
            float((np.linalg.norm(position, axis=1) + reach.max(1)).max()) if len(b) else 1.0,
            float(np.take(IMAGE_DETAIL, usual["image"]).mean()) if len(b) else 1.0,
            float(np.median(usual["size"][:, 0])) if len(b) else 1.0,
            float(np.median(b["size"][:, 0])) if len(b) else 1.0,
            np.asarray(data.absorbed, np.float32),
            sides,
        )
        self._known[data.key] = shape
        return shape

    def _renew(self, known: StoredShape, data: CloudShapeData) -> StoredShape | None:
        """The same shape with other light; None where it is another shape under an old key."""
        old = known.data
        same = data.billboards is old.billboards or np.array_equal(data.billboards, old.billboards)
        if not same or len(data.centers) != len(old.centers):
            self._drop(data.key)
            return None
        if data.absorbed is not old.absorbed:
            now = known.before + (old.absorbed - known.before) * np.float32(known.fresh)
            known.before, known.fresh = now, 0.0
            known.versions += 1
            self._fading.add(data.key)
            self.seeds.put(known.seeds, _seed_items(data, now))
            items = _items(data, known.seeds)
            _put_light(items, known.spread, data, now)
            self.billboards.put(known.first, items)
        known.data = data
        return known

    def _drop(self, key: int) -> None:
        shape = self._known.pop(key)
        self._fading.discard(key)
        self.billboards.give(shape.first, len(shape.position))
        self.seeds.give(shape.seeds, len(shape.data.centers))

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self._known.clear()
        self.billboards.release()
        self.seeds.release()


def _box(data: CloudShapeData) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """The least and the greatest corner of the seeds."""
    if not len(data.centers):
        return np.zeros(3), np.zeros(3)
    half = 0.5 * data.sizes.astype(np.float64)
    return (data.centers - half).min(axis=0), (data.centers + half).max(axis=0)


def _items(data: CloudShapeData, seeds: int) -> NDArray[np.float32]:
    """(n, 6, 4) as shaders/cloud_row.glsl reads them, light apart."""
    b = data.billboards
    items = np.zeros((len(b), 6, 4), np.float32)
    items[:, 0, :3], items[:, 0, 3] = b["position"], b["turn"]
    items[:, 1, :2], items[:, 1, 2] = b["size"], b["image"]
    items[:, 1, 3] = b["seed"] + seeds
    items[:, 2, 0], items[:, 2, 1] = b["order"], b["opacity"]
    return items


def _put_light(
    items: NDArray[np.float32], spread: Spread, data: CloudShapeData, before: NDArray
) -> None:
    items[:, 3, :3] = spread.centers
    items[:, 4] = spread.field(before)
    items[:, 5] = spread.field(data.absorbed)


def _seed_items(data: CloudShapeData, before: NDArray) -> NDArray[np.float32]:
    items = np.zeros((len(data.centers), 2, 4), np.float32)
    items[:, 0, :3], items[:, 0, 3] = data.centers, before
    items[:, 1, :3], items[:, 1, 3] = data.sizes, data.absorbed
    return items
