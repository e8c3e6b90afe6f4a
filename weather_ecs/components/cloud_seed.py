"""`CloudSeed`: a box in which the billboards of a cloud are placed."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from weather_ecs.components._agreeing import Agreeing, parts, some_names
from weather_ecs.components._base import Check, number, vector
from weather_ecs.components.cloud_root import CloudRoot

SMALLEST = 1.0e-3  # m
LARGEST = 1.0e6  # m


@dataclass(eq=False, slots=True)
class CloudSeed(Agreeing):
    """A progenitor seed of a model (Torchelsen 2005, 3.1): an axis-aligned box, with its roots.

    Seeds that its roots add are like it. Its billboards are the model's, but for images of its own
    and factors on their size, shape and turn.
    """

    center: tuple[float, float, float] = (0.0, 0.0, 0.0)  # m, the model's axes, y up; within 1e6
    width: float = 100.0  # m, along x, 0.001 to 1e6
    height: float = 100.0  # m, along y
    depth: float = 100.0  # m, along z
    roots: tuple[CloudRoot, ...] = ()  # at most 256
    images: tuple[str, ...] = ()  # in place of the model's; none: the model's
    size_factor: float = 1.0  # 0.01 to 100, on the model's billboard sizes
    aspect_factor: float = 1.0  # 0.01 to 100, on the model's aspect
    turn_factor: float = 1.0  # 0 to 1, on the model's turn

    checks: ClassVar[dict[str, Check]] = {
        "center": vector(3, -LARGEST, LARGEST),
        "width": number(SMALLEST, LARGEST),
        "height": number(SMALLEST, LARGEST),
        "depth": number(SMALLEST, LARGEST),
        "roots": parts(CloudRoot, 256),
        "images": some_names(0, 64),
        "size_factor": number(0.01, 100.0),
        "aspect_factor": number(0.01, 100.0),
        "turn_factor": number(0.0, 1.0),
    }

    @property
    def size(self) -> tuple[float, float, float]:
        """(width, height, depth), m: whole sides along x, y and z."""
        return self.width, self.height, self.depth

    def descendants(self) -> int:
        """The most seeds that its roots can add."""
        return sum(root.descendants() for root in self.roots)
