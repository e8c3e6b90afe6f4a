"""What the sky pass draws under the horizon: ground, or from above a deck the light of its tops."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import CloudShapeData, ViewData
from weather_ecs.gpu.cloud_scene import surround_of
from weather_ecs.physics.cloud_billboard import smoothstep
from weather_ecs.physics.sky_floor import (
    AROUND,
    RISES,
    depth_below,
    share_covered,
    top_light,
    unbent,
)

HIGH = 300.0  # m over the ground, below which nobody looks down on clouds


class Floor(NamedTuple):
    """Besides the ground."""

    color: NDArray[np.float64]  # (3,), as the drawn sky has it
    share: float  # 0 to 1, of it
    depth: float  # optical, of the air straight down


class SkyFloor:
    """Keeps how wide and high the shapes of clouds are."""

    def __init__(self) -> None:
        self._shapes: tuple[CloudShapeData, ...] = ()
        self._half = np.zeros((0, 3))

    def of(self, view: ViewData) -> Floor:
        """What is below the camera of a view."""
        height = view.position[1] - view.frame.profile.ground
        ground = Floor(np.zeros(3), 0.0, depth_below(height))
        clouds = view.frame.clouds
        if height < HIGH or not len(clouds) or view.frame.cloud_look.plain:
            return ground
        half = self._sizes(view.frame.cloud_shapes)[clouds["shape"]] * clouds["scale"][:, None]
        way = clouds["position"] - np.array(view.position)
        there = clouds["growth"] * clouds["opacity"] * (np.hypot(way[:, 0], way[:, 2]) < AROUND)
        areas = 4.0 * half[:, 0] * half[:, 2] * there
        below = way[:, 1] < 0.0
        whole = float(areas[below].sum())
        if whole <= 0.0:
            return ground
        tops = (way[:, 1] + half[:, 1])[below]
        over = -float(np.average(tops, weights=areas[below]))
        # Nor at once where the tops are lower than HIGH.
        share = share_covered(areas[below])
        share *= float(smoothstep(0.0, RISES, min(over, height - HIGH)))
        dark = float(np.average(clouds["darkness"][below], weights=areas[below]))
        deep = depth_below(height, height - over)
        depth = ground.depth + share * (deep - ground.depth)
        return Floor(unbent(top_light(surround_of(view), dark, height - over)), share, depth)

    def _sizes(self, shapes: tuple[CloudShapeData, ...]) -> NDArray[np.float64]:
        """(n, 3) half sizes of the boxes round their seeds, m."""
        if shapes is not self._shapes:
            ends = [(s.centers - 0.5 * s.sizes, s.centers + 0.5 * s.sizes) for s in shapes]
            self._half = np.array([0.5 * (b.max(0) - a.min(0)) for a, b in ends]).reshape(-1, 3)
            self._shapes = shapes
        return self._half
