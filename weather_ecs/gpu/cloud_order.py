"""The order in which clouds are drawn, and how two that swap their places in it do so unseen.

Clouds float into each other, so which of two is in front is decided by their centres, and would be
seen to change. The one that comes to the front is drawn in both places for a while: in the old one
as before, in the new one over the other cloud, from nothing to all of it; then the old one fades.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from weather_ecs.gpu.cloud_scene import CloudScene

FADE = 0.8  # s, that a change of places takes
ARRIVED = 0.6  # of that time: the new place has all of it, and the old one begins to fade
TOUCHING = 0.85  # of the sum of two clouds' angular radii: nearer ones cover each other


@dataclass(slots=True)
class _Rise:
    """A cloud on its way over another, both by key."""

    above: int
    share: float = 0.0


class CloudOrder:
    """One observer's order of drawing."""

    def __init__(self) -> None:
        self._before = np.zeros(0, np.int64)  # keys, back to front, of the last draw
        self._rising: dict[int, _Rise] = {}

    def update(self, scene: CloudScene, dt: float) -> tuple[NDArray[np.intp], NDArray[np.float32]]:
        """What is drawn, back to front: clouds, some twice, and a factor on the opacity of each."""
        order = scene.order
        keys = scene.clouds["key"][order]
        self._notice(scene, keys)
        self._before = keys
        if not self._rising:
            return order, np.ones(len(order), np.float32)
        rank = {int(key): place for place, key in enumerate(keys.tolist())}
        shares = np.ones(len(order), np.float32)
        places, ghosts, left = [], [], []
        for key, rise in list(self._rising.items()):
            rise.share += dt / FADE
            here, there = rank.get(key), rank.get(rise.above)
            if here is None or there is None or here < there or rise.share >= 1.0:
                del self._rising[key]
                continue
            shares[here] = min(rise.share / ARRIVED, 1.0)
            places.append(there)
            ghosts.append(order[here])
            left.append(min((1.0 - rise.share) / (1.0 - ARRIVED), 1.0))
        if not places:
            return order, shares
        return np.insert(order, places, ghosts), np.insert(shares, places, left)

    def _notice(self, scene: CloudScene, keys: NDArray[np.int64]) -> None:
        """Find neighbours of the last order that have changed places while one covers the other."""
        if np.array_equal(self._before, keys):
            return
        ranks = {key: place for place, key in enumerate(keys.tolist())}
        both = [ranks.get(key, -1) for key in self._before.tolist()]
        rank = np.array(both, np.intp)
        before, rank = self._before[rank >= 0], rank[rank >= 0]
        swapped = np.flatnonzero(rank[:-1] > rank[1:])
        if not len(swapped):
            return
        front, back = scene.order[rank[swapped]], scene.order[rank[swapped + 1]]
        way = scene.center / np.maximum(scene.away, 1e-6)[:, None]
        cosine = np.einsum("ij,ij->i", way[front], way[back])
        radius = np.arcsin(np.minimum(scene.reach / np.maximum(scene.away, 1e-6), 1.0))
        touching = np.arccos(np.clip(cosine, -1.0, 1.0)) < TOUCHING * (radius[front] + radius[back])
        for place in np.flatnonzero(touching).tolist():
            key = int(before[swapped[place]])
            other = int(before[swapped[place] + 1])
            if self._rising.get(other, _Rise(0)).above == key:
                # It turns back before it has arrived: the other one rises again from there.
                share = self._rising.pop(other).share
                self._rising[key] = _Rise(other, 1.0 - share)
            else:
                self._rising.setdefault(key, _Rise(other))
