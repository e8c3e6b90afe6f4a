"""The veil: rain along a view ray, less what the drops show; the oracle of `shaders/veil.frag`.

The same symbols and the same order as there, in float64. With f the ellipse's implicit function,
the rain rate's share at a point is (1 - f) / (1 - inner), at most 1 and 0 outside: along a ray f
is a quadratic in t, so the integral is closed. Rays have the length 1 along the camera's forward
axis, so that t is the depth below the camera, in metres.
"""

from __future__ import annotations

import math

import numpy as np
from numpy.typing import ArrayLike, NDArray

from .checks import FloatArray
from .crossing import Crossing
from .front import SETTLED, Dry, extinction_arrived

PARTS = 6  # of a way through rain that begins or ends; also in shaders/veil.frag
BEYOND = 1e5  # m, where a ray ends that meets nothing


def full_share(
    points: NDArray, axis: tuple[float, ...], shape: tuple[float, float, float]
) -> FloatArray:
    """Share of the rain rate at (x, z), (n,): what `rain_path` is the integral of.

    axis: centre x, centre z, cos heading, sin heading. shape: a, b, and the level of f inside which
    the rate is full.
    """
    ex, ez = points[..., 0] - axis[0], points[..., 1] - axis[1]
    u = (ex * axis[2] - ez * axis[3]) / shape[0]
    w = (ex * axis[3] + ez * axis[2]) / shape[1]
    return np.clip((1.0 - u * u - w * w) / (1.0 - shape[2]), 0.0, 1.0)


def drops_share(distance: ArrayLike, shown: float) -> FloatArray:
    """Share of the rain at a distance (m) that the drops show, from 1 at 0 to 0 at `shown` (m).

    All of it is the veil's where `shown` is 0.
    """
    away = np.asarray(distance, np.float64)
    return np.clip(1.0 - away / shown, 0.0, 1.0) if shown > 0.0 else np.zeros_like(away)


def rain_span(
    position: tuple[float, float, float],
    ray: NDArray,
    end: ArrayLike,
    ceiling: float,
    shown: float,
) -> tuple[FloatArray, FloatArray]:
    """Depths (t0, t1) between which the veil counts: under the ceiling, before the scene's `end`.

    t0 leaves out as much as the drops show: the integral of their share, up to t1.
    """
    t1 = np.minimum(np.asarray(end, np.float64), BEYOND)
    rise = np.where(np.abs(ray[..., 1]) < 1e-6, 1e-6, ray[..., 1])
    cut = (ceiling - position[1]) / rise
    t1 = np.where(rise > 0.0, np.minimum(t1, cut), t1)
    t0 = np.where(rise < 0.0, np.maximum(cut, 0.0), 0.0)
    if shown > 0.0:
        reach = shown / np.sqrt((ray * ray).sum(axis=-1))
        x = np.minimum(t1 / np.maximum(reach, 1e-4), 1.0)
        t0 = np.maximum(t0, reach * x * (1.0 - 0.5 * x))
    return t0, t1


def rain_path(
    position: tuple[float, float, float],
    ray: NDArray,
    end: ArrayLike,
    axis: tuple[float, ...],
    shape: tuple[float, float, float],
    ceiling: float,
    shown: float = 0.0,
    dry: Dry = SETTLED,
    rain_rate: float = 0.0,
) -> FloatArray:
    """Metres of rain at its full rate along rays (..., 3) that end at the depths `end`.

    For `axis` and `shape` see `full_share`; `shown` is the distance (m) at which the drops' share
    has fallen to 0. Multiplied by the extinction this is the optical depth. `dry` and `rain_rate`
    (mm/h) as in `physics.front`, where rain begins or ends: the integral is then one of PARTS,
    in each of which the share that has come down is that at its middle.
    """
    t0, t1 = rain_span(position, ray, end, ceiling, shown)
    crossing = Crossing(position, ray, axis, shape)
    if dry == SETTLED:
        path = crossing.full_path(t0, t1)
    else:
        rim = crossing.middle - crossing.half_chord, crossing.middle + crossing.half_chord
        x0, x1 = (np.clip(t, *rim) for t in (t0, t1))
        cuts = x0 + (x1 - x0) * (np.arange(PARTS + 1) / PARTS).reshape(-1, *[1] * x0.ndim)
        path = np.zeros_like(x0)
        for first, last in zip(cuts[:-1], cuts[1:], strict=True):
            fall = ceiling - (position[1] + ray[..., 1] * 0.5 * (first + last))
            path += extinction_arrived(fall, dry, rain_rate) * crossing.full_path(first, last)
    length = np.sqrt((ray * ray).sum(axis=-1))
    return np.where(t1 > t0, path * length, 0.0)


