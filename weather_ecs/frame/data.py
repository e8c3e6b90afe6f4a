"""`FrameData`: one frame's weather."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame.air import AirData, FogData, WindProfile
from weather_ecs.frame.clouds import CLOUD_DTYPE, CloudLook, CloudShapeData
from weather_ecs.frame.ground import GaugeData, HeightmapLook, OccluderData, RippleData, WetnessData
from weather_ecs.frame.precipitation import (
    AREA_DTYPE,
    NO_FRONTS,
    DropLook,
    SnowLook,
    Spells,
    SplashLook,
)
from weather_ecs.frame.sky import LIGHT_DTYPE, STRIKE_DTYPE, AtmosphereData, LightningLook, SkyLight


def empty(dtype: np.dtype) -> NDArray:
    array = np.zeros(0, dtype)
    array.setflags(write=False)
    return array


@dataclass(frozen=True, slots=True)
class FrameData:
    """One frame's weather, world axes, SI units unless a field says otherwise."""

    time: float = 0.0  # s, the weather's clock, remainder included
    step: int = 0  # fixed steps done
    areas: NDArray = field(default_factory=lambda: empty(AREA_DTYPE))
    lights: NDArray = field(default_factory=lambda: empty(LIGHT_DTYPE))
    wind: tuple[float, float, float] = (0.0, 0.0, 0.0)  # m/s
    sky: SkyLight = field(default_factory=SkyLight)
    look: DropLook = field(default_factory=DropLook)
    occluders: tuple[OccluderData, ...] = ()
    splash: SplashLook | None = None  # None: no splashes
    ripples: tuple[RippleData, ...] = ()
    wetness: WetnessData | None = None
    snow_ground: WetnessData | None = None  # the same of snow that lies, mm of water
    heightmap: HeightmapLook = field(default_factory=HeightmapLook)
    gauges: tuple[GaugeData, ...] = ()
    air: AirData = field(default_factory=AirData)
    fog: FogData = field(default_factory=FogData)
    profile: WindProfile = field(default_factory=WindProfile)
    clouds: NDArray = field(default_factory=lambda: empty(CLOUD_DTYPE))
    cloud_shapes: tuple[CloudShapeData, ...] = ()
    cloud_look: CloudLook = field(default_factory=CloudLook)
    # Areas whose rain has begun or ended of late, by key: spells without, s; see `physics.front`.
    fronts: Mapping[int, Spells] = field(default_factory=lambda: NO_FRONTS)
    carried: frozenset[int] = frozenset()  # keys of the areas that clouds carry
    flakes: SnowLook = field(default_factory=SnowLook)
    atmosphere: AtmosphereData | None = None  # None where there is none, or nobody draws
    strikes: NDArray = field(default_factory=lambda: empty(STRIKE_DTYPE))
    lightning: LightningLook = field(default_factory=LightningLook)
