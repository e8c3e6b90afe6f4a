"""What an upright cylinder (a walker) hits: boxes turned about the vertical, and round posts."""

from __future__ import annotations

import math
from collections.abc import Iterable
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

ROUNDS = 6  # corrections in one step; a corner takes two or three


@dataclass(frozen=True)
class Box:
    """A block, turned about the vertical; heading in rad, counter-clockwise seen from above."""

    center: tuple[float, float]  # (x, z), m
    half: tuple[float, float]  # m, along its own x and z axes
    bottom: float  # m, world height
    top: float
    heading: float = 0.0


@dataclass(frozen=True)
class Post:
    """An upright cylinder: a trunk, a lamp post, a rock's core."""

    center: tuple[float, float]  # (x, z), m
    radius: float  # m
    bottom: float
    top: float


@dataclass
class Colliders:
    """Boxes and posts as arrays; a post is a box of no extent with a radius."""

    center: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 2)))
    half: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 2)))
    radius: NDArray[np.float64] = field(default_factory=lambda: np.zeros(0))
    span: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 2)))
    turn: NDArray[np.float64] = field(default_factory=lambda: np.zeros((0, 2)))  # cos, sin

    @classmethod
    def of(cls, shapes: Iterable[Box | Post]) -> Colliders:
        rows = []
        for shape in shapes:
            half = shape.half if isinstance(shape, Box) else (0.0, 0.0)
            radius = shape.radius if isinstance(shape, Post) else 0.0
            heading = shape.heading if isinstance(shape, Box) else 0.0
            turn = (math.cos(heading), math.sin(heading))
            rows.append((*shape.center, *half, radius, shape.bottom, shape.top, *turn))
        table = np.array(rows, np.float64).reshape(-1, 9)
        return cls(table[:, 0:2], table[:, 2:4], table[:, 4], table[:, 5:7], table[:, 7:9])

    def near(self, x: float, z: float, reach: float) -> Colliders:
        """Those that come within `reach` of (x, z), to spare the rest of a step the others."""
        offset = self.center - (x, z)
        extent = np.hypot(self.half[:, 0], self.half[:, 1]) + self.radius + reach
        keep = np.einsum("ij,ij->i", offset, offset) < extent**2
        return Colliders(
            self.center[keep], self.half[keep], self.radius[keep], self.span[keep], self.turn[keep]
        )

    def _local(self, x: float, z: float) -> NDArray[np.float64]:
        """(x, z) in every shape's own axes, shape (n, 2)."""
        dx, dz = x - self.center[:, 0], z - self.center[:, 1]
        c, s = self.turn[:, 0], self.turn[:, 1]
        return np.stack((dx * c - dz * s, dx * s + dz * c), axis=1)

    def push_out(
        self, x: float, z: float, radius: float, low: float, high: float
    ) -> tuple[float, float]:
        """(x, z) moved the least way out of every shape that reaches into heights low..high."""
        if len(self.radius) == 0:
            return x, z
        blocks = (self.span[:, 1] > low) & (self.span[:, 0] < high)
        if not blocks.any():
            return x, z
        for _ in range(ROUNDS):
            local = self._local(x, z)
            outside = np.abs(local) - self.half
            nearest = np.clip(local, -self.half, self.half)
            gap = local - nearest
            length = np.hypot(gap[:, 0], gap[:, 1])
            # Inside a box the depth counts from its nearest face.
            depth = radius + self.radius - np.where(length > 0.0, length, outside.max(axis=1))
            depth[~blocks] = 0.0
            worst = int(depth.argmax())
            if depth[worst] <= 1e-9:
                break
            if length[worst] > 0.0:
                u, w = gap[worst] / length[worst]
            else:
                axis = int(outside[worst].argmax())
                sign = math.copysign(1.0, local[worst, axis])
                u, w = (sign, 0.0) if axis == 0 else (0.0, sign)
            c, s = self.turn[worst]
            x += depth[worst] * (u * c + w * s)
            z += depth[worst] * (-u * s + w * c)
        return float(x), float(z)

    def is_free(self, x: float, z: float, radius: float, low: float, high: float) -> bool:
        """Whether a cylinder at (x, z) between two heights touches nothing."""
        away = self.push_out(x, z, radius, low, high)
        return math.hypot(away[0] - x, away[1] - z) < 1e-6

    def _over(self, x: float, z: float, margin: float) -> NDArray[np.bool_]:
        """The shapes whose outline, `margin` wider, holds (x, z)."""
        local = self._local(x, z)
        gap = local - np.clip(local, -self.half, self.half)
        return np.hypot(gap[:, 0], gap[:, 1]) <= self.radius + margin

    def top_below(self, x: float, z: float, margin: float, limit: float) -> float:
        """The highest top at (x, z) that is no higher than `limit`; -inf where there is none."""
        found = self._over(x, z, margin) & (self.span[:, 1] <= limit)
        return float(self.span[found, 1].max()) if found.any() else -math.inf

    def bottom_above(self, x: float, z: float, margin: float, limit: float) -> float:
        """The lowest underside at (x, z) that is no lower than `limit`; inf where there is none."""
        found = self._over(x, z, margin) & (self.span[:, 0] >= limit)
        return float(self.span[found, 0].min()) if found.any() else math.inf