def rain_distance(
    position: tuple[float, float, float],
    ray: NDArray,
    end: ArrayLike,
    axis: tuple[float, ...],
    shape: tuple[float, float, float],
    ceiling: float,
    shown: float,
    extinction: float,
    dry: Dry = SETTLED,
    rain_rate: float = 0.0,
) -> FloatArray:
    """Distance in m at which one sees the rain of a ray, for the fog before it; as `rain_path`.

    The light of rain at an even rate, seen through rain, comes from 1 / (2 + its optical depth)
    of the way deep: the middle where it is thin, one optical depth where it is thick.
    """
    t0, t1 = rain_span(position, ray, end, ceiling, shown)
    path = rain_path(position, ray, end, axis, shape, ceiling, shown, dry, rain_rate)
    lost = extinction * path
    near, far = Crossing(position, ray, axis, shape).within(t0, t1)
    along = near + (far - near) / (2.0 + lost)
    return np.asarray(along * np.sqrt((ray * ray).sum(axis=-1)))


def wave(x: NDArray) -> FloatArray:
    """-1 to 1, smooth, of period 1."""
    y = np.abs((x - np.floor(x)) * 2.0 - 1.0)
    return np.asarray(y * y * (6.0 - 4.0 * y) - 1.0)


def rays_of_rain(u: NDArray) -> FloatArray:
    """Rays within a shaft seen from afar, -1 to 1; u: place across it, in its half widths."""
    return 0.5 * wave(u * 0.83) + 0.35 * wave(u * 2.17 + 0.37) + 0.15 * wave(u * 5.71 + 0.71)


def curtain_share(
    position: tuple[float, float, float],
    ray: NDArray,
    end: ArrayLike,
    axis: tuple[float, ...],
    shape: tuple[float, float, float],
    ceiling: float,
    shown: float,
    top: float,
    ragged: float,
    phase: float,
    drift: tuple[float, float],
) -> FloatArray:
    """Factor on the optical depth of a ray through rain under a cloud; as `rain_path`.

    Thin in the `top` (m) below the ceiling, by the height in the middle of the ray's way through
    it; and uneven by `ragged`, more so near the rim, in rays that `drift` m along (x, z) in 1 m of
    fall.
    """
    t0, t1 = rain_span(position, ray, end, ceiling, shown)
    crossing = Crossing(position, ray, axis, shape)
    near, far = crossing.within(t0, t1)
    fall = ceiling - (position[1] + ray[..., 1] * 0.5 * (near + far))
    soft = np.clip(fall / top, 0.0, 1.0) if top > 0.0 else np.ones_like(fall)
    gone_u, gone_w = crossing.own(*drift)
    gone = (gone_u * crossing.dw - gone_w * crossing.du) * fall
    across = (crossing.aside - gone) / np.sqrt(crossing.a)
    uneven = ragged * (0.35 + 0.55 * np.minimum(crossing.lowest, 1.0))
    return np.asarray(soft * (1.0 + uneven * rays_of_rain(across + phase)))


def longest_path(shape: tuple[float, float, float]) -> float:
    """Metres of rain at its full rate along the longest level way through an ellipse."""
    a, _, inner = shape
    root = math.sqrt(inner)
    return 4.0 / 3.0 * a * (1.0 - inner * root) / (1.0 - inner)


def opacity(path: ArrayLike, extinction: float) -> FloatArray:
    """What a veil covers, 0 to 1: the light that does not get through."""
    return -np.expm1(-np.asarray(path, np.float64) * extinction)


def scene_depth(value: ArrayLike, projection: NDArray) -> FloatArray:
    """Depth t (m along the forward axis) of a depth buffer's values in [0, 1]; 1 is infinitely far.

    From the projection's own third row, so that the far plane is where it has it.
    """
    stored = np.asarray(value, np.float64)
    with np.errstate(divide="ignore"):
        t = projection[2, 3] / (stored * 2.0 - 1.0 + projection[2, 2])
    return np.where(stored >= 1.0, math.inf, t)
