"""What one drop looks like: the oracle of `shaders/streak.vert`, in float64.

A drop that is drawn stands for `weight` real ones; its streak is as long as the drop's path
relative to the camera during the exposure, as wide as the drop, both times a factor of the look,
and what it hides of the picture is the cross-section of the real drops: its area as it is seen,
times its opacity, times the mean of its profile. What is thinner than a pixel is drawn a pixel wide
and so much fainter.
"""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

from .checks import FloatArray
from .ellipse import edge_factor
from .front import SETTLED, Dry, fallen_share
from .lod import rim_fade, size_factor, weight_shape
from .rain_place import to_container
from .rain_step import diameters, fall_speeds

LANDED = 1024.0  # m/s upwards: no velocity but the mark of a drop that has hit something
BOLD = 1.5e-3  # m, from which on a drop may have the look's greatest opacity
CLOSEST = 0.1  # m in front of the camera
FAINTEST = 0.002  # opacity below which nothing is drawn
OUTSIDE = 1.02  # in normalised device coordinates, of both ends
# Mean over a streak of what streak.frag leaves of its opacity: the rim, then both ends.
PROFILE = (1.0 - 0.4 / 3.0) * (1.0 - 0.5 / 3.0 - 0.5 / 6.0)


def no_lights() -> FloatArray:
    return np.zeros((0, 7))


@dataclass(frozen=True, slots=True)
class StreakView:
    """Camera and light, as in the uniform block `RainView`; colours are linear RGB."""

    view_projection: NDArray  # (4, 4), for column vectors
    position: tuple[float, float, float]
    velocity: tuple[float, float, float]  # m/s
    exposure: float  # s
    pixels: float  # per unit of width over depth
    size: tuple[float, float]  # pixels, width and height
    sun_direction: tuple[float, float, float]
    sun_color: tuple[float, float, float]
    drop_color: tuple[float, float, float]  # what a drop shows of the sky
    lights: NDArray = field(default_factory=no_lights)  # (n, 7): position, reach in m, colour
    fog_color: tuple[float, float, float] = (0.0, 0.0, 0.0)
    fog: float = 0.0  # 1/m, extinction of the air between camera and drops


@dataclass(frozen=True, slots=True)
class StreakLaw:
    """A container's drops, as in the uniform block `RainDraw`."""

    container_axis: tuple[float, float, float, float]
    container_shape: tuple[float, float, float, float]
    area_axis: tuple[float, float, float, float]
    area_shape: tuple[float, float, float, float]  # a, b, soft edge, ceiling
    law: tuple[float, float, float, float]
    load: float  # real drops that one stands for, over d / weight_shape(d)
    count: float  # drops in use
    fade: float  # 1 / number of drops over which the last ones fade
    size_maximum: float
    size_scale: float  # of drops as a whole, width and length
    width: float  # factor on the drop's diameter
    opacity: float  # greatest of one streak
    density: float = 1.0  # factor on how much the drops cover; 1 is what nature shows
    dry: Dry = SETTLED  # fall times of the drops that are missing


@dataclass(frozen=True, slots=True)
class Streaks:
    """What the shader hands on, and what it comes from; 0 everywhere where nothing is drawn."""

    tail: FloatArray  # (n, 4), clip space
    head: FloatArray  # (n, 4)
    color: FloatArray  # (n, 4), encoded, with opacity
    width: FloatArray  # (n,), pixels
    weight: FloatArray  # (n,), real drops
    area: FloatArray  # (n,), m2 at its depth that it takes in the picture, times its profile's mean
    solid: FloatArray  # (n,), opacity of that area, but for the fading of what is close


def drop_weight(
    p: NDArray, own_reach: NDArray, ids: NDArray, law: StreakLaw
) -> tuple[FloatArray, FloatArray]:
    """(real drops that each stands for, distance as a share of the reach), each (n,)."""
    q = to_container(p[:, [0, 2]].astype(np.float32), law.container_axis, law.container_shape)
    d = np.minimum(np.hypot(q[:, 0], q[:, 1]).astype(np.float64), 0.999)
    last = np.clip((law.count - ids) * law.fade, 0.0, 1.0)
    x, z, c, s = law.area_axis
    a, b, soft, _ = law.area_shape
    there = edge_factor(p[:, [0, 2]], (x, z), (a, b), math.atan2(s, c), soft)
    return law.load * d / weight_shape(d) * rim_fade(d / own_reach) * last * there, d


