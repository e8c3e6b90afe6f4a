"""The ground: a height field on one irregular grid, so that what is walked on is what is drawn."""

from __future__ import annotations

from bisect import bisect_right
from typing import overload

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import layout
from .noise import Noise, smoothstep

FINE = 3.0  # m, cell side where one walks
GROWTH = 1.24  # of the cell side outside that


def _lines(low: float, high: float, reach: float) -> NDArray:
    """Grid lines: even between low and high, then wider and wider out to `reach`."""
    steps = [FINE]
    while sum(steps) < reach:
        steps.append(steps[-1] * GROWTH)
    outside = np.cumsum(steps)
    inside = np.linspace(low, high, round((high - low) / FINE) + 1)
    return np.concatenate([(low - outside)[::-1], inside, high + outside])


class Terrain:
    """Heights over (x, z), m; exactly the triangles that are drawn, out to about 550 m."""

    def __init__(self, seed: int = 0) -> None:
        self.noise = Noise(seed)
        self.path = layout.smooth_line(layout.PATH)
        self.spur = layout.smooth_line(layout.SPUR)
        self.track = layout.smooth_line(layout.WHEEL_TRACK)
        self._dense = [line[::4] for line in (self.path, self.spur, self.track)]
        self.pond_level = float(self._rolling(*np.array([layout.POND]).T)[0]) - 0.35
        self.cabin_level = float(self._rolling(*np.array([layout.CABIN]).T)[0])
        self.xs = _lines(-57.0, 57.0, 480.0)
        self.zs = _lines(-180.0, 102.0, 440.0)
        gx, gz = np.meshgrid(self.xs, self.zs)
        self.heights = self.surface(gx, gz)  # (nz, nx)
        self._x, self._z = self.xs.tolist(), self.zs.tolist()
        self._rows = self.heights.tolist()

    def _rolling(self, x: NDArray, z: NDArray) -> NDArray:
        """Meadow and hills before path, cabin and pond have shaped them."""
        noise = self.noise
        meadow = 2.3 * noise(x / 61.0, z / 61.0) + 0.8 * noise(x / 24.0 + 5.0, z / 24.0)
        meadow += 0.14 * noise(x / 7.0, z / 7.0 + 3.0)
        out = np.hypot(x, z + 40.0)
        rise = smoothstep(120.0, 330.0, out)
        near = 9.0 + 11.0 * noise(x / 130.0 + 2.0, z / 130.0)
        ridge = 1.0 - np.abs(noise.fbm(x / 760.0 + 3.7, z / 760.0 + 1.3, 5, 0.47)) * 1.6
        far = smoothstep(330.0, 2300.0, out)
        bulk = 0.55 + 0.45 * noise(x / 1500.0 + 8.0, z / 1500.0)
        return meadow + rise * near + far * (40.0 + 330.0 * ridge * bulk)

    def trail_distance(self, points: NDArray) -> NDArray:
        """(n,) distance of (n, 2) points from the nearest trail's middle, m."""
        return np.minimum.reduce([layout.distance_to_line(points, t) for t in self._dense])

    def pond_radius(self, x: ArrayLike, z: ArrayLike) -> NDArray:
        """0 in the middle of the pond, 1 at the shore, growing outside."""
        dx = np.asarray(x, "f8") - layout.POND[0]
        dz = np.asarray(z, "f8") - layout.POND[1]
        ring = np.arctan2(dz, dx)
        wobble = 1.0 + 0.10 * np.sin(2.0 * ring + 0.8) + 0.05 * np.sin(5.0 * ring + 2.0)
        return np.hypot(dx / layout.POND_RADII[0], dz / layout.POND_RADII[1]) / wobble

    def surface(self, x: ArrayLike, z: ArrayLike) -> NDArray:
        """The smooth ground the grid samples, m."""
        x, z = np.broadcast_arrays(np.asarray(x, "f8"), np.asarray(z, "f8"))
        height = self._rolling(x, z)
        flat = np.stack([x.ravel(), z.ravel()], 1)
        close = np.abs(flat[:, 0]) < 60.0
        close &= np.abs(flat[:, 1] + 40.0) < 145.0
        trail = np.full(len(flat), 99.0)
        trail[close] = self.trail_distance(flat[close])
        height = height - 0.12 * (1.0 - smoothstep(0.6, 2.6, trail.reshape(x.shape)))
        dx, dz = np.abs(x - layout.CABIN[0]), np.abs(z - layout.CABIN[1] - 1.6)
        pad = smoothstep(10.0, 6.0, np.maximum(dx, dz * 0.85))
        height = height + (self.cabin_level - height) * pad
        q = self.pond_radius(x, z)
        bowl = self.pond_level + 1.5 * (q * q - 1.0)
        bowl = np.maximum(bowl, self.pond_level - 1.3)
        return height + (bowl - height) * smoothstep(1.7, 1.08, q)

    @overload
    def height(self, x: float, z: float) -> float: ...

    @overload
    def height(self, x: NDArray, z: NDArray) -> NDArray: ...

    def height(self, x: float | NDArray, z: float | NDArray) -> float | NDArray:
        """Height of the drawn ground, m; a float for scalars, an array for arrays."""
        if not isinstance(x, np.ndarray) and not isinstance(z, np.ndarray):
            return self._height(x, z)
        x, z = np.broadcast_arrays(np.asarray(x, "f8"), np.asarray(z, "f8"))
        i = np.clip(np.searchsorted(self.xs, x, "right") - 1, 0, len(self.xs) - 2)
        j = np.clip(np.searchsorted(self.zs, z, "right") - 1, 0, len(self.zs) - 2)
        u = np.clip((x - self.xs[i]) / (self.xs[i + 1] - self.xs[i]), 0.0, 1.0)
        v = np.clip((z - self.zs[j]) / (self.zs[j + 1] - self.zs[j]), 0.0, 1.0)
        h = self.heights
        a, b, c, d = h[j, i], h[j, i + 1], h[j + 1, i], h[j + 1, i + 1]
        near = a + u * (b - a) + v * (c - a)
        return np.where(u + v <= 1.0, near, d + (1.0 - u) * (c - d) + (1.0 - v) * (b - d))

    def _height(self, x: float, z: float) -> float:
        i = min(max(bisect_right(self._x, x) - 1, 0), len(self._x) - 2)
        j = min(max(bisect_right(self._z, z) - 1, 0), len(self._z) - 2)
        u = min(max((x - self._x[i]) / (self._x[i + 1] - self._x[i]), 0.0), 1.0)
        v = min(max((z - self._z[j]) / (self._z[j + 1] - self._z[j]), 0.0), 1.0)
        near, far = self._rows[j], self._rows[j + 1]
        if u + v <= 1.0:
            return near[i] + u * (near[i + 1] - near[i]) + v * (far[i] - near[i])
        d = far[i + 1]
        return d + (1.0 - u) * (far[i] - d) + (1.0 - v) * (near[i + 1] - d)
