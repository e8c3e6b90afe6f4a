"""View rays through the ellipse of a rain area: where they cross it, and how much rain is there."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .checks import FloatArray


class Crossing:
    """Rays (..., 3) across an ellipse: along them f(t) = lowest + a (t - middle)^2, 1 on its rim.

    axis: centre x, centre z, cos heading, sin heading. shape: a, b, and the level of f inside which
    the rain is at its full rate; outside it falls to 0 at the rim, linearly in f.
    """

    def __init__(
        self,
        position: tuple[float, float, float],
        ray: NDArray,
        axis: tuple[float, ...],
        shape: tuple[float, float, float],
    ) -> None:
        self._axis, self._shape = axis, shape
        u, w = self.own(position[0] - axis[0], position[2] - axis[1])
        self.du, self.dw = self.own(ray[..., 0], ray[..., 2])
        self.a = np.maximum(self.du * self.du + self.dw * self.dw, 1e-12)
        self.middle = -(u * self.du + w * self.dw) / self.a
        # From the cross product: as a difference it would drown where a thin area is far off.
        self.aside = u * self.dw - w * self.du
        self.lowest = self.aside * self.aside / self.a
        self.half_chord = np.sqrt(np.maximum(1.0 - self.lowest, 0.0) / self.a)

    def own(self, x: ArrayLike, z: ArrayLike) -> tuple[FloatArray, FloatArray]:
        """A level vector along the ellipse's axes, in its half axes."""
        x, z = np.asarray(x, np.float64), np.asarray(z, np.float64)
        c, s = self._axis[2], self._axis[3]
        return (x * c - z * s) / self._shape[0], (x * s + z * c) / self._shape[1]

    def within(self, t0: NDArray, t1: NDArray) -> tuple[FloatArray, FloatArray]:
        """Depths between which [t0, t1] lies in the ellipse; of no length where it does not."""
        near = np.maximum(t0, self.middle - self.half_chord)
        return near, np.maximum(np.minimum(t1, self.middle + self.half_chord), near)

    def over_level(self, level: float, t0: NDArray, t1: NDArray) -> FloatArray:
        """Integral over [t0, t1] of max(level - f(t), 0)."""
        h = level - self.lowest
        half_chord = np.sqrt(np.maximum(h, 0.0) / self.a)
        x0 = np.clip(t0 - self.middle, -half_chord, half_chord)
        x1 = np.clip(t1 - self.middle, -half_chord, half_chord)
        area = (x1 - x0) * (h - self.a * (x0 * x0 + x0 * x1 + x1 * x1) / 3.0)
        return np.where(h > 0.0, area, 0.0)

    def full_path(self, t0: NDArray, t1: NDArray) -> FloatArray:
        """Integral over [t0, t1] of the share of the rain rate."""
        inner = self._shape[2]
        return (self.over_level(1.0, t0, t1) - self.over_level(inner, t0, t1)) / (1.0 - inner)
