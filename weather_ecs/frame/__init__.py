"""`FrameData`: the only value that crosses from the ECS to the GPU.

Plain arrays, made once a frame by the extract system, read-only, with no entity ids and no
OpenGL names in it. `ViewData` is what one camera sees of it.
"""

from __future__ import annotations

from weather_ecs.frame.air import (
    AirData,
    FogData,
    WindProfile,
)
from weather_ecs.frame.clouds import (
    BILLBOARD_DTYPE,
    CLOUD_DTYPE,
    CloudLook,
    CloudShapeData,
)
from weather_ecs.frame.data import (
    FrameData,
    empty,
)
from weather_ecs.frame.ground import (
    GaugeData,
    GaugeReading,
    HeightmapLook,
    OccluderData,
    RippleData,
    WetnessData,
    WetTileData,
)
from weather_ecs.frame.precipitation import (
    AREA_DTYPE,
    NO_FRONTS,
    RAIN,
    SNOW,
    AreaRow,
    DropLook,
    SnowLook,
    Spells,
    SplashLook,
    plain_areas,
)
from weather_ecs.frame.sky import (
    LIGHT_DTYPE,
    STRIKE_DTYPE,
    AtmosphereData,
    LightningLook,
    SkyLight,
)
from weather_ecs.frame.view import (
    ContainerData,
    VeilData,
    ViewData,
)

__all__ = [
    "AREA_DTYPE",
    "BILLBOARD_DTYPE",
    "CLOUD_DTYPE",
    "LIGHT_DTYPE",
    "NO_FRONTS",
    "RAIN",
    "SNOW",
    "STRIKE_DTYPE",
    "AirData",
    "AreaRow",
    "AtmosphereData",
    "CloudLook",
    "CloudShapeData",
    "ContainerData",
    "DropLook",
    "FogData",
    "FrameData",
    "GaugeData",
    "GaugeReading",
    "HeightmapLook",
    "LightningLook",
    "OccluderData",
    "RippleData",
    "SkyLight",
    "SnowLook",
    "Spells",
    "SplashLook",
    "VeilData",
    "ViewData",
    "WetTileData",
    "WetnessData",
    "WindProfile",
    "empty",
    "plain_areas",
]
