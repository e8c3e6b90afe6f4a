"""`ViewData`: one frame's weather for one camera."""

from __future__ import annotations

from dataclasses import dataclass

from numpy.typing import NDArray

from weather_ecs.frame.data import FrameData
from weather_ecs.frame.precipitation import Spells


@dataclass(frozen=True, slots=True)
class ContainerData:
    """A placed container and the drops or flakes it holds; see `physics.container`, `shaders/`."""

    key: int  # stable for an area as one observer sees it; only ever compared
    axis: tuple[float, float, float, float]  # centre x, centre z, cos heading, sin heading
    shape: tuple[float, float, float, float]  # forward, lateral reach, bottom, height, m
    area_axis: tuple[float, float, float, float]
    area_shape: tuple[float, float, float, float]  # a, b, soft edge, ceiling, m
    # Of the diameters: slope, 1 - exp(-5.5 slope), 0, 0; of flakes as in `physics.snow.SnowLaw`.
    law: tuple[float, float, float, float]
    load: float  # real drops that one drop stands for, over d / weight_shape(d)
    count: float  # drops in use
    size_scale: float  # 1 near, more for far rain
    births: NDArray  # (n, 4) float32, n >= count: original position, own reach, size quantile
    dry: Spells = (0.0, 0.0, 0.0, 0.0)  # fall times of the drops that are missing
    kind: int = 0  # RAIN or SNOW
    rate: float = 0.0  # mm/h of water, of this kind where the area's is full
    cover: float = 1.0  # share of its disc that a drop or flake hides

    @property
    def area(self) -> int:
        """Key of the area."""
        return self.key >> 2

    @property
    def word(self) -> int:
        """What its chances are made of: each kind and half has its own."""
        return 2 * self.area + (self.key & 1) + 0x51F15E * self.kind


@dataclass(frozen=True, slots=True)
class VeilData:
    """The rain of one area beyond what its drops show."""

    axis: tuple[float, float, float, float]
    shape: tuple[float, float, float]  # a, b, the level of f inside which the rate is full
    span: tuple[float, float]  # bottom, top, m
    extinction: float  # 1/m
    shown: float  # m, the distance at which the drops' share of it has fallen to 0
    dry: Spells = (0.0, 0.0, 0.0, 0.0)  # fall times of the drops that are missing
    slope: float = 2.0  # 1/mm, of the diameters
    snow: float = 0.0  # share of the extinction that is snow's
    cloud: float = 0.0  # 0 to 1: how much of the light from above a cloud takes
    top: float = 0.0  # m below the ceiling within which it becomes full
    # Rays of rain within it, seen from afar: strength, place, and their drift a m of fall.
    ragged: float = 0.0
    phase: float = 0.0
    drift: tuple[float, float] = (0.0, 0.0)


@dataclass(frozen=True, slots=True)
class ViewData:
    """One frame's weather for one camera."""

    frame: FrameData
    key: int  # of the observer; only ever compared
    view: NDArray  # (4, 4) float64
    projection: NDArray  # (4, 4) float64
    position: tuple[float, float, float]
    velocity: tuple[float, float, float]  # m/s, of the observer
    dt: float  # s, weather time since this observer's last view
    containers: tuple[ContainerData, ...]
    veils: tuple[VeilData, ...]
    # m: how far the air at the reference height has gone along x and z; its turbulence over time.
    air_run: tuple[float, float, float] = (0.0, 0.0, 0.0)
