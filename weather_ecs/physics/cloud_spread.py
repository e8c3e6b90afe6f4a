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
    pulls: Floats | None  # (n, s), weights over the squares of the seeds' widths, 1/m^2
    places: Floats  # (n, 3) m, of the billboards
    seeds: Floats  # (s, 3) m

    @classmethod
    def over(cls, positions: NDArray, seed: NDArray, centers: NDArray, sizes: NDArray) -> Spread:
        """For billboards at positions (n, 3) in the seeds `seed` (n,), boxes (s, 3) each."""
        own = seed.astype(np.intp)
        p, c = np.asarray(positions, np.float64), np.asarray(centers, np.float64)
        places, seeds = p.astype(np.float32), c.astype(np.float32)
        if len(positions) * len(centers) > MOST_PAIRS or not len(positions):
            return cls(seeds[own], own, None, None, places, seeds)
        square = np.maximum(WIDTH * 0.5 * np.asarray(sizes).mean(axis=1), 1e-3) ** 2
        # |p - c|^2 by one product of matrices; doubles, for what cancels out.
        away = p @ (-2.0 * c.T)
        away += (p * p).sum(axis=1)[:, None] + (c * c).sum(axis=1)
        away *= -0.5 / square
        # A small share of its own seed, so that a billboard far from all of them has a value too.
        weights = np.clip(away, -60.0, 0.0).astype(np.float32)
        np.exp(weights, out=weights)
        weights[np.arange(len(own)), own] += 0.05
        weights /= weights.sum(axis=1, keepdims=True)
        pulls = weights * (1.0 / square).astype(np.float32)
        return cls(weights @ seeds, own, weights, pulls, places, seeds)

    def field(self, values: NDArray) -> Floats:
        """(n, 4): the values (s,) at the billboards, and the slopes along x, y and z per m."""
        found = np.zeros((len(self.seed), 4), np.float32)
        values = np.asarray(values, np.float32)
        if self.weights is None or self.pulls is None:
            found[:, 0] = values[self.seed]
            return found
        found[:, 0] = self.weights @ values
        # The gradient of the weighted mean: what pulls towards a seed does so with its value less
        # that mean. Values are taken from their own mean first, so that little cancels out.
        middle = np.float32(values.mean())
        parts = np.empty((len(values), 8), np.float32)
        parts[:, 0], parts[:, 1:4] = 1.0, self.seeds
        parts[:, 4:] = parts[:, :4] * (values - middle)[:, None]
        sums = self.pulls @ parts
        pull = sums[:, 1:4] - self.places * sums[:, :1]
        drawn = sums[:, 5:] - self.places * sums[:, 4:5]
        found[:, 1:] = drawn - pull * (found[:, :1] - middle)
        return found