def light_on(p: NDArray, view: StreakView) -> FloatArray:
    """Linear RGB that drops at p show: sky, sun glow, point lights, and fog before them, (n, 3)."""
    ray = p - np.asarray(view.position)
    far = np.linalg.norm(ray, axis=1, keepdims=True)
    ray = ray / far
    glow = np.maximum(ray @ np.asarray(view.sun_direction), 0.0) ** 8
    light = np.asarray(view.drop_color) + np.asarray(view.sun_color) * (0.6 * glow)[:, None]
    for lamp in view.lights:
        away = lamp[:3] - p
        r2 = (away * away).sum(axis=1)
        fade = np.maximum(1.0 - r2 / lamp[3] ** 2, 0.0)
        toward = (ray * away).sum(axis=1) / np.sqrt(np.maximum(r2, 1e-12))
        forward = 0.35 + 0.65 * np.maximum(toward, 0.0) ** 4
        light = light + lamp[4:7] * (fade * fade * forward / (1.0 + 0.5 * r2))[:, None]
    left = np.exp(-view.fog * far)
    return light * left + np.asarray(view.fog_color) * (1.0 - left)


def streaks(p: NDArray, v: NDArray, birth: NDArray, view: StreakView, law: StreakLaw) -> Streaks:
    """Streaks of drops at p (m) that move with v (m/s), each (n, 3); birth as in `rain_step`."""
    n = len(p)
    p, v = p.astype(np.float64), v.astype(np.float64)
    path = (v - np.asarray(view.velocity)) * view.exposure
    head, tail = _clip(p, view.view_projection), _clip(p - path, view.view_projection)
    drawn = (v[:, 1] <= LANDED) & (np.minimum(head[:, 3], tail[:, 3]) >= CLOSEST)
    h = head[:, :2] / np.where(drawn, head[:, 3], 1.0)[:, None]
    t = tail[:, :2] / np.where(drawn, tail[:, 3], 1.0)[:, None]
    drawn &= (np.minimum(h, t) <= OUTSIDE).all(axis=1) & (np.maximum(h, t) >= -OUTSIDE).all(axis=1)

    path = path * law.size_scale  # far drops are drawn larger in all directions
    tail = _clip(p - path, view.view_projection)
    drawn &= tail[:, 3] >= CLOSEST
    weight, d = drop_weight(p, birth[:, 2], np.arange(n), law)
    rise = (p[:, 1] - law.container_shape[2]) / law.container_shape[3]
    weight = weight * np.clip((1.0 - rise) * 8.0, 0.0, 1.0) * (p[:, 1] <= law.area_shape[3])
    size = diameters(birth[:, 3], law.law)
    fallen = (law.area_shape[3] - p[:, 1]) / np.maximum(fall_speeds(size), 0.1)
    weight = weight * fallen_share(fallen, law.dry)
    diameter = size * 1e-3
    width = diameter * size_factor(d, law.size_maximum) * law.width * law.size_scale
    scale = view.pixels / np.where(drawn, head[:, 3], 1.0)
    pixels = width * scale
    area = drawn_area(h, tail, np.maximum(pixels, 1.0), view) / scale**2
    most = law.opacity ** np.maximum(BOLD / diameter, 1.0) * np.minimum(pixels, 1.0)
    solid = np.minimum(0.25 * math.pi * diameter**2 * weight * law.density / area, most)

    near = np.clip((head[:, 3] - 0.3) / 1.3, 0.0, 1.0)
    opacity = solid * near * near * (3.0 - 2.0 * near)
    drawn &= opacity >= FAINTEST
    color = np.column_stack([np.maximum(light_on(p, view), 0.0) ** (1.0 / 2.2), opacity])
    return Streaks(
        *(np.where(drawn[:, None], x, 0.0) for x in (tail, head, color)),
        *(np.where(drawn, x, 0.0) for x in (np.maximum(pixels, 1.0), weight, area, solid)),
    )


def drawn_area(h: NDArray, tail: NDArray, wide: NDArray, view: StreakView) -> FloatArray:
    """Pixels that streaks take, times their profile's mean, (n,), as shaders/streak.geom has it.

    h (n, 2): heads in normalised device coordinates; tail (n, 4): clip space; wide: pixels.
    """
    t = tail[:, :2] / np.maximum(tail[:, 3], CLOSEST)[:, None]
    span = np.linalg.norm((h - t) * 0.5 * np.asarray(view.size), axis=1)
    return PROFILE * wide * np.maximum(span, wide)


def _clip(points: NDArray, view_projection: NDArray) -> FloatArray:
    return points @ view_projection[:, :3].T + view_projection[:, 3]
