"""`ExtractSystem`: publishes the weather as one `FrameData`."""

from __future__ import annotations

from dataclasses import replace
from operator import is_
from typing import Any

import esper
import numpy as np
from numpy.typing import NDArray

from weather_ecs.components import (
    SNAPSHOT_COMPONENTS,
    Air,
    CollisionHeightmap,
    Fog,
    Lightning,
    Occluder,
    PointLight,
    RainArea,
    RainContainer,
    RainGauge,
    RippleSurface,
    SnowFlakes,
    SplashEmitter,
    Sun,
    Wind,
)
from weather_ecs.components._base import Component
from weather_ecs.components.cloud_shading import CloudShading
from weather_ecs.components.collision_heightmap import ALL_LAYERS
from weather_ecs.frame import (
    AREA_DTYPE,
    LIGHT_DTYPE,
    AirData,
    CloudShapeData,
    DropLook,
    FogData,
    FrameData,
    GaugeData,
    HeightmapLook,
    LightningLook,
    OccluderData,
    SkyLight,
    SnowLook,
    SplashLook,
    empty,
)
from weather_ecs.systems.air import air_data, fog_data
from weather_ecs.systems.atmosphere import Daylight
from weather_ecs.systems.cloud_list import NO_CLOUDS, CloudList
from weather_ecs.systems.gauge import GaugeList
from weather_ecs.systems.glance import Glance, look
from weather_ecs.systems.kinds import Kinds
from weather_ecs.systems.lightning import settings_of
from weather_ecs.systems.looks import (
    cloud_look,
    drop_look,
    heightmap_look,
    snow_look,
    splash_look,
    sun_light,
)
from weather_ecs.systems.occluders import OccluderList
from weather_ecs.systems.queries import alive
from weather_ecs.systems.rain_area import area_rows, drift_velocity, dry_spells
from weather_ecs.systems.ripples import RippleList
from weather_ecs.systems.state import WeatherState
from weather_ecs.systems.strike_list import StrikeList, look_of
from weather_ecs.systems.wind import CALM, varies, winds_at

_KINDS = (
    RainArea,
    Wind,
    PointLight,
    Sun,
    RainContainer,
    SnowFlakes,
    SplashEmitter,
    RippleSurface,
    CollisionHeightmap,
    Air,
    Fog,
    CloudShading,
    Lightning,
)
_MORE = {*SNAPSHOT_COMPONENTS.values(), Occluder, RainGauge} - {*_KINDS}
_ALL: tuple[type[Component], ...] = (*_KINDS, *_MORE)
_COUNT = len(_KINDS)
_NO_AREAS = empty(AREA_DTYPE)
_NO_LIGHTS = empty(LIGHT_DTYPE)


