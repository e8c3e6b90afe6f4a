"""How things look: what the oldest component of a kind says, for a frame, or else the defaults."""

from __future__ import annotations

from dataclasses import fields

from weather_ecs.components import (
    CollisionHeightmap,
    RainContainer,
    SnowFlakes,
    SplashEmitter,
    Sun,
)
from weather_ecs.components.cloud_shading import CloudShading
from weather_ecs.components.collision_heightmap import ALL_LAYERS
from weather_ecs.frame import CloudLook, DropLook, HeightmapLook, SkyLight, SnowLook, SplashLook
from weather_ecs.systems.queries import alive
from weather_ecs.systems.state import WeatherState

_LOOK = tuple(item.name for item in fields(DropLook))
_CLOUDS = tuple(item.name for item in fields(CloudLook))
_FLAKES = tuple(item.name for item in fields(SnowLook))
_SPLASH = tuple(item.name for item in fields(SplashLook))


def sun_light(state: WeatherState) -> SkyLight:
    """Of a sun that the game sets; an atmosphere has its own light."""
    for _, sun in alive(Sun, state.uids):
        return SkyLight(
            sun.direction, sun.color, sun.zenith_color, sun.horizon_color, sun.ground_color
        )
    return SkyLight()


def drop_look(state: WeatherState) -> DropLook:
    """Of drops and their containers."""
    for _, container in alive(RainContainer, state.uids):
        return DropLook(*[getattr(container, name) for name in _LOOK])
    return DropLook()


def snow_look(state: WeatherState) -> SnowLook:
    """Of flakes."""
    for _, flakes in alive(SnowFlakes, state.uids):
        return SnowLook(*[getattr(flakes, name) for name in _FLAKES])
    return SnowLook()


def cloud_look(state: WeatherState) -> CloudLook:
    """Of clouds."""
    for _, shading in alive(CloudShading, state.uids):
        return CloudLook(*[getattr(shading, name) for name in _CLOUDS])
    return CloudLook()


def splash_look(state: WeatherState) -> SplashLook | None:
    """Of splashes, if there are any."""
    for _, emitter in alive(SplashEmitter, state.uids):
        return SplashLook(*[getattr(emitter, name) for name in _SPLASH])
    return None


def heightmap_look(state: WeatherState) -> tuple[HeightmapLook, int]:
    """Of the map of what the rain hits, and the layers that stop it."""
    for _, it in alive(CollisionHeightmap, state.uids):
        return HeightmapLook(it.resolution, it.extent), it.layers
    return HeightmapLook(), ALL_LAYERS
