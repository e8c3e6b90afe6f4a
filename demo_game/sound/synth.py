"""Everything that is heard, block by block; numpy only, the same for the same seed and calls."""

from __future__ import annotations

import math
from collections import deque
from dataclasses import dataclass, fields

import numpy as np
from numpy.typing import NDArray

from . import laws
from .overlap import CHANNELS, FREQUENCIES, HOP, RATE, Overlap, amplitudes
from .rain import Rain
from .thunder import Thunder

GLIDE = 0.14  # s in which what is heard follows what is told
TURBULENCE, FLUTTER = 0.10, 1.2  # of the wind's speed between its gusts, s
MOST_STRIKES = 16  # that wait to be made
KNEE = 0.7  # from which the loudest is bent, so that it stays below 1


@dataclass(slots=True)
class Heard:
    """What the listener is in."""

    rain_rate: float = 0.0  # mm/h in the open, or on the roof overhead
    leaves: float = 0.0  # 0 to 1, under a tree
    roof: float = 0.0  # 0 to 1, under boards
    wind_speed: float = 0.0  # m/s
    snow_depth: float = 0.0  # m on the ground
    volume: float = 1.0  # 0 to 1


FIELDS = tuple(field.name for field in fields(Heard))


class Synth:
    """Gives 44100 samples a second for two ears, in blocks."""

    def __init__(self, seed: int = 0) -> None:
        self._frames = Overlap(seed)
        self._rain, self._thunder = Rain(seed + 1), Thunder(seed + 2)
        self._random = np.random.default_rng(seed + 3)
        self._target, self._now = Heard(), Heard(volume=0.0)
        self._strikes: deque[tuple[float, float]] = deque(maxlen=MOST_STRIKES)
        self._flutter, self._volume, self._begun = 0.0, 0.0, False
        self._held = np.zeros((CHANNELS, HOP), np.float32)
        self.samples = 0  # given so far

    def hear(self, target: Heard) -> None:
        """Glide to what is heard now; from another thread, too."""
        self._target = target

    def thunder(self, distance: float, delay: float) -> None:
        """Thunder from a distance in m, to begin `delay` s on; from another thread, too."""
        self._strikes.append((distance, delay))

    def block(self) -> NDArray:
        """(2, HOP) next samples, between -1 and 1."""
        self._follow()
        while self._strikes:
            # What is made now is heard a block later.
            distance, delay = self._strikes.popleft()
            self._thunder.strike(distance, max(delay - HOP / RATE, 0.0))
        now = self._now
        leaves, roof, rate = now.leaves, now.roof, now.rain_rate * laws.snow_gain(now.snow_depth)
        if roof > 0.0:  # the roof's own rain is not swallowed by snow on the ground
            rate += roof * (now.rain_rate - rate)
        outside, inside = self._rain.near(rate, leaves, roof)
        clap = self._thunder.block()
        self._thunder.count()
        if clap is not None:
            outside = outside + clap
        gain = laws.shelter_gain(FREQUENCIES, leaves, roof)
        power = self._rain.bed(rate, leaves, roof, gain)
        speed = max(now.wind_speed * (1.0 + TURBULENCE * self._flutter), 0.0)
        level = laws.wind_level(speed)
        if level > 0.0:
            power = power + (amplitudes(laws.wind_shape(FREQUENCIES, speed), level) * gain) ** 2
        made = self._frames.block(
            outside, gain.astype(np.float32), np.sqrt(power, dtype=np.float32)
        )
        made += self._held  # what is not filtered waits the block that the filter takes
        self._held = inside
        volume = now.volume * now.volume
        made *= np.linspace(self._volume, volume, HOP, dtype=np.float32)
        self._volume = volume
        self.samples += HOP
        return bend(made)

    def _follow(self) -> None:
        now, target = self._now, self._target
        step = 1.0 - math.exp(-HOP / RATE / GLIDE)
        for name in FIELDS:
            value, aim = getattr(now, name), getattr(target, name)
            is_near = (not self._begun and name != "volume") or abs(aim - value) < 1e-4
            setattr(now, name, aim if is_near else value + step * (aim - value))
        self._begun = True
        keep = math.exp(-HOP / RATE / FLUTTER)
        self._flutter *= keep
        self._flutter += math.sqrt(1.0 - keep * keep) * float(self._random.standard_normal())
        self._flutter = min(max(self._flutter, -2.0), 2.0)


def bend(signal: NDArray) -> NDArray:
    """The signal with what is above the knee bent towards 1, smoothly."""
    over = np.abs(signal) - KNEE
    if float(over.max()) <= 0.0:
        return signal
    bent = KNEE + (1.0 - KNEE) * np.tanh(over / (1.0 - KNEE))
    return np.where(over > 0.0, np.copysign(bent, signal), signal)


def to_bytes(signal: NDArray) -> bytes:
    """A (2, n) signal as 16-bit samples, the ears in turn."""
    return np.round(signal.T * 32767.0).astype("<i2").tobytes()
