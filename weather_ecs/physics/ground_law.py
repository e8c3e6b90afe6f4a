"""What the coarse ground needs to know of what lies on it: water that dries, snow that melts."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from weather_ecs.physics import wetness
from weather_ecs.physics.snow_cover import collect

Array = NDArray[np.float64]
MELT_CHANGE = 0.05  # share of the melt, and
MELT_TRACE = 2e-4  # mm/s: less is the same melt


class GroundLaw(Protocol):
    """Law of a layer in mm of water on level ground; `inflow` in mm/s."""

    @property
    def most(self) -> float:
        """mm, more is not kept apart."""

    @property
    def planes(self) -> int:
        """Bytes in which it is kept: as the square root of its share of `most`."""

    @property
    def melt(self) -> float:
        """mm/s that melt."""

    @property
    def rests(self) -> bool:
        """Whether a film on which nothing falls dries by `physics.wetness.DRYING` alone."""

    def settle(self, layer: Array, inflow: Array, seconds: float) -> Array:
        """The layer after some seconds."""

    def settle_one(self, layer: float, inflow: float, seconds: float) -> float:
        """The same for one place, in plain numbers."""

    def rest(self, layer: Array, seconds: float) -> tuple[Array, NDArray[np.bool_]]:
        """The layer after some seconds without inflow; tiles (first axis) that need `settle`."""

    def kept(self, ages: Array) -> Array:
        """Share that is left of what has fallen so many seconds ago, while there is little."""

    def kept_mean(self, seconds: float) -> float:
        """Mean of the same over all ages from 0."""

    def merge(self, one: Array, other: Array) -> Array:
        """Two fields that speak of different areas over the same place."""

    def merge_one(self, one: float, other: float) -> float:
        """The same for one place."""

    def alike(self, other: GroundLaw) -> bool:
        """Whether the ground can hardly tell the two."""


@dataclass(frozen=True, slots=True)
class WaterLaw:
    """`physics.wetness` on level ground."""

    most: float = 16.0
    planes: int = 2
    melt: float = 0.0
    rests: bool = True

    def settle(self, layer: Array, inflow: Array, seconds: float) -> Array:
        return wetness.settle(layer, inflow, wetness.FILM, seconds)

    def settle_one(self, layer: float, inflow: float, seconds: float) -> float:
        return wetness.settle_one(layer, inflow, wetness.FILM, seconds)

    def rest(self, layer: Array, seconds: float) -> tuple[Array, NDArray[np.bool_]]:
        dried = layer * math.exp(-seconds / wetness.DRYING)
        return dried, np.any(layer > wetness.FILM, axis=(1, 2))

    def kept(self, ages: Array) -> Array:
        return np.exp(-ages / wetness.DRYING)

    def kept_mean(self, seconds: float) -> float:
        return -math.expm1(-seconds / wetness.DRYING) * wetness.DRYING / seconds

    def merge(self, one: Array, other: Array) -> Array:
        return wetness.merge(one, other)

    def merge_one(self, one: float, other: float) -> float:
        return wetness.merge_one(one, other)

    def alike(self, other: GroundLaw) -> bool:
        return True


@dataclass(frozen=True, slots=True)
class SnowLaw:
    """`physics.snow_cover` on level ground."""

    melt: float = 0.0
    most: float = 400.0  # 4 m deep
    planes: int = 3  # it lies for long: light snow on deep snow must still count
    rests: bool = False

    def settle(self, layer: Array, inflow: Array, seconds: float) -> Array:
        return collect(layer, inflow, self.melt, seconds)

    def settle_one(self, layer: float, inflow: float, seconds: float) -> float:
        return max(layer + (inflow - self.melt) * seconds, 0.0)

    def rest(self, layer: Array, seconds: float) -> tuple[Array, NDArray[np.bool_]]:
        left = np.maximum(layer - self.melt * seconds, 0.0)
        return left, np.zeros(len(layer), bool)

    def kept(self, ages: Array) -> Array:
        return np.ones_like(ages)

    def kept_mean(self, seconds: float) -> float:
        return 1.0

    def merge(self, one: Array, other: Array) -> Array:
        return one + other

    def merge_one(self, one: float, other: float) -> float:
        return one + other

    def alike(self, other: GroundLaw) -> bool:
        change = abs(self.melt - other.melt)
        return change <= max(MELT_TRACE, MELT_CHANGE * max(self.melt, other.melt))


WATER = WaterLaw()
