"""`CloudSeed`: a box in which the billboards of a cloud are placed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from weather_ecs.components._agreeing import Agreeing, parts
from weather_ecs.components._base import Check, number, vector
from weather_ecs.components.cloud_root import CloudRoot

SMALLEST = 1.0e-3  # m
LARGEST = 1.0e6  # m


@dataclass(eq=False, slots=True)
class CloudSeed(Agreeing):
    """A progenitor seed of a model (Torchelsen 2005, 3.1): an axis-aligned box, with its roots.

    Seeds that its roots add have its size.
    """

    center: tuple[float, float, float] = (0.0, 0.0, 0.0)  # m, the model's axes, y up; within 1e6
    width: float = 100.0  # m, along x, 0.001 to 1e6
    height: float = 100.0  # m, along y
    depth: float = 100.0  # m, along z
    roots: tuple[CloudRoot, ...] = ()  # at most 256

    checks: ClassVar[dict[str, Check]] = {
        "center": vector(3, -LARGEST, LARGEST),
        "width": number(SMALLEST, LARGEST),
        "height": number(SMALLEST, LARGEST),
        "depth": number(SMALLEST, LARGEST),
        "roots": parts(CloudRoot, 256),
    }

    @property
    def size(self) -> tuple[float, float, float]:
        """(width, height, depth), m: whole sides along x, y and z."""
        return self.width, self.height, self.depth

    def descendants(self) -> int:
        """The most seeds that its roots can add."""
        return sum(root.descendants() for root in self.roots)
