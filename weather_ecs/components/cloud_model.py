"""`CloudModel`: what an artist makes, from which any number of different clouds are generated."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from weather_ecs.components._agreeing import Agreeing, a_name, parts, some_names
from weather_ecs.components._base import Check, integer, number, vector
from weather_ecs.components.cloud_root import MOST_DESCENDANTS
from weather_ecs.components.cloud_seed import CloudSeed
from weather_ecs.errors import InvalidValueError

MOST_BILLBOARDS = 10_000_000  # of one cloud


@dataclass(eq=False, slots=True)
class CloudModel(Agreeing):
    """A kind of cloud (Torchelsen 2005, 3.1): progenitor seeds, their billboards, and its looks.

    On an entity of its own it makes its name known to the `Cloud` and `Sky` components of the
    world; without one, a name means the package's own model of that name. Billboards are between
    `billboards_min` and `billboards_max` in each seed, each `size_min` to `size_max` wide.
    """

    name: str = "cloud"
    seeds: tuple[CloudSeed, ...] = ()  # 1 to 4096: a model has to have one
    billboards_min: int = 3  # 0 to 10000, in each seed
    billboards_max: int = 5  # 1 to 10000, not below the minimum
    size_min: float = 60.0  # m, of a billboard, 0.001 to 1e6
    size_max: float = 120.0  # m, not below the minimum
    images: tuple[str, ...] = ("puff",)  # of the package's cloud images, or whole families
    light_penetration: float = 400.0  # m that light goes inside before all is absorbed; or inf
    roundness: float = 0.5  # 0: billboards anywhere in a seed's box; 1: in the ellipsoid inside it
    flatness: float = 0.0  # 0 to 1: how much of what would hang below the base is lifted on it
    aspect: float = 1.0  # 0.05 to 20, height of a billboard over its width
    turn: float = 180.0  # degrees, 0 to 180: billboards are turned by up to this either way
    opacity: float = 1.0  # 0 to 1, of a billboard
    darkness: float = 0.0  # 0 fair weather to 1 storm: of the base
    base: tuple[float, float] = (600.0, 2000.0)  # m, lowest and highest where its bases are found
    rain_rate: float = 0.0  # mm/h that falls under a whole cloud of this kind, 0 to 10000
    lightning: float = 0.0  # flashes a minute in a whole cloud of this kind, 0 to 600
    halo: float = 0.0  # 0 to 1, strength of the ring of 22 degrees that its ice makes

    checks: ClassVar[dict[str, Check]] = {
        "name": a_name(),
        "seeds": parts(CloudSeed, 4096),
        "billboards_min": integer(0, 10_000),
        "billboards_max": integer(1, 10_000),
        "size_min": number(1.0e-3, 1.0e6),
        "size_max": number(1.0e-3, 1.0e6),
        "images": some_names(1, 64),
        "light_penetration": number(0.0, float("inf"), above=True),
        "roundness": number(0.0, 1.0),
        "flatness": number(0.0, 1.0),
        "aspect": number(0.05, 20.0),
        "turn": number(0.0, 180.0),
        "opacity": number(0.0, 1.0),
        "darkness": number(0.0, 1.0),
        "base": vector(2, -1.0e3, 1.0e5),
        "rain_rate": number(0.0, 1.0e4),
        "lightning": number(0.0, 600.0),
        "halo": number(0.0, 1.0),
    }

    def seed_count(self) -> int:
        """The most seeds that a cloud of this model can have."""
        return len(self.seeds) + sum(seed.descendants() for seed in self.seeds)

    def span(self) -> tuple[float, float]:
        """Width and depth, m, that every cloud of this model has at least: of its own seeds."""
        x = [(s.center[0], 0.5 * s.width) for s in self.seeds]
        z = [(s.center[2], 0.5 * s.depth) for s in self.seeds]
        wide, deep = (
            max(at + half for at, half in side) - min(at - half for at, half in side)
            for side in (x, z)
        )
        return wide, deep

    def agree(self) -> None:
        if not self.seeds:
            raise InvalidValueError("CloudModel.seeds", self.seeds, "at least one seed")
        for low, high in (("billboards_min", "billboards_max"), ("size_min", "size_max")):
            least, most = getattr(self, low), getattr(self, high)
            if least > most:
                raise InvalidValueError(f"CloudModel.{low}", least, f"at most {high}, {most:g}")
        if self.base[0] > self.base[1]:
            raise InvalidValueError("CloudModel.base", self.base, "(lowest, highest)")
        count = self.seed_count()
        if count > MOST_DESCENDANTS:
            raise InvalidValueError(
                "CloudModel.seeds", f"{count} seeds", f"at most {MOST_DESCENDANTS} in a cloud"
            )
        if count * self.billboards_max > MOST_BILLBOARDS:
            raise InvalidValueError(
                "CloudModel.billboards_max",
                f"{count * self.billboards_max} billboards",
                f"at most {MOST_BILLBOARDS} in a cloud",
            )
