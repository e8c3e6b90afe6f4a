"""Thunder: every piece of the bolt gives a pulse, which arrives when its way is done.

As Few has it (1969, 1974): a winding channel of short pieces, loudest across their own direction.
A near bolt cracks, as its first pieces arrive together; from a far one all come over many
seconds, and the air has kept the high frequencies.
"""

from __future__ import annotations

from functools import cache

import numpy as np
from numpy.typing import NDArray

from . import laws
from .impacts import Tail
from .overlap import HOP, RATE

PIECE = 12.0  # m
NEAREST = 40.0  # m
HEIGHTS = (2500.0, 5000.0)  # m, of the channel up to the cloud
IN_CLOUD = (2000.0, 6000.0)  # m, of what runs on inside the cloud
WINDING = 0.30  # rad, of each piece's turn
BRANCHES, BRANCH = 5, 500.0  # number, m
ECHO_DELAY, ECHO_SPEED = 0.5, 3000.0  # s, m/s: hills and layers of air give a bolt back later,
SCATTERING = 3000.0  # m, and the more of it the farther it is
PULSE_PEAK = 90.0  # Hz near the bolt; 50 Hz was measured as the mean from the ground
LENGTH = 4096  # samples of a pulse
DISTANCES = np.geomspace(NEAREST, 30_000.0, 28)  # m, for which pulses are kept


def channel(random: np.random.Generator, distance: float) -> NDArray:
    """(n, 6) middles and directions of the pieces of a bolt; the listener is at the origin."""
    high, along = random.uniform(*HEIGHTS), random.uniform(*IN_CLOUD)
    start = np.array((distance, 0.0, 0.0))
    up = _walk(random, start, (0.0, 1.0, 0.0), high)
    bearing = random.uniform(0.0, 2.0 * np.pi)
    inside = _walk(random, up[-1, :3], (np.cos(bearing), 0.1, np.sin(bearing)), along)
    found = [up, inside]
    for _ in range(BRANCHES):
        root = up[random.integers(len(up) // 6, len(up)), :3]
        slant = random.standard_normal(3) * (0.8, 0.0, 0.8) + (0.0, -0.8, 0.0)
        found.append(_walk(random, root, tuple(slant), BRANCH * random.uniform(0.4, 1.4)))
    pieces = np.concatenate(found)
    return pieces[pieces[:, 1] >= 0.0]


def _walk(
    random: np.random.Generator, start: NDArray, towards: tuple[float, ...], length: float
) -> NDArray:
    count = max(round(length / PIECE), 2)
    aim = np.asarray(towards) / np.linalg.norm(towards)
    bends = np.cumsum(random.normal(0.0, WINDING, (count, 3)), axis=0)
    bends -= np.linspace(0.0, 1.0, count)[:, None] * bends[-1]  # it comes back to its aim
    ways = aim + 0.6 * bends / max(np.abs(bends).max(), 1.0) + random.normal(0.0, 0.4, (count, 3))
    ways /= np.linalg.norm(ways, axis=1, keepdims=True)
    ends = start + np.cumsum(ways * PIECE, axis=0)
    return np.concatenate([ends - 0.5 * PIECE * ways, ways], axis=1)


@cache
def pulses() -> list[NDArray]:
    """A pulse for each of `DISTANCES`: a wave like an N, as the air leaves it; largest value 1."""
    f = np.fft.rfftfreq(LENGTH, 1.0 / RATE)
    t = np.arange(LENGTH) / RATE
    made = []
    for distance in DISTANCES.tolist():
        period = (distance / NEAREST) ** 0.12 / PULSE_PEAK / 2.0
        wave = np.where(t < period, 1.0 - 2.0 * t / period, 0.0)
        wave += 0.4 * np.exp(-t / (3.0 * period)) * np.sin(2.0 * np.pi * t / (2.2 * period))
        spectrum = np.fft.rfft(wave) * 10.0 ** (-laws.air_absorption(f) * distance / 20.0)
        spectrum *= f / (f + 18.0)  # no more than a loudspeaker gives
        spectrum *= np.exp(-2.0j * np.pi * f * 24.0 / RATE)  # room before it, for its own rise
        heard = np.fft.irfft(spectrum, LENGTH)
        heard *= np.minimum((LENGTH - 1 - np.arange(LENGTH)) / 1500.0, 1.0)
        made.append((heard / np.abs(heard).max()).astype(np.float32))
    return made


class Thunder:
    """Claps under way to the listener."""

    def __init__(self, seed: int) -> None:
        self._random = np.random.default_rng(seed)
        self._tail = Tail(LENGTH)
        pulses()  # made now, so that no strike waits for them
        self._next = 0  # samples given
        self._claps: list[tuple[NDArray, NDArray, NDArray, NDArray]] = []

    def strike(self, distance: float, delay: float) -> None:
        """Let thunder from a distance in m begin `delay` s on; beyond 20 km it is not heard."""
        if not distance <= laws.FARTHEST_THUNDER:
            return
        pieces = channel(self._random, max(distance, NEAREST))
        away = np.linalg.norm(pieces[:, :3], axis=1)
        along = np.abs((pieces[:, :3] * pieces[:, 3:]).sum(axis=1)) / away
        across = np.sqrt(np.clip(1.0 - along**2, 0.0, 1.0))
        loud = across**2 / away * self._random.uniform(0.3, 1.0, away.size)
        time = away / laws.SOUND_SPEED
        longest = ECHO_DELAY + distance / ECHO_SPEED
        echoes = distance / (distance + SCATTERING)
        late = self._random.exponential(longest, away.size)
        time = np.concatenate([time, time + 0.05 + late]) - time.min()
        loud = np.concatenate([loud, echoes * loud * np.exp(-0.5 * late / longest)])
        far = np.concatenate([away, 1.5 * away + 400.0])
        loud *= laws.thunder_level(distance) / _crest(time, loud)
        kinds = np.abs(np.log(far[:, None] / DISTANCES)).argmin(axis=1)
        ears = self._random.uniform(0.3, 0.7, far.size)
        order = np.argsort(time)
        begin = self._next + max(round(delay * RATE), 0)
        at = begin + np.round(time[order] * RATE).astype(np.int64)
        self._claps.append((at, loud[order], kinds[order], ears[order]))

    def block(self) -> NDArray | None:
        """(2, HOP) next samples; None where it is silent."""
        if not self._claps:
            return None
        end, sounds = self._next + HOP, pulses()
        for at, loud, kinds, ears in self._claps:
            low, high = np.searchsorted(at, (self._next, end)).tolist()
            for k in range(low, high):
                weight, ear = 2.0 * float(loud[k]), float(ears[k])
                place = int(at[k]) - self._next
                self._tail.add(sounds[kinds[k]], place, weight * (1.0 - ear), weight * ear)
        self._claps = [clap for clap in self._claps if clap[0][-1] + LENGTH >= self._next]
        return self._tail.take()

    def count(self) -> None:
        """A block has been given."""
        self._next += HOP


def _crest(time: NDArray, loud: NDArray) -> float:
    """What the largest value will be about: pieces that arrive within some 6 ms add up."""
    bins = np.bincount((time / 0.006).astype(int), weights=loud)
    return float(bins.max())