class ExtractSystem:
    """Publishes one `FrameData` a frame; what has not changed since the last one is shared.

    `run` only says that a new frame is due. The arrays are made when somebody first looks at
    them, so that a server, which draws nothing, pays nothing, and a game that changes a component
    after `esper.process` sees the change in the same frame.
    """

    def __init__(self) -> None:
        self._frame: FrameData | None = None
        self._lists: list[list[Any]] = []
        self._revisions: list[int] = []
        self._entities: list[int] = []
        self._still: NDArray = _NO_AREAS  # the areas where the last fixed step left them
        self._changing: list[tuple[int, RainArea]] = []  # areas whose rain begins or ends
        self._fronts_seen = (0, 0)
        self._velocity: NDArray | None = None  # (n, 2), m/s; None where all stand still
        self._drifting: list[RainArea] = []  # all areas, where the wind that carries them varies
        self._winds: list[tuple[int, Wind]] = []  # where any of them varies
        self._wind, self._profile = (0.0, 0.0, 0.0), CALM
        self._parts: tuple[NDArray, SkyLight, DropLook]
        self._air, self._fog = AirData(), FogData()
        self._daylight = Daylight()
        self._light: SkyLight | None = None  # of an atmosphere
        self._flakes = SnowLook()
        self._splash: SplashLook | None = None
        self._occluders = OccluderList()
        self._ripples = RippleList()
        self._heightmap, self._layers = HeightmapLook(), ALL_LAYERS
        self._gauges = GaugeList()
        self._clouds = CloudList()
        self._strikes, self._lightning, self._brightness = StrikeList(), LightningLook(), 0.0
        self._time = -1.0
        self._seen: tuple[Any, ...] = ()  # what the last frame was made of
        self._glance, self._kinds = Glance(), Kinds(_ALL)

    @property
    def gauges(self) -> dict[int, RainGauge]:
        """The gauges of the last frame by key, for their readings."""
        return self._gauges.gauges

    @property
    def ripples(self) -> RippleList:
        """The water surfaces as they were taken over."""
        return self._ripples

    def run(self, state: WeatherState) -> None:
        """A new frame is due."""
        self._time, self._seen = -1.0, ()
        self._glance.forget()

    def frame(self, state: WeatherState) -> FrameData:
        """The weather now; the same object as before where nothing has changed."""
        if self._glance.same(state) and self._frame is not None:
            return self._frame
        seen = look(state, self._kinds)
        if seen != self._seen or self._frame is None:
            self._extract(state, seen[0][:_COUNT], seen[-1])
            self._seen = seen
        self._glance.keep()
        assert self._frame is not None
        return self._frame

    def _extract(
        self, state: WeatherState, revisions: list[int], lists: list[list[Any]]
    ) -> FrameData:
        if (
            self._frame is None
            or revisions != self._revisions
            or (lists is not self._lists and not all(map(is_, lists[:_COUNT], self._lists)))
            or not all(map(esper.entity_exists, self._entities))
            or (state.fronts.number, state.fronts.revision) != self._fronts_seen
        ):
            self._rebuild(state)
            self._lists, self._revisions = lists, revisions
            self._frame = None
        if self._daylight.update(state) is not self._light:
            self._relight(state)
        occluders = self._ripples.with_faces(self._occluders.collect(self._layers))
        gauges = self._gauges.collect()
        frame, time = self._frame, state.clock.time
        if frame is None or time != self._time or occluders is not frame.occluders:
            self._time = time
            self._frame = frame = self._at_time(state, occluders, gauges)
            return frame
        if gauges is not frame.gauges:
            self._frame = frame = replace(frame, gauges=gauges)
        clouds, shapes = self._cloud_rows(state, frame.strikes)
        if clouds is not frame.clouds or shapes is not frame.cloud_shapes:
            self._frame = frame = replace(frame, clouds=clouds, cloud_shapes=shapes)
        return frame

    def _cloud_rows(
        self, state: WeatherState, strikes: NDArray
    ) -> tuple[NDArray, tuple[CloudShapeData, ...]]:
        """The clouds that a picture shows, lit by the lightning in them."""
        if not state.drawn:
            return NO_CLOUDS, ()
        clouds, shapes = self._clouds.collect(state, self._parts[1], self._wind, self._profile)
        return self._strikes.lit(clouds, shapes, strikes), shapes

    def _at_time(
        self,
        state: WeatherState,
        occluders: tuple[OccluderData, ...],
        gauges: tuple[GaugeData, ...],
    ) -> FrameData:
        """The parts at the clock's time: moving areas are carried on by the remainder."""
        areas, clock = self._still, state.clock
        if self._winds:
            self._blow(state)
        if self._velocity is not None and clock.remainder > 0.0:
            areas = areas.copy()
            areas["center"] += self._velocity * clock.remainder
            areas.setflags(write=False)
        lights, sky, look = self._parts
        strikes = self._strikes.rows(state, self._brightness)
        clouds, shapes = self._cloud_rows(state, strikes)
        return FrameData(
            time=clock.time,
            step=clock.steps,
            areas=areas,
            lights=lights,
            wind=self._wind,
            sky=sky,
            look=look,
            occluders=occluders,
            splash=self._splash,
            flakes=self._flakes,
            cloud_look=self._cloud_look,
            ripples=self._ripples.surfaces,
            wetness=state.wet_ground.data(),
            snow_ground=state.snow_ground.data(),
            heightmap=self._heightmap,
            gauges=gauges,
            air=self._air,
            fog=self._fog,
            profile=self._profile,
            atmosphere=self._daylight.data,
            strikes=strikes,
            clouds=clouds,
            cloud_shapes=shapes,
            lightning=self._lightning,
            fronts=dry_spells(self._changing, state.fronts, clock.remainder),
            carried=frozenset(state.clouds.rain.values()),
        )

    def _blow(self, state: WeatherState) -> None:
        """The wind at the clock's time; what it carries moves as it will in the next step."""
        winds, seed = self._winds, state.seed
        self._wind, self._profile = winds_at(winds, seed, state.clock.time)
        if self._drifting:
            motion = winds_at(winds, seed, state.next_time)
            self._velocity = np.array([drift_velocity(area, *motion) for area in self._drifting])

    def _relight(self, state: WeatherState) -> None:
        """The atmosphere has another light, or there is one no more."""
        self._light = light = self._daylight.light
        state.light_direction = None if light is None else light.cloud_direction
        self._parts = (self._parts[0], light or sun_light(state), self._parts[2])
        self._fog = fog_data(state, self._parts[1])
        self._frame = None

    def _rebuild(self, state: WeatherState) -> None:
        winds = alive(Wind, state.uids)
        self._wind, self._profile = winds_at(winds, state.seed, state.clock.time)
        self._fronts_seen = (state.fronts.number, state.fronts.revision)
        found = alive(RainArea, state.uids)
        self._changing = [pair for pair in found if state.fronts.of(*pair) is not None]
        motion = winds_at(winds, state.seed, state.next_time)
        velocities = [drift_velocity(area, *motion) for _, area in found]
        self._still = area_rows(found, state.fronts) if found else _NO_AREAS
        self._velocity = np.array(velocities) if any(map(any, velocities)) else None
        self._winds = winds if varies(winds) else []
        self._drifting = [area for _, area in found] if any(a.drift for _, a in found) else []
        lamps = [
            (lamp.position, lamp.color, lamp.reach) for _, lamp in alive(PointLight, state.uids)
        ]
        lights = _frozen(lamps, LIGHT_DTYPE) if lamps else _NO_LIGHTS
        self._parts = (lights, self._light or sun_light(state), drop_look(state))
        self._air, self._fog = air_data(state), fog_data(state, self._parts[1])
        own = settings_of(state)
        self._lightning, self._brightness = look_of(own), own.brightness
        self._splash = splash_look(state)
        self._flakes = snow_look(state)
        self._cloud_look = cloud_look(state)
        self._ripples.collect(state)
        self._heightmap, self._layers = heightmap_look(state)
        self._entities = [
            pair[0]
            for kind in _KINDS
            for pair in esper.get_component(kind)
            if esper.entity_exists(pair[0])
        ]


def _frozen(rows: list[tuple[Any, ...]], dtype: np.dtype) -> NDArray:
    array = np.array(rows, dtype)
    array.setflags(write=False)
    return array
