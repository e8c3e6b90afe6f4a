"""Level of detail of a rain container: where its drops stand, how large, and for how many.

All distances are shares of the container's reach: d in [0, 1] from the container's centre.

Equation 2 puts drops at distance d with probability density 2 (1 - d). The same law is a mixture:
every drop has a reach s of its own, uniform in (0, 1], and stands anywhere in the half disc of
radius s with equal probability, for the integral over s from d to 1 of 2 d / s^2 is 2 (1 - d). A
drop that is carried over its own rim can so come in again at the opposite one without changing
the law. With q = d / s, `rim_fade(q)` lets it appear and vanish there without a pop.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike

from .checks import FloatArray, count, floats, number

RIM = 0.25  # share of its own reach over which a drop fades out
NEAREST = 1e-12  # own reaches are never smaller: they may be divided by


def radial_positions(n: int, rng: np.random.Generator) -> FloatArray:
    """n distances in [0, 1) with density 2 (1 - d), Equation 2: d = 1 - sqrt(1 - u)."""
    u = rng.random(count("n", n))
    return u / (1.0 + np.sqrt(1.0 - u))


def size_factor(distance: ArrayLike, maximum: float) -> FloatArray:
    """Equation 3: factor on a drop's size, 1 at distance 0 to `maximum` at 1 with the square.

    Distances outside [0, 1] count as the nearest end. `maximum` is at least 1.
    """
    d = np.clip(floats("distance", distance, -math.inf, math.inf), 0.0, 1.0)
    return 1.0 + (number("maximum", maximum, 1.0) - 1.0) * d * d


def own_reach(d: ArrayLike, u: ArrayLike) -> FloatArray:
    """Reach s of a drop that stands at d, from u uniform in [0, 1): 1/s = 1/d - u (1/d - 1).

    Of the drops at d, those of reach s are a share proportional to 1 / s^2, d <= s <= 1.
    """
    distance = np.maximum(floats("d", d, 0.0, 1.0), NEAREST)
    return distance / (1.0 - floats("u", u, 0.0, 1.0) * (1.0 - distance))


def rim_fade(q: ArrayLike) -> FloatArray:
    """1 inside, falling to 0 over the last quarter of a drop's own reach, q = d / s."""
    return np.clip((1.0 - floats("q", q, 0.0, math.inf)) / RIM, 0.0, 1.0)


def weight_shape(d: ArrayLike) -> FloatArray:
    """Integral of `rim_fade` from d to 1: (1 - d) times its mean over the drops at d.

    q is uniform in [d, 1] there. 0.875 - d up to d = 0.75, then 2 (1 - d)^2.
    """
    distance = floats("d", d, 0.0, 1.0)
    beyond = 1.0 - distance
    return np.where(beyond >= RIM, beyond - 0.5 * RIM, beyond * beyond / (2.0 * RIM))


def drops_stood_for(
    d: ArrayLike, s: ArrayLike, density: float, height: float, reach: float, n: int
) -> FloatArray:
    """Real drops that one of the n drawn in a half cylinder stands for, at d and of own reach s.

    With `density` real drops a cubic metre and a container of `height` and `reach` metres:
    density height pi r reach / (2 n weight_shape(d)) rim_fade(d / s), r = d reach. Summed over the
    drops of any ring this is, on average, the real drops of that ring. 0 at d = 1.
    """
    distance = floats("d", d, 0.0, 1.0)
    shape = weight_shape(distance)
    fade = rim_fade(distance / np.maximum(floats("s", s, 0.0, 1.0), NEAREST))
    whole = number("density", density, 0.0) * number("height", height, 0.0)
    ring = (
        whole * math.pi * distance * number("reach", reach, 0.0) ** 2 / (2 * max(1, count("n", n)))
    )
    return np.where(shape > 0.0, ring * fade / np.where(shape > 0.0, shape, 1.0), 0.0)
