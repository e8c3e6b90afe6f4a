"""`CloudList`: all clouds in the sky and the shapes they stand with, for the GPU."""

from __future__ import annotations

from operator import is_
from typing import Any

import esper
import numpy as np
from numpy.typing import NDArray

from weather_ecs.components import Cloud, CloudModel, SkyLayer
from weather_ecs.frame import CLOUD_DTYPE, CloudShapeData, SkyLight, WindProfile, empty
from weather_ecs.systems.cloud_field import CloudField
from weather_ecs.systems.cloud_ghosts import LASTING, CloudGhosts
from weather_ecs.systems.cloud_layer import TICK, LayerClouds
from weather_ecs.systems.cloud_made import MadeClouds, Wind
from weather_ecs.systems.cloud_shades import CloudShades
from weather_ecs.systems.cloud_shapes import Shape
from weather_ecs.systems.cloud_view import LayerView, ease
from weather_ecs.systems.clouds import STEPS, start_layer
from weather_ecs.systems.kinds import world_mark
from weather_ecs.systems.queries import alive
from weather_ecs.systems.state import WeatherState

NO_CLOUDS = empty(CLOUD_DTYPE)
_KINDS = (Cloud, CloudModel, SkyLayer)


class _Seen:
    """A layer as it was drawn last."""

    def __init__(self, since: float | None) -> None:
        self.view = LayerView()
        self.since = since  # s, the clock when it came in place of others; None: as it is
        self.state: tuple[Any, ...] = ()  # that the view was built of
        self.wanted: list[Shape] = []  # that have not been lit
        self.lit = 0  # of the library, then
        self.rows = NO_CLOUDS

    def last(self) -> NDArray:
        """The rows as they were drawn, with the view's own indices of shapes."""
        rows = self.rows.copy()
        rows["shape"] = self.view.rows["shape"]
        return rows


