"""Impostors (Harris and Lastra 2001): which clouds are drawn as pictures, and when those are taken.

A picture is taken from the camera's place towards the cloud, so turning the camera changes nothing;
it is taken again when the view angle, the size, the light or the cloud has changed too far, a few
in a frame, and then gives way to the new one over half a second.
"""

from __future__ import annotations

from dataclasses import dataclass

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.gpu.cloud_atlas import Atlas, Tile
from weather_ecs.gpu.cloud_bounds import picture_bounds, shared_octagon
from weather_ecs.gpu.cloud_kept import KEPT_DTYPE, state_of
from weather_ecs.gpu.cloud_scene import CloudScene
from weather_ecs.gpu.cloud_store import StoredShape

FADE = 0.5  # s, in which a new picture replaces the old one
CLOSE = 1.35  # reaches from a cloud's centre, nearer than which there are no impostors
VAST, CLOSE_TO_VAST = 3000.0, 1.12  # m of reach, from which it is so many: nobody soon gets far
SHARE = 0.5  # of the atlas, that the pictures of what is in view may take
ENOUGH = 0.7  # texels of a picture for each of its pixels
LARGE = 1.6  # pixels for each texel of the largest picture, above which billboards are drawn
UNIT = 96  # texels, height of a picture as the budget counts them
WAITING = 4  # times as many are taken of clouds that have none yet
PIXELS_OFF = 1.3  # parallax that is let be
_STATE = np.array([0.04, 0.05, 0.06, 0.04, 0.04, 0.06, 0.06])  # changes that are let be


@dataclass(slots=True)
class Plan:
    """What one draw does with the visible clouds."""

    real: NDArray[np.intp]  # with billboards
    take: list[tuple[int, int]]  # (cloud, height of the tile)
    largest: int = 0  # texels, height of a tile
    lost: int = 0  # clouds that found no room


