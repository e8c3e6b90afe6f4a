"""`OccluderList`: the occluders as the GPU is told of them."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any
from weakref import WeakKeyDictionary

import esper

from weather_ecs.components import Occluder
from weather_ecs.components.collision_heightmap import ALL_LAYERS
from weather_ecs.frame import OccluderData
from weather_ecs.systems.queries import leaving, living


class OccluderList:
    """One `OccluderData` for each occluder, made again only when that occluder has changed."""

    def __init__(self) -> None:
        self._known: WeakKeyDictionary[Occluder, OccluderData] = WeakKeyDictionary()
        # The living ones, and what they were the last time, in their order.
        self._living: list[Occluder] = []
        self._last: Sequence[OccluderData | None] = ()
        self._next_key = 0
        self._list: list[Any] | None = None
        self._state = -1, ALL_LAYERS, 0  # revision, layers, pending deletions
        self._data: tuple[OccluderData, ...] = ()

    def collect(self, layers: int = ALL_LAYERS) -> tuple[OccluderData, ...]:
        """The living occluders on any of some layers; the same tuple where nothing has changed."""
        pairs = esper.get_component(Occluder)
        # A deletion that is pending does not show in esper's list.
        state = Occluder.revision(), layers, leaving(entity for entity, _ in pairs)
        if pairs is not self._list or state[2] != self._state[2]:
            self._living = [occluder for _, occluder in living(Occluder)]
            self._last = [self._known.get(occluder) for occluder in self._living]
        if pairs is not self._list or state != self._state:
            self._list, self._state = pairs, state
            found = zip(self._living, self._last, strict=True)
            now = [self._of(occluder, known) for occluder, known in found]
            hit = zip(self._living, now, strict=True)
            self._data = tuple([data for occluder, data in hit if occluder.layers & layers])
            self._last = now
        return self._data

    def _of(self, occluder: Occluder, known: OccluderData | None) -> OccluderData:
        if (
            known is not None
            and known.transform is occluder.transform
            and known.vertices is occluder.vertices
            and known.indices is occluder.indices
            and known.dynamic is occluder.dynamic
            and known.draw is occluder.draw
        ):
            return known
        key = self._next_key if known is None else known.key
        self._next_key += known is None
        assert occluder.transform is not None  # the component makes None the identity
        data = self._known[occluder] = OccluderData(
            key,
            occluder.transform,
            occluder.dynamic,
            occluder.vertices,
            occluder.indices,
            occluder.draw,
        )
        return data
