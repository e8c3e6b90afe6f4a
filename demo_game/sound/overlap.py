"""Sound by overlapping frames: noise of any spectrum, and a filter, both free to change."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

RATE = 44100  # samples a second
HOP = 1024  # samples in a block
FRAME = 2 * HOP
CHANNELS = 2
TOGETHER = 0.5  # correlation of the noise in the two ears

FREQUENCIES = np.fft.rfftfreq(FRAME, 1.0 / RATE)
# Root of Hann's window: squares of two that overlap by half add up to 1.
WINDOW = np.sin(np.pi * (np.arange(FRAME) + 0.5) / FRAME).astype(np.float32)


def amplitudes(power: NDArray, level: float) -> NDArray:
    """Amplitude of every bin for noise of a power over frequency and a root mean square."""
    total = float(power.sum())
    return np.sqrt(power) * (level * FRAME / 2.0 / np.sqrt(total) if total > 0.0 else 0.0)


class Overlap:
    """Makes blocks of `HOP` samples from frames of twice that; both ears at once.

    What goes in comes out at the same place: it has to be given one block ahead.
    """

    def __init__(self, seed: int) -> None:
        self._random = np.random.default_rng(seed)
        self._dry = np.zeros((CHANNELS, FRAME), np.float32)
        self._out = np.zeros((CHANNELS, FRAME), np.float32)

    def block(self, ahead: NDArray, gain: NDArray, noise: NDArray) -> NDArray:
        """(2, HOP) next samples.

        ahead: (2, HOP) of what is filtered, one block on. gain: of amplitude, by bin. noise:
        `amplitudes` of what is added, by bin.
        """
        dry, out = self._dry, self._out
        dry[:, :HOP] = dry[:, HOP:]
        dry[:, HOP:] = ahead
        spectrum = np.fft.rfft(dry * WINDOW, axis=1) * gain
        bins = FREQUENCIES.size
        draws = self._random.standard_normal((CHANNELS, 2 * bins), np.float32).view(np.complex64)
        draws[1] = TOGETHER * draws[0] + np.sqrt(1.0 - TOGETHER**2) * draws[1]
        draws[:, 0] = draws[:, -1] = 0.0
        spectrum += draws * noise
        out[:, :HOP] = out[:, HOP:]
        out[:, HOP:] = 0.0
        out += np.fft.irfft(spectrum, FRAME, axis=1) * WINDOW
        return out[:, :HOP].copy()
