"""Small-scale turbulence of the air; the oracle of `shaders/turbulence.glsl`, in float32.

Three octaves of eddies, of the wavelengths `scale`, `scale`/2.3 and `scale`/5.1, whose strength
falls with the cube root of their size, as in the inertial range (Kolmogorov 1941). Each octave is a
field of Arnold, Beltrami and Childress in axes of its own, which is its own curl over its wave
number K:

    u = (sin c + cos b, sin a + cos c, sin b + cos a)      (a, b, c) = K q + phases

so it is free of divergence, its mean is 0, and the standard deviation of each component is 1. The
phases carry the eddies along with the wind and turn them over.

Towards the ground its up and down dies out, as air cannot go through it, for small eddies lower
down than for large ones (after Hunt and Graham 1978). At h metres, with A = min(K h, pi/2):

    (sin A ux + cos A uz, sin A uy, sin A uz - cos A ux)

is the curl of sin(A) u/K: still free of divergence, 0 upwards on the ground, and as strong
sideways at every height.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .wind import HIGHEST, LOWEST

F = np.float32
RATIOS = (1.0, 1.0 / 2.3, 1.0 / 5.1)  # of an octave's wavelength to `scale`
# Columns: the axes of an octave, right-handed; in the shader with the same digits.
FRAMES = (
    np.array([[2, -1, 2], [2, 2, -1], [-1, 2, 2]]) / 3.0,
    np.array([[2, 3, 6], [3, -6, 2], [6, 2, -3]]) / 7.0,
    np.array([[1, 8, -4], [-4, 4, 7], [8, 1, 4]]) / 9.0,
)
SHARES = tuple(
    math.sqrt(r ** (2.0 / 3.0) / sum(q ** (2.0 / 3.0) for q in RATIOS)) for r in RATIOS
)  # of the whole standard deviation
HALF_PI = 0.5 * math.pi
LAG = 1.0 / (9.8 * math.sqrt(3.0))  # s2/m


@dataclass(frozen=True, slots=True)
class AirFlow:
    """What is the same for all places: the uniform block `AirFlow`."""

    wind: tuple[float, float, float]  # m/s, the mean at the reference height
    reference: float = 10.0  # m above the ground
    exponent: float = 0.0
    ground: float = 0.0  # m, world height
    gains: tuple[float, ...] = (0.0, 0.0, 0.0)  # m/s, standard deviation by octave
    octaves: tuple[tuple[float, float, float, float], ...] = ((0.0, 0.0, 0.0, 1.0),) * 3
    # of each octave: phases along its axes, rad; wave number, 1/m


def air_flow(
    wind: tuple[float, float, float],
    *,
    reference: float = 10.0,
    exponent: float = 0.0,
    ground: float = 0.0,
    turbulence: float = 0.0,
    scale: float = 6.0,
    run: tuple[float, float, float] = (0.0, 0.0, 0.0),
) -> AirFlow:
    """The flow in which the air has gone `run[0]`, `run[1]` m along x and z.

    turbulence: standard deviation of a component, m/s; scale: m, of the largest eddies; run[2]:
    that deviation integrated over time, m, by which eddies turn over.
    """
    octaves = []
    for ratio, share, frame in zip(RATIOS, SHARES, FRAMES, strict=True):
        number = 2.0 * math.pi / (scale * ratio)
        carried = number * (run[0] * frame[0] + run[1] * frame[2])
        # Each axis at a pace of its own, so that an octave never comes back to what it was.
        turned = 0.5 * number * share * run[2] * np.array([1.0, -0.71, 0.53])
        a, b, c = ((turned - carried) % (2.0 * math.pi)).tolist()
        octaves.append((a, b, c, number))
    gains = tuple([share * turbulence for share in SHARES])
    return AirFlow(wind, reference, exponent, ground, gains, tuple(octaves))


def mean_velocity(p: ArrayLike, flow: AirFlow) -> NDArray[np.float32]:
    """The wind without its turbulence at world points (n, 3), m/s."""
    height = np.clip(np.asarray(p, F)[:, 1] - F(flow.ground), F(LOWEST), F(HIGHEST))
    share = np.exp2(F(flow.exponent) * np.log2(height * F(1.0 / flow.reference)))
    return (np.asarray(flow.wind, F) * share[:, None]).astype(F)


def felt_shares(speed: ArrayLike, flow: AirFlow) -> NDArray[np.float32]:
    """Of the eddies of each octave, the share that a thing takes on which falls so fast, (n, 3).

    Drag makes it follow with the time constant speed / g, and it meets K speed / sqrt(3) rad/s of
    waves of every direction.
    """
    fall = np.asarray(speed, F)
    lag = np.array([octave[3] for octave in flow.octaves], F) * (fall * fall * F(LAG))[:, None]
    return (F(1.0) / np.sqrt(lag * lag + F(1.0))).astype(F)


def eddies(p: ArrayLike, flow: AirFlow, speed: ArrayLike | None = None) -> NDArray[np.float32]:
    """The turbulence alone at world points (n, 3), m/s.

    With `speed`, (n,), m/s: the share of it that a thing takes on which falls through it so fast.
    """
    felt = None if speed is None else felt_shares(speed, flow)
    at = np.asarray(p, F)
    height = np.maximum(at[:, 1] - F(flow.ground), F(0.0))
    total = np.zeros_like(at)
    for k, (given, octave, axes) in enumerate(zip(flow.gains, flow.octaves, FRAMES, strict=True)):
        gain: NDArray | np.float32 = F(given)
        if felt is not None:
            gain = gain * felt[:, k : k + 1]
        frame, number = axes.astype(F), F(octave[3])
        q = at @ frame * number + np.asarray(octave[:3], F)
        s, c = np.sin(q), np.cos(q)
        u = (s[:, [2, 0, 1]] + c[:, [1, 2, 0]]) @ frame.T
        a = np.minimum(number * height, F(HALF_PI))
        up, level = np.sin(a), np.cos(a)
        x, y, z = u[:, 0], u[:, 1], u[:, 2]
        total += gain * np.stack([up * x + level * z, up * y, up * z - level * x], axis=1)
    return total


def air_velocity(p: ArrayLike, flow: AirFlow) -> NDArray[np.float32]:
    """Velocity of the air at world points (n, 3), m/s."""
    mean = mean_velocity(p, flow)
    return mean + eddies(p, flow) if any(flow.gains) else mean
