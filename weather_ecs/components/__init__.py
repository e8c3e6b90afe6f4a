"""Components: what a game attaches to its entities to make weather."""

from __future__ import annotations

from weather_ecs.components._base import Component
from weather_ecs.components.observer import Observer
from weather_ecs.components.occluder import Occluder
from weather_ecs.components.point_light import PointLight
from weather_ecs.components.rain_area import RainArea
from weather_ecs.components.rain_container import RainContainer
from weather_ecs.components.ripple_surface import RippleSurface
from weather_ecs.components.splash_emitter import SplashEmitter
from weather_ecs.components.sun import Sun
from weather_ecs.components.wind import Wind

# What a snapshot holds. Observers are cameras and occluders are the game's geometry: both belong
# to the game, and a server has neither.
SNAPSHOT_COMPONENTS: dict[str, type[Component]] = {
    kind.__name__: kind
    for kind in (PointLight, RainArea, RainContainer, RippleSurface, SplashEmitter, Sun, Wind)
}

__all__ = [
    "Observer",
    "Occluder",
    "PointLight",
    "RainArea",
    "RainContainer",
    "RippleSurface",
    "SplashEmitter",
    "Sun",
    "Wind",
]
