"""The collision heightmap in NumPy: the oracle of `shaders/shelter.glsl`, in float32."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

F = np.float32
EDGE = 0.6  # m, a step in depth between neighbours above which it is an edge and not a slope


@dataclass(frozen=True, slots=True)
class ShelterMap:
    """What rain meets first along its mean fall direction."""

    depth: NDArray[np.float32]  # (n, n), rows along v; in [0, 1], 0 at the top
    matrix: NDArray[np.float32]  # (4, 4), world to (u, v, depth)
    span: float  # m of height that depth 0 to 1 is
    texel: float  # m
    fall: tuple[float, float]  # horizontal m per m of fall, x and z

    def places(self, points: NDArray) -> NDArray[np.float32]:
        """(u, v, depth), (n, 3), of world points (n, 3)."""
        return (points.astype(F) @ self.matrix[:3, :3].T + self.matrix[:3, 3]).astype(F)

    def knows(self, m: NDArray) -> NDArray[np.bool_]:
        """Which places lie in the map."""
        return (m[:, :2] > 0.0).all(axis=1) & (m[:, :2] < 1.0).all(axis=1) & (m[:, 2] > -1e3)

    def below_texel(self, m: NDArray) -> NDArray[np.float32]:
        """Metres by which places lie below the surface of their texel, negative above it."""
        at = self._index((m[:, :2] * F(len(self.depth))).astype(np.int64))
        return ((m[:, 2] - self.depth[at[:, 1], at[:, 0]]) * F(self.span)).astype(F)

    def below_surface(self, m: NDArray) -> NDArray[np.float32]:
        """As `below_texel`, against the surface that slopes between the texels."""
        corners, part = self._corners(m[:, :2])
        edge = self._is_edge(corners)
        a, b, c, d = corners.T
        x, y = part.T
        depth = (a * (1 - x) + b * x) * (1 - y) + (c * (1 - x) + d * x) * y
        smooth = (m[:, 2] - depth) * F(self.span)
        return np.where(edge, self.below_texel(m), smooth).astype(F)

    def normals(self, m: NDArray) -> NDArray[np.float32]:
        """Upward normals of the surface, (n, 3); straight up at an edge."""
        corners, part = self._corners(m[:, :2])
        a, b, c, d = corners.T
        x, y = part.T
        rise = np.stack(
            [(a - b) * (1 - y) + (c - d) * y, (a - c) * (1 - x) + (b - d) * x], axis=1
        ) * F(self.span / self.texel)
        slope = rise / np.maximum(1.0 - rise @ np.asarray(self.fall, F), F(0.2))[:, None]
        normal = np.stack([-slope[:, 0], np.ones(len(m), F), -slope[:, 1]], axis=1)
        normal /= np.linalg.norm(normal, axis=1, keepdims=True)
        return np.where(self._is_edge(corners)[:, None], np.asarray([0, 1, 0], F), normal).astype(F)

    def meets(self, a: NDArray, b: NDArray) -> tuple[NDArray[np.float32], NDArray[np.bool_]]:
        """Where the ways from a to b meet the surface (n, 3), and which of them truly do.

        A way that crosses an edge far below the surface beside it has come in from the side.
        """
        low, high = np.zeros(len(a), F), np.ones(len(a), F)
        for _ in range(12):
            middle = F(0.5) * (low + high)
            under = self.below_surface(self.places(a + (b - a) * middle[:, None])) > 0.0
            high, low = np.where(under, middle, high), np.where(under, low, middle)
        hit = (a + (b - a) * high[:, None]).astype(F)
        return hit, self.below_surface(self.places(hit)) < 0.25

    def _index(self, at: NDArray) -> NDArray[np.int64]:
        return np.clip(at, 0, len(self.depth) - 1)

    def _corners(self, uv: NDArray) -> tuple[NDArray[np.float32], NDArray[np.float32]]:
        at = uv * F(len(self.depth)) - F(0.5)
        low = np.floor(at)
        a, b = self._index(low.astype(np.int64)), self._index(low.astype(np.int64) + 1)
        corners = np.stack(
            [
                self.depth[a[:, 1], a[:, 0]],
                self.depth[a[:, 1], b[:, 0]],
                self.depth[b[:, 1], a[:, 0]],
                self.depth[b[:, 1], b[:, 0]],
            ],
            axis=1,
        )
        return corners, (at - low).astype(F)

    def _is_edge(self, corners: NDArray) -> NDArray[np.bool_]:
        return np.ptp(corners, axis=1) * self.span > EDGE
