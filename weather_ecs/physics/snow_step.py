"""What moves a flake: the oracle of `shaders/snow_law.glsl`, in float32, symbol for symbol."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .snow import SnowLaw, clump_onset
from .words import hash_word

F = np.float32
U = np.uint32
PERIOD = 64.0  # s, after which the swings come round: every frequency is a multiple of 1/64 Hz


@dataclass(frozen=True, slots=True)
class Flakes:
    """What is the same for all flakes of a step: the uniform block `Snow`."""

    flutter: float  # factor on the swings
    time: float  # share of PERIOD that has passed
    onset: float  # mm, melted diameter from which flakes are clumps
    paper: bool  # Liu and Tong's flakes


def flakes_of(law: SnowLaw, time: float, flutter: float = 1.0) -> Flakes:
    """Of a snowfall, at the weather's clock (s)."""
    onset, paper = clump_onset(law.temperature), law.model == "liu_tong"
    return Flakes(flutter, time % PERIOD / PERIOD, onset, paper)


def flake_words(ids: NDArray[np.uint32]) -> NDArray[np.uint32]:
    """What each flake is by chance."""
    return hash_word(ids.astype(U) ^ U(0x5F356495))


def flake_diameters(quantile: NDArray, law: tuple[float, ...]) -> NDArray[np.float32]:
    """Melted diameters in mm."""
    left = np.maximum(F(1.0) - quantile * F(law[1]), F(1e-7))
    return np.minimum(F(0.2) - np.log(left) / F(law[0]), F(4.0)).astype(F)


def flake_habits(words: NDArray[np.uint32], law: tuple[float, ...]) -> NDArray[np.int64]:
    """`snow.Habit` of each."""
    cold = F(3.0) - F(law[3]) + F(12.0) * ((words & U(255)).astype(F) * F(1.0 / 256.0))
    kinds = np.array([0, 1, 0, 2, 0, 1])
    return kinds[np.searchsorted(np.array([4.0, 10.0, 12.0, 17.0, 22.0], F), cold)]


def flake_velocities(
    ids: NDArray[np.uint32], quantile: NDArray, law: tuple[float, ...], flakes: Flakes
) -> NDArray[np.float32]:
    """In still air, m/s, (n, 3)."""
    words = flake_words(ids)
    often = np.stack([(words >> U(8)) & U(63), (words >> U(14)) & U(63)], axis=1).astype(F)
    phase = np.stack([(words >> U(20)) & U(63), words >> U(26)], axis=1).astype(F)
    if flakes.paper:
        chance = np.stack([phase[:, 0], often[:, 0], phase[:, 1]], axis=1)
        spread = (chance * F(2.0 / 63.0) - F(1.0)) * np.array([0.25, 0.2, 0.25], F)
        return (np.array([0.0, -1.0, 0.0], F) + spread).astype(F)
    diameter, wet = flake_diameters(quantile, law), F(law[2])
    x = np.clip((diameter - F(flakes.onset)) / F(0.4), F(0.0), F(1.0))
    clumped = x * x * (F(3.0) - F(2.0) * x)
    habit = flake_habits(words, law)
    single = np.where(habit == 2, F(0.31), F(0.5))
    fall = single + (F(0.8) * (F(4.0) * diameter) ** F(0.16) - single) * clumped
    drop = F(9.65) - F(10.3) * np.exp(F(-0.6) * diameter)
    fall = fall + (drop - fall) * wet * wet
    turn = ((often + F(30.0)) * F(flakes.time) + phase * F(1.0 / 64.0)) % F(1.0)
    swing = np.cos(F(6.2831853) * turn)
    sway = F(flakes.flutter) * (F(1.0) - wet)
    plates = np.where(habit == 0, F(0.4), F(0.2))
    side = sway * fall * (plates + (F(0.35) - plates) * clumped)
    down = -fall * (F(1.0) + F(0.1) * sway * (F(2.0) * swing[:, 0] ** 2 - F(1.0)))
    return np.stack([side * swing[:, 0], down, side * swing[:, 1]], axis=1).astype(F)
