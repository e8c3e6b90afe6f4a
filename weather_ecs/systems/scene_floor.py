"""`SceneFloor`: how low the scene lies in front of an observer, so that rain reaches down to it."""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import OccluderData
from weather_ecs.physics.heightfield import pieces

# Places that are looked at: share of the reach, and angle from the heading.
_PLACES = ((0.15, 0.0), (0.4, -0.5), (0.4, 0.5), (0.65, 0.0), (0.8, -0.5), (0.8, 0.5))
_FAR, _TURN = np.array(_PLACES).T


class SceneFloor:
    """The occluders that stand still, as boxes; those whose mesh is large as several."""

    def __init__(self) -> None:
        self._still: list[OccluderData] = []
        self._pieces: dict[tuple[int, int], tuple[NDArray, NDArray, NDArray]] = {}
        self._boxes: NDArray[np.float64] = np.zeros((0, 5))  # x, x, z, z, top

    def lowest(
        self,
        occluders: tuple[OccluderData, ...],
        position: tuple[float, float, float],
        heading: float,
        reach: float,
    ) -> float | None:
        """World height of the lowest surface at a few places ahead; None where nothing is known."""
        still = [o for o in occluders if not o.dynamic and o.vertices is not None]
        if still != self._still:  # by identity: what has changed is another object
            self._still, self._boxes = still, self._boxed(still)
        if not len(self._boxes):
            return None
        x = position[0] + reach * _FAR * np.cos(heading + _TURN)
        z = position[2] - reach * _FAR * np.sin(heading + _TURN)
        x0, x1, z0, z1, top = self._boxes.T[:, :, None]
        within = (x0 <= x) & (x <= x1) & (z0 <= z) & (z <= z1)
        tops = np.where(within, top, -math.inf).max(axis=0)
        known = tops[tops > -math.inf]
        return float(known.min()) if len(known) else None

    def _boxed(self, occluders: list[OccluderData]) -> NDArray[np.float64]:
        used = {}
        found = []
        for occluder in occluders:
            vertices, indices = occluder.vertices, occluder.indices
            assert vertices is not None and indices is not None
            key = (id(vertices), id(indices))
            known = self._pieces.get(key)
            if known is None:
                parts = pieces(vertices, indices)
                boxes = np.array([(*p.middle, *p.half) for p in parts]).reshape(-1, 6)
                # The arrays are kept too, so that no identity is used twice.
                known = (vertices, indices, boxes)
            used[key] = known
            turn = occluder.transform[:3, :3]
            middle = known[2][:, :3] @ turn.T + occluder.transform[:3, 3]
            half = known[2][:, 3:] @ np.abs(turn).T
            low, high = middle - half, middle + half
            found.append(
                np.stack([low[:, 0], high[:, 0], low[:, 2], high[:, 2], high[:, 1]], axis=1)
            )
        self._pieces = used
        return np.concatenate(found) if found else np.zeros((0, 5))