class CloudList:
    """Rows of all clouds, and shapes; those that nobody has lit yet are left out."""

    def __init__(self) -> None:
        self._field: CloudField | None = None
        self._seen: dict[int, _Seen] = {}  # by uid of the layer
        self._previews: dict[int, tuple[tuple[int, ...], LayerClouds]] = {}
        self._made = MadeClouds()
        self._ghosts = CloudGhosts()
        self._shades = CloudShades()
        self._shapes: tuple[CloudShapeData, ...] = ()
        self._changed = False  # shapes may have come out of use
        self._rows = NO_CLOUDS
        self._lists: list[Any] = []
        self._entities: list[int] = []
        self._now: tuple[Any, ...] = ()
        self._clear: object = None  # mark of the world in which there is no cloud

    def collect(
        self, state: WeatherState, sky: SkyLight, wind: Wind, profile: WindProfile
    ) -> tuple[NDArray, tuple[CloudShapeData, ...]]:
        """The clouds now; `wind` and `profile` are the frame's.

        Both are the same objects as before where nothing has changed.
        """
        mark = world_mark()
        if mark is self._clear:
            return self._rows, self._shapes
        lists = [esper.get_component(kind) for kind in _KINDS]
        if self._is_clear() and not any(lists):
            self._clear = mark
            return self._rows, self._shapes
        self._clear = None
        revisions = tuple([kind.revision() for kind in _KINDS])
        light = state.cloud_shapes.version
        now = (state.clock.time, state.clouds, light, revisions, sky, wind, profile)
        same = now == self._now and all(map(is_, lists, self._lists))
        if not same or not all(map(esper.entity_exists, self._entities)):
            self._lists = lists
            found = [pair[0] for pairs in lists for pair in pairs]
            self._entities = [entity for entity in found if esper.entity_exists(entity)]
            self._rows, self._shapes = self._collect(state, sky, wind, profile)
            self._now = (*now[:2], state.cloud_shapes.version, *now[3:])
        return self._rows, self._shapes

    def _is_clear(self) -> bool:
        """Whether nothing is left of any cloud there was."""
        return not (len(self._rows) or self._shapes or self._seen or len(self._ghosts))

    def _collect(
        self, state: WeatherState, sky: SkyLight, wind: Wind, profile: WindProfile
    ) -> tuple[NDArray, tuple[CloudShapeData, ...]]:
        clock = state.clock
        if state.clouds is not self._field:  # the first frame, or a snapshot was restored
            self._field = state.clouds
            self._seen = {}
            self._ghosts.clear()
        layers = alive(SkyLayer, state.uids)
        passed = clock.time - clock.steps // STEPS * TICK
        self._leave({uid for uid, _ in layers}, clock.time)
        found: list[tuple[NDArray, list[Shape]]] = []
        for uid, layer in layers:
            record = state.clouds.layers.get(uid) or self._preview(state, uid, layer)
            seen = self._seen.get(uid)
            if seen is None:
                since = clock.time if len(self._ghosts) and not clock.paused else None
                seen = self._seen[uid] = _Seen(since)
            self._build(state, seen, record, layer, sky)
            rows = seen.view.at(record, layer, profile, passed)
            if seen.since is not None:
                rows["growth"] *= ease(np.array((clock.time - seen.since) / LASTING))
            seen.rows = rows
            found.append((rows, seen.view.shapes))
        self._take_made(state, sky, profile)
        found.append((self._made.at(wind, passed), self._made.shapes))
        if clock.paused:
            self._ghosts.clear()
        found.append((self._ghosts.at(clock.time), self._ghosts.shapes))
        return self._join(state, found, sky)

    def _build(
        self,
        state: WeatherState,
        seen: _Seen,
        record: LayerClouds,
        layer: SkyLayer,
        sky: SkyLight,
    ) -> None:
        """Make a layer's view anew if anything it is built of has changed."""
        library = state.cloud_shapes
        place = (layer.base, layer.variation, layer.skies)
        now = (record.array, record.array.version, CloudModel.revision(), place)
        if now == seen.state and (not seen.wanted or library.lit == seen.lit):
            return
        models = state.models.of_skies(layer.skies, state.uids)
        before, rows = seen.view.shapes, seen.last()
        wanted = seen.view.build(record, layer, models, library)
        edited = seen.state[2:3] != now[2:3]
        if wanted and (edited or 2 * len(seen.view.rows) < len(record.array)):
            # The start, or other skies or models: clouds that come in one by one can wait.
            for shape in wanted:
                library.light_new(shape, sky.cloud_direction)
            wanted = seen.view.build(record, layer, models, library)
        self._ghosts.take(rows, before, seen.view.rows["key"], state.clock.time)
        seen.state, seen.wanted, seen.lit = now, wanted, library.lit
        self._changed = True

    def _take_made(self, state: WeatherState, sky: SkyLight, profile: WindProfile) -> None:
        """The game's own clouds; all are lit at once at the start and where a model has changed."""
        made, library = self._made, state.cloud_shapes
        if not made.collect(state.models, library, state.uids, profile):
            return
        if made.wanted and (made.edited or not made.shapes):
            for shape in made.wanted:
                if shape.data is None:
                    library.light_new(shape, sky.cloud_direction)
            made.collect(state.models, library, state.uids, profile)
        self._changed = True

    def _leave(self, living: set[int], time: float) -> None:
        """Layers are gone."""
        for uid in [uid for uid in self._seen if uid not in living]:
            seen = self._seen.pop(uid)
            self._ghosts.take(seen.last(), seen.view.shapes, NO_CLOUDS["key"], time)
            self._previews.pop(uid, None)

    def _preview(self, state: WeatherState, uid: int, layer: SkyLayer) -> LayerClouds:
        """What the next step will make of a layer that it has not seen."""
        now = (SkyLayer.revision(), CloudModel.revision())
        known = self._previews.get(uid)
        if known is None or known[0] != now:
            known = self._previews[uid] = (now, start_layer(state, uid, layer))
        return known[1]

    def _join(
        self, state: WeatherState, found: list[tuple[NDArray, list[Shape]]], sky: SkyLight
    ) -> tuple[NDArray, tuple[CloudShapeData, ...]]:
        places: dict[int, int] = {}
        shapes: list[Any] = []
        stand: list[Shape] = []
        for rows, own in found:
            index = []
            for shape in own:
                place = places.setdefault(shape.key, len(places))
                if place == len(shapes):
                    shapes.append(shape.data)
                    stand.append(shape)
                index.append(place)
            if len(rows):
                rows["shape"] = np.array(index)[rows["shape"]]
        if self._changed:
            self._changed = False
            wanted = [shape.key for seen in self._seen.values() for shape in seen.wanted]
            state.cloud_shapes.prune({*places, *wanted, *[s.key for s in self._made.wanted]})
        if len(shapes) != len(self._shapes) or not all(map(is_, shapes, self._shapes)):
            self._shapes = tuple(shapes)
        if not any(len(rows) for rows, _ in found):
            return NO_CLOUDS, self._shapes
        rows = np.concatenate([rows for rows, _ in found])
        if state.drawn:
            self._shades.put(rows, stand, sky.cloud_direction, state.clock.time)
        rows.setflags(write=False)
        return rows, self._shapes
