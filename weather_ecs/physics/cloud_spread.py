"""What seeds know, spread over the cloud: a smooth field instead of a step from box to box."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

MOST_PAIRS = 4_000_000  # billboards times seeds; in larger clouds each keeps its own seed's value
WIDTH = 0.75  # of a seed's mean half side: how far its value reaches

Floats = NDArray[np.float32]


@dataclass(frozen=True, slots=True)
class Spread:
    """Weights of the seeds at each billboard (Shepard's, with Gaussians), and how they change."""

    centers: Floats  # (n, 3) m, of the seeds, weighted
    seed: NDArray[np.intp]  # (n,) the one that each billboard stands in
    weights: Floats | None  # (n, s), rows sum to 1; None: the cloud is too large for them
    slopes: Floats | None  # (3, n, s), 1/m, rows sum to 0

    @classmethod
    def over(cls, positions: NDArray, seed: NDArray, centers: NDArray, sizes: NDArray) -> Spread:
        """For billboards at positions (n, 3) in the seeds `seed` (n,), boxes (s, 3) each."""
        own = seed.astype(np.intp)
        if len(positions) * len(centers) > MOST_PAIRS or not len(positions):
            return cls(centers[own].astype(np.float32), own, None, None)
        width = np.maximum(WIDTH * 0.5 * sizes.mean(axis=1), 1e-3)
        # Axis by axis, (3, n, s): numpy is slow where the last axis is short.
        offset = positions.T[:, :, None] - centers.T[:, None, :]
        square = width**2
        power = (offset[0] ** 2 + offset[1] ** 2 + offset[2] ** 2) * (-0.5 / square)
        # A small share of its own seed, so that a billboard far from all of them has a value too.
        weights = np.exp(np.maximum(power, -60.0))
        weights[np.arange(len(own)), own] += 0.05
        weights /= weights.sum(axis=1, keepdims=True)
        mixed = (weights @ centers).astype(np.float32)
        offset *= -1.0 / square
        offset *= weights
        slopes = np.empty(offset.shape, np.float32)
        for pull, slope in zip(offset, slopes, strict=True):
            np.subtract(
                pull, weights * pull.sum(axis=1, keepdims=True), out=slope, casting="unsafe"
            )
        return cls(mixed, own, weights.astype(np.float32), slopes)

    def field(self, values: NDArray) -> Floats:
        """(n, 4): the values (s,) at the billboards, and the slopes along x, y and z per m."""
        found = np.zeros((len(self.seed), 4), np.float32)
        values = np.asarray(values, np.float32)
        if self.weights is None or self.slopes is None:
            found[:, 0] = values[self.seed]
            return found
        found[:, 0] = self.weights @ values
        found[:, 1:] = (self.slopes @ values).T
        return found
