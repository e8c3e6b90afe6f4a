"""Rain: a bed of drops too many to tell apart, and single ones near the ear."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from . import laws
from .impacts import BOARD, GROUND, LEAF, Tail, bank
from .overlap import FREQUENCIES, HOP, RATE, amplitudes

NEAR_AREA = 2.0  # m2 about the listener where one hears drops one by one
NEAR_SIZE = 2.0  # mm, smallest of them
MOST_NEAR = 160.0  # drops a second; more run together
NEAR_SHARE = 0.3  # of the sound's power
NEAREST = 0.35  # of the way out to the farthest of them
LARGEST = 3.0  # times the mean, so that none stands out


def near_rate(rate: float) -> float:
    """Drops a second that one hears singly: N(D) v over the larger ones, Marshall and Palmer."""
    if rate <= 0.0:
        return 0.0
    slope = laws.drop_slope(rate)
    speed = float(laws.fall_speed(NEAR_SIZE + 1.0 / slope))
    flux = 8000.0 * speed * np.exp(-slope * NEAR_SIZE) / slope
    return float(min(NEAR_AREA * flux, MOST_NEAR))


class Rain:
    """Rain at a listener; `outside` is to be filtered by what is overhead, `inside` is not."""

    def __init__(self, seed: int) -> None:
        self._random = np.random.default_rng(seed)
        self._banks = [bank(surface, 7 + k) for k, surface in enumerate((GROUND, LEAF, BOARD))]
        longest = max(sound.size for sounds in self._banks for sound in sounds)
        self._outside, self._inside = Tail(longest), Tail(longest)
        draws = np.random.default_rng(1)
        self._usual = np.sqrt(np.mean(self._weights(draws, 100_000, 0.4) ** 2))

    def near(self, rate: float, leaves: float, roof: float) -> tuple[NDArray, NDArray]:
        """(2, HOP) of single drops outside and on the roof, for a block at a rate in mm/h."""
        often = near_rate(rate)
        count = int(self._random.poisson(often * HOP / RATE))
        if count:
            level = laws.rain_level(rate) * np.sqrt(NEAR_SHARE * RATE / often) / self._usual
            weights = level * self._weights(self._random, count, 1.0 / laws.drop_slope(rate))
            places = self._random.integers(0, HOP, count)
            ears = self._random.uniform(0.25, 0.75, count) * (np.pi / 2.0)
            for weight, at, ear in zip(weights.tolist(), places.tolist(), ears, strict=True):
                self._drop(weight, at, np.sqrt(2.0) * np.array((np.cos(ear), np.sin(ear))),
                           leaves, roof)  # fmt: skip
        return self._outside.take(), self._inside.take()

    def bed(self, rate: float, leaves: float, roof: float, gain: NDArray) -> NDArray:
        """Power over frequency of all that is heard of the far drops, under a roof's gain."""
        level = laws.rain_level(rate) * np.sqrt(1.0 - NEAR_SHARE)
        louder = 1.0 + (laws.LEAF_GAIN - 1.0) * leaves
        shape = laws.rain_shape(FREQUENCIES, laws.rain_peak(rate))
        power = (amplitudes(shape, level) * gain) ** 2 * louder
        if roof > 0.0:
            drum = level * np.sqrt(laws.DRUM_SHARE * roof)
            power = power + amplitudes(laws.drum_shape(FREQUENCIES), drum) ** 2
        return power

    def _drop(self, weight: float, at: int, ears: NDArray, leaves: float, roof: float) -> None:
        ground, leaf, board = self._banks
        which = int(self._random.integers(len(ground)))
        left, right = (weight * ears).tolist()
        if self._random.random() < roof:
            drum = np.sqrt(laws.DRUM_SHARE)
            self._inside.add(board[which], at, drum * left, drum * right)
        elif self._random.random() < leaves:
            patter = np.sqrt(laws.LEAF_GAIN)
            self._outside.add(leaf[which], at, patter * left, patter * right)
        else:
            self._outside.add(ground[which], at, left, right)

    def _weights(self, random: np.random.Generator, count: int, spread: float) -> NDArray:
        """Amplitudes by momentum over distance, in units of no meaning."""
        size = NEAR_SIZE + random.exponential(spread, count)
        momentum = size**3 * laws.fall_speed(size) / (NEAR_SIZE + spread) ** 3 / 8.0
        away = NEAREST + (1.0 - NEAREST) * np.sqrt(random.random(count))
        return np.minimum(momentum / away, LARGEST)
