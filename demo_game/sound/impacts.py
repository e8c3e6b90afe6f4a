"""Single sounds laid one over the other: drops near the ear, claps of thunder."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from .overlap import CHANNELS, HOP, RATE

KINDS = 24  # different sounds of each surface
# Of a surface: lowest and highest pitch in Hz, shortest and longest decay in s, length in s.
GROUND = (1200.0, 5200.0, 0.0012, 0.004, 0.02)
LEAF = (700.0, 2600.0, 0.003, 0.009, 0.04)
BOARD = (110.0, 520.0, 0.012, 0.045, 0.16)


class Tail:
    """What is still to be heard of sounds that have begun."""

    def __init__(self, longest: int) -> None:
        self._buffer = np.zeros((CHANNELS, HOP + longest), np.float32)
        self._spare = np.zeros_like(self._buffer)

    def add(self, sound: NDArray, at: int, left: float, right: float) -> None:
        """Begin a sound `at` samples into the next block."""
        span = self._buffer[:, at : at + sound.size]
        span[0] += left * sound
        span[1] += right * sound

    def take(self) -> NDArray:
        """(2, HOP) next block; the rest moves up."""
        taken = self._buffer[:, :HOP].copy()
        self._spare[:, :-HOP] = self._buffer[:, HOP:]
        self._spare[:, -HOP:] = 0.0
        self._buffer, self._spare = self._spare, self._buffer
        return taken


def bank(
    surface: tuple[float, float, float, float, float], seed: int, kinds: int = KINDS
) -> list[NDArray]:
    """Sounds of drops on a surface, each of energy 1: a knock and two modes that die away."""
    low, high, short, long, length = surface
    random = np.random.default_rng(seed)
    soft = max(round(0.04 * short * RATE), 1)  # samples over which a knock is blurred
    t = np.arange(round(length * RATE)) / RATE
    sounds = []
    for _ in range(kinds):
        pitch = low * (high / low) ** random.random()
        decay = short * (long / short) ** random.random()
        sound = np.sin(2.0 * np.pi * pitch * t) * np.exp(-t / decay)
        partial = pitch * random.uniform(1.5, 2.9)
        sound += 0.6 * np.sin(2.0 * np.pi * partial * t) * np.exp(-2.0 * t / decay)
        knock = random.standard_normal(t.size) * np.exp(-t / (0.35 * short))
        knock = np.convolve(knock, np.hanning(soft + 2)[1:-1])[: t.size]
        sound += 0.35 * knock / np.sqrt((knock**2).sum()) * np.sqrt((sound**2).sum())
        sound *= np.minimum(t / 0.0002, 1.0) * np.minimum((t[-1] - t) / 0.003, 1.0)  # no edges
        sounds.append((sound / np.sqrt((sound**2).sum())).astype(np.float32))
    return sounds