class Impostors:
    """The pictures of one observer's clouds; `kept` is aligned with `FrameData.clouds`."""

    def __init__(self, ctx: moderngl.Context, height: int) -> None:
        self.atlas = Atlas(ctx, height)
        self.kept = np.zeros(0, KEPT_DTYPE)
        self._keys = np.zeros(0, np.int64)
        self._draws = self._stamp = 0
        self._light: NDArray[np.float64] | None = None

    def follow(self, scene: CloudScene, light: NDArray[np.float64], dt: float) -> None:
        """Take over the clouds of a draw. light: all that is not a cloud's own, as numbers."""
        self._draws += 1
        keys = scene.clouds["key"]
        if not np.array_equal(keys, self._keys):
            self._remap(keys)
        if self._light is None or len(light) != len(self._light):
            self._light = light
        elif float(np.abs(light - self._light).max()) > 0.02:
            self._light = light
            self._stamp += 1
        kept = self.kept
        kept["seen"][scene.visible] = self._draws
        fading = np.flatnonzero(kept["share"] < 1.0)
        if len(fading):
            kept["share"][fading] += dt / FADE
            for index in fading[kept["share"][fading] >= 1.0]:
                self._give_old(int(index))

    def _remap(self, keys: NDArray) -> None:
        """The clouds are other ones: keep what belongs to those that stay."""
        old = self.kept
        self.kept = np.zeros(len(keys), KEPT_DTYPE)
        self.kept["share"] = 1.0
        order = np.argsort(self._keys, kind="stable")
        place = np.searchsorted(self._keys, keys, sorter=order)
        place = np.minimum(place, max(len(order) - 1, 0))
        if len(order):
            source = order[place]
            same = self._keys[source] == keys
            self.kept[same] = old[source[same]]
            gone = np.ones(len(old), bool)
            gone[source[same]] = False
            for index in np.flatnonzero(gone):
                self._release_tiles(old[index])
        self._keys = keys.copy()

    def plan(
        self, scene: CloudScene, versions: NDArray, counts: NDArray, most: int, budget: int,
        largest: int,
    ) -> Plan:  # fmt: skip
        """Sort the visible clouds into billboards and impostors, and choose what to take anew.

        versions, counts: of the shapes' light and billboards, by cloud; most: billboards in all;
        budget: pictures taken in one draw; largest: height of a tile.
        """
        kept = self.kept
        has = kept["tile"][:, 2] > 0
        has &= kept["shape"] == versions[:, 0]
        size = scene.pixels
        near = scene.away < np.where(scene.reach > VAST, CLOSE_TO_VAST, CLOSE) * scene.reach
        # Once too large for a picture, a cloud stays so until it is clearly smaller.
        limit = LARGE * largest * np.where(kept["large"], 0.85, 1.0)
        wants = scene.visible & (near | (size > limit))
        if scene.parallel:
            wants = near = scene.visible
        error = self._errors(scene, versions[:, 1], size, largest)
        error[~has] = np.inf

        # With billboards: those that must, the nearest first, then those that wait for a picture.
        rank = np.lexsort((scene.away, ~wants, ~near))
        candidates = rank[(scene.visible & (wants | ~has))[rank]]
        fits = (np.cumsum(counts[candidates]) <= most) | near[candidates]
        real = candidates[fits]
        is_real = np.zeros(len(kept), bool)
        is_real[real] = True
        kept["real"], kept["large"] = is_real, wants

        must = np.flatnonzero(scene.visible & ~has & ~is_real)
        stale = ~near & (error > 1.0) & (scene.visible | ~has)
        stale &= ~(wants & is_real)
        stale[must] = False
        if scene.parallel:
            stale[:] = False
        error = np.where(scene.visible, error, 1.0 + 1.0 / (1.0 + scene.away))
        chosen = np.flatnonzero(stale)
        urgency = np.minimum(error[chosen], 1e6) * np.where(scene.visible[chosen], 1e3, 1.0)
        urgency += 1e-3 / (1.0 + scene.away[chosen])
        chosen = chosen[np.argsort(-urgency, kind="stable")]
        largest = self._room(size[scene.visible & ~(wants & is_real)], largest)
        plan = Plan(real, [], largest)
        for index in must.tolist():
            plan.take.append((index, _side(float(size[index]), largest)))
        waits = (scene.visible & ~has)[chosen]
        # Drawing a cloud that waits costs as much as taking its picture does.
        self._choose(plan, chosen[waits], size, WAITING * budget)
        self._choose(plan, chosen[~waits], size, max(budget - len(plan.take), 0))
        return plan

    def _choose(self, plan: Plan, chosen: NDArray, size: NDArray, most: int) -> None:
        """Take the pictures of the first of `chosen`; so many of UNIT, or fewer larger ones."""
        room = float(most * UNIT * UNIT)
        for index in chosen[:most].tolist():
            side = _side(float(size[index]), plan.largest)
            if plan.take and side * side > room:
                continue
            room -= side * side
            plan.take.append((index, side))

    def _room(self, size: NDArray, largest: int) -> int:
        """The largest tile with which pictures of so many pixels all have room."""
        room = SHARE * self.atlas.height**2
        sides = np.exp2(np.ceil(np.log2(np.maximum(ENOUGH * size, Atlas.SMALLEST))))
        while largest > Atlas.SMALLEST and (np.minimum(sides, largest) ** 2).sum() > room:
            largest //= 2
        return largest

    def _errors(
        self, scene: CloudScene, versions: NDArray, size: NDArray, largest: int
    ) -> NDArray[np.float64]:
        """How far each picture is from the truth; 1 is what is let be."""
        kept = self.kept
        way = scene.center / np.maximum(scene.away, 1e-6)[:, None]
        turned = np.linalg.norm(way - kept["way"], axis=1)
        error = turned * size / PIXELS_OFF
        grown = size / np.maximum(kept["pixels"], 1e-3)
        wanted = np.clip(ENOUGH * kept["need"] * grown, Atlas.SMALLEST, largest)
        have = np.maximum(kept["tile"][:, 2], 1)
        error = np.maximum(error, np.log2(np.maximum(wanted / have, 1e-6)) / 0.35)
        error = np.maximum(error, -np.log2(np.maximum(wanted / have, 1e-6)) / 2.2)
        error = np.maximum(error, 0.6 * (self._stamp - kept["stamp"]) + 0.5)
        error = np.maximum(error, np.where(kept["version"] != versions, 1.5, 0.0))
        change = np.abs(state_of(scene.clouds) - kept["state"]) / _STATE
        return np.maximum(error, change.max(axis=1))

    def place(
        self, scene: CloudScene, shape: StoredShape, index: int, largest: int
    ) -> tuple[Tile, NDArray[np.float32]] | None:
        """Room for a picture of a cloud, and the matrix it is taken with; None: no room.

        largest: height of a tile.
        """
        bounds = picture_bounds(scene, shape, index)
        need = max(bounds.half[0], 2.0 * bounds.half[1]) * scene.unit * shape.detail
        tile = self._take(_side(need, largest))
        if tile is None:
            return None
        kept = self.kept
        self._give_old(index)
        for name in ("tile", "quad", "cuts"):
            kept[f"old_{name}"][index] = kept[name][index]
        kept["tile"][index] = tile
        way, right, up = bounds.axes
        (mx, my), (hx, hy) = bounds.middle, bounds.half
        matrix = np.zeros((4, 4))
        matrix[0, :3] = (right - mx * way) / hx
        matrix[1, :3] = (up - my * way) / hy
        matrix[3, :3] = way
        far = scene.away[index]
        kept["quad"][index] = (far * (mx * right + my * up), far * hx * right, far * hy * up)
        kept["cuts"][index], kept["way"][index] = bounds.cuts, way
        kept["pixels"][index], kept["need"][index] = scene.pixels[index], need
        kept["version"][index], kept["shape"][index] = shape.versions, shape.data.key
        kept["stamp"][index] = self._stamp
        kept["state"][index] = state_of(scene.clouds[index : index + 1])[0]
        if kept["old_tile"][index, 2]:
            size, _ = self._shared(scene, np.array([index]))
            kept["share"][index] = 0.0
            # One so long out of date that it is no likeness gives way at once.
            if size[0] == np.inf:
                self._give_old(index)
        return tile, matrix.astype(np.float32)

    def quads(
        self, scene: CloudScene, which: NDArray[np.intp], haze: NDArray[np.float32]
    ) -> NDArray[np.float32]:
        """(m, 9, 4) as shaders/cloud_quad.vert reads them; haze (m, 4)."""
        kept = self.kept[which]
        rows = np.zeros((len(which), 9, 4), np.float32)
        center = scene.center[which]
        rows[:, :3, :3] = kept["quad"]
        rows[:, 0, :3] += center
        rows[:, 0, 3] = scene.clouds["opacity"][which]
        rows[:, 1, 3] = kept["share"]
        rows[:, 2, 3] = scene.clouds["flash"][which]
        rows[:, 3, :3] = self._frames(kept["tile"])
        rows[:, 4] = haze
        rows[:, 5:8, :3] = kept["old_quad"]
        rows[:, 5, :3] += center
        rows[:, 5:8, 3] = self._frames(kept["old_tile"])
        rows[:, 3, 3], rows[:, 8] = 1.0, kept["cuts"]
        # The older picture may show something where the newer one has nothing.
        both = np.flatnonzero(kept["share"] < 1.0)
        if len(both):
            size, cuts = self._shared(scene, which[both])
            some = np.isfinite(size)
            rows[both[some], 3, 3], rows[both[some], 8] = size[some], cuts[some]
            # The camera has moved so far meanwhile that the older one is no likeness.
            rows[both[~some], 1, 3] = 1.0
        return rows

    def _shared(self, scene: CloudScene, which: NDArray[np.intp]) -> tuple[NDArray, NDArray]:
        """Of clouds with two pictures, as `shared_octagon` has it."""
        kept = self.kept[which]
        for name in ("quad", "old_quad"):
            kept[name][:, 0] += scene.center[which]
        return shared_octagon(kept["quad"], kept["cuts"], kept["old_quad"], kept["old_cuts"])

    def _frames(self, tiles: NDArray) -> NDArray[np.float64]:
        """u, v and size of tiles, (m, 3); as Atlas.frame."""
        scale = 1.0 / self.atlas.height
        u, v, side = tiles[:, 0] + 0.25, tiles[:, 1] + 0.5, tiles[:, 2] - 1.0
        return np.stack([u, v, side], axis=1) * scale

    def _take(self, side: int) -> Tile | None:
        """A tile, if need be of a cloud long out of the picture, or a smaller one."""
        while side >= Atlas.SMALLEST:
            tile = self.atlas.space.take(side)
            if tile is not None:
                return tile
            idle = np.flatnonzero((self.kept["tile"][:, 2] > 0) & (self.kept["seen"] < self._draws))
            for index in idle[np.argsort(self.kept["seen"][idle], kind="stable")][:64]:
                self._release_tiles(self.kept[index])
                self.kept["tile"][index] = self.kept["old_tile"][index] = 0
                self.kept["share"][index] = 1.0
                tile = self.atlas.space.take(side)
                if tile is not None:
                    return tile
            side //= 2
        return None

    def _give_old(self, index: int) -> None:
        x, y, side = (int(v) for v in self.kept["old_tile"][index])
        if side:
            self.atlas.space.give((x, y, side))
        self.kept["old_tile"][index] = 0
        self.kept["share"][index] = 1.0

    def _release_tiles(self, entry: NDArray) -> None:
        for name in ("tile", "old_tile"):
            x, y, side = (int(v) for v in entry[name])
            if side:
                self.atlas.space.give((x, y, side))

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self.atlas.release()


def _side(pixels: float, largest: int) -> int:
    """Height of the tile for a picture of so many pixels."""
    side = Atlas.SMALLEST
    while side < largest and side < ENOUGH * pixels:
        side *= 2
    return side
