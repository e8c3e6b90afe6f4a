"""Components: what a game attaches to its entities to make weather."""

from __future__ import annotations

from weather_ecs.components._base import Component
from weather_ecs.components.air import Air
from weather_ecs.components.atmosphere import Atmosphere
from weather_ecs.components.climate import Climate
from weather_ecs.components.cloud import Cloud
from weather_ecs.components.cloud_model import CloudModel
from weather_ecs.components.cloud_root import CloudRoot
from weather_ecs.components.cloud_seed import CloudSeed
from weather_ecs.components.cloud_shading import CloudShading
from weather_ecs.components.collision_heightmap import CollisionHeightmap
from weather_ecs.components.fog import Fog
from weather_ecs.components.lightning import Lightning
from weather_ecs.components.observer import Observer
from weather_ecs.components.occluder import Occluder
from weather_ecs.components.point_light import PointLight
from weather_ecs.components.rain_area import RainArea
from weather_ecs.components.rain_container import RainContainer
from weather_ecs.components.rain_gauge import RainGauge
from weather_ecs.components.ripple_surface import RippleSurface
from weather_ecs.components.sky import Sky
from weather_ecs.components.sky_layer import SkyLayer
from weather_ecs.components.snow_flakes import SnowFlakes
from weather_ecs.components.splash_emitter import SplashEmitter
from weather_ecs.components.sun import Sun
from weather_ecs.components.wind import Wind

# What a snapshot holds. Observers are cameras, occluders the game's geometry and gauges its
# instruments: they belong to the game, and the weather does not depend on them.
SNAPSHOT_COMPONENTS: dict[str, type[Component]] = {
    kind.__name__: kind
    for kind in (
        Air,
        Atmosphere,
        Climate,
        Cloud,
        CloudModel,
        CloudShading,
        CollisionHeightmap,
        Fog,
        Lightning,
        PointLight,
        RainArea,
        RainContainer,
        RippleSurface,
        SkyLayer,
        SnowFlakes,
        SplashEmitter,
        Sun,
        Wind,
    )
}

__all__ = [
    "Air",
    "Atmosphere",
    "Climate",
    "Cloud",
    "CloudModel",
    "CloudRoot",
    "CloudSeed",
    "CloudShading",
    "CollisionHeightmap",
    "Fog",
    "Lightning",
    "Observer",
    "Occluder",
    "PointLight",
    "RainArea",
    "RainContainer",
    "RainGauge",
    "RippleSurface",
    "Sky",
    "SkyLayer",
    "SnowFlakes",
    "SplashEmitter",
    "Sun",
    "Wind",
]
