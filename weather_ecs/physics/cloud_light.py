"""The light of clouds, as shaders/cloud_light.glsl has it, and the haze before them.

Notation: v vertex from the cloud's centre, world axes, m; s the centre of its seed from there;
n unit normal; w unit, from the camera to the vertex; L unit, towards the sun; a what the seed's
ray has lost, 0 to 1. Colours linear RGB. Arrays are (..., 3) or (...,).
Source of the plain light: Torchelsen 2005, 3.3, after Wang 2004.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from weather_ecs.physics.cloud_billboard import smoothstep
from weather_ecs.physics.haze import whitened
from weather_ecs.physics.high_sun import LEVELS, sun_at
from weather_ecs.physics.optics import CLEAR

Array = NDArray[np.float64]

CLEAN = CLEAR  # 1/m, extinction of clean air at the ground
CLEAN_HEIGHT = 2000.0  # m, over which clean air's haze thins by a factor e
FOG_HEIGHT = 150.0  # m, the same of what fog and rain add to it


def plain_light(v: Array, a: Array, L: Array, sun: Array, ambient: Array) -> Array:
    """diffuse + ambient, diffuse = clamp(dot(L, unit(v)) sun - a, 0, 1)."""
    n = v / np.maximum(np.linalg.norm(v, axis=-1, keepdims=True), 1e-6)
    diffuse = (n @ L)[..., None] * sun - np.asarray(a)[..., None]
    return np.clip(diffuse, 0.0, 1.0) + ambient


@dataclass(frozen=True, slots=True)
class Surround:
    """What lights a cloud; linear RGB, (3,)."""

    direction: Array  # unit, towards the sun
    sun: Array
    above: Array
    below: Array
    plain: Array  # the plain model's one ambient light
    suns: Array  # (LEVELS, 3), the sun's by height, see `physics.high_sun`


def surround(
    direction: ArrayLike, sun: ArrayLike, zenith: ArrayLike, horizon: ArrayLike, ground: ArrayLike,
    suns: ArrayLike | None = None,
) -> Surround:  # fmt: skip
    """Light of sky and ground as a cloud gets it; without `suns` the sun is the same everywhere."""
    sun, zenith, horizon, ground = (
        np.asarray(c, np.float64) for c in (sun, zenith, horizon, ground)
    )
    towards = np.asarray(direction, np.float64)
    up = max(float(towards[1]), 0.0)
    # Half bleached: what comes out of the shade of a cloud is the sun's light, too, of many turns.
    above = whitened(0.74 * zenith + 0.16 * horizon)
    # Ground lit by sun and sky, and the bright air between.
    below = ground * (0.55 * sun * up + 0.35 * zenith) + whitened(0.20 * horizon + 0.18 * zenith)
    plain = 0.45 * zenith + 0.15 * horizon + 0.15 * ground
    by_height = np.tile(sun, (LEVELS, 1)) if suns is None else np.asarray(suns, np.float64)
    return Surround(towards, sun, above, below, plain, by_height)


FOOT = 2600.0  # m of a tower that count as its base
OVERLAP = 1.3  # seeds in which a ray is at once
FLASH_SHADE = 0.8  # of lightning's light, on what is turned from the sun


def near_flash(p: Array, places: Array, colors: Array) -> Array:
    """Light of lightning at places p (..., 3) from the camera, m.

    places, colors: (m, 4) as `gpu.flash.cloud_lights` has them.
    """
    total = np.zeros_like(p)
    for place, color in zip(places, colors, strict=True):
        u = 1.0 + ((p - place[:3]) ** 2).sum(-1, keepdims=True) * place[3]
        total = total + color[:3] * u**-1.5
    return total


@dataclass(frozen=True, slots=True)
class Body:
    """What a cloud's light needs to know of it."""

    half_size: Array  # (3,) m
    base: float  # m, of its underside from its centre
    darkness: float = 0.0
    flash: float = 0.0
    thick: float = 0.0  # 1/m, what a way through it adds to what is absorbed
    height: float = 0.0  # m, of its centre over the ground
    shaded: tuple[float, float] = (0.0, 0.0)  # what others take of the sun's light, and the sky's


@dataclass(frozen=True, slots=True)
class Lit:
    """Light at vertices, linear RGB (..., 3) and shares (...,)."""

    lit: Array  # of what faces the sun
    shade: Array  # of what is turned from it
    rim: Array  # that shines through where the cloud is thin
    facing: Array  # 0 to 1: which of the first two the vertex itself shows
    relief: Array  # how much an image's own relief adds to that
    soft: Array  # 0 to 1: how soft the image's outline is


def full_light(
    v: Array,
    s: Array,
    w: Array,
    a: Array,
    body: Body,
    light: Surround,
    look: tuple[float, float, float] = (1.0, 1.0, 1.0),
) -> Lit:
    """The light of a cloud with lining, dark base, sky and ground; look: strengths of lining,
    bases and ambient. The sun comes in by the absorption `a`, as in the plain model.
    """
    silver, bases, ambience = look
    q = v / body.half_size
    whole, own = q / body.half_size, v - s
    n = 0.42 * whole / np.maximum(_length(whole), 1e-9)
    n = n + 0.50 * own / np.maximum(_length(own), 1e-3) - 0.36 * w
    n = n / np.maximum(_length(n), 1e-6)
    high = 2.0 * body.half_size[1]
    rise = np.clip((v[..., 1] - body.base) / min(high, FOOT), 0.0, 1.0)
    towards = n @ light.direction
    a = np.clip(a - 0.6 * body.thick * (own @ light.direction), 0.0, 1.0)
    under_top = np.maximum(high + body.base - v[..., 1], 0.0) / max(light.direction[1], 0.15)
    a = np.minimum(a, OVERLAP * body.thick * under_top)
    through = np.exp(-0.75 * a)

    up = 0.5 + 0.5 * n[..., 1]
    up = (up * up * (3.0 - 2.0 * up))[..., None]
    ambient = light.below * (1.0 - up) + light.above * up
    ambient = ambient * (ambience * (0.62 + 0.38 * rise))[..., None]
    deep = bases * (0.30 + 0.70 * body.darkness)
    under = 1.0 - deep * (1.0 - smoothstep(0.0, 0.55, rise)) * 0.62
    gloom = 1.0 - 0.38 * body.darkness * bases * (1.0 - 0.9 * smoothstep(0.4, 1.0, rise))
    dim = (under * gloom)[..., None]

    here = sun_at(light.suns, body.height + v[..., 1]) * (1.0 - body.shaded[0])
    sun = here * through[..., None]
    ahead = w @ light.direction
    forward = 0.16 * (0.5 + 0.5 * ahead) ** 6 + 0.7 * np.maximum(ahead, 0.0) ** 24
    ambient = ambient * (1.0 - body.shaded[1])
    # A low sun shines under the base.
    sunny = dim + (1.0 - dim) * (1.0 - float(smoothstep(0.02, 0.30, light.direction[1])))
    lit = sun * (0.92 + 0.08 * towards)[..., None] * sunny + ambient * dim
    shade = sun * (0.22 + 0.06 * towards)[..., None] * sunny + 0.95 * ambient * dim
    facing = np.clip(0.60 + 0.58 * towards - 0.28 * a, 0.0, 1.0)

    aside = q - w * (q * w).sum(-1, keepdims=True)
    edge = smoothstep(0.50, 1.0, _length(aside)[..., 0])
    rim = (silver * forward * (0.08 + 0.92 * edge) * (1.0 - 0.5 * a))[..., None] * here

    inside = np.maximum(1.0 - 0.55 * (q * q).sum(-1), 0.12)[..., None]
    flash = body.flash * inside * np.array([0.86, 0.90, 1.0])
    relief = (0.62 - 0.38 * a) * (0.45 + 0.55 * rise)
    soft = 0.75 * (1.0 - rise) ** 2
    return Lit(lit + flash, shade + FLASH_SHADE * flash, rim, facing, relief, soft)


def _length(x: Array) -> Array:
    length: Array = np.linalg.norm(x, axis=-1, keepdims=True)
    return length


def haze_share(center: Array, camera_height: float, extinction: float) -> Array:
    """0 to 1, (n,): how far the air between hides clouds; center (n, 3) from the camera.

    Beer and Lambert along the line of sight through air whose extinction falls with height as
    exp(-h / H), in closed form; fog and rain lie lower than clean air's haze.
    """
    away = np.maximum(np.linalg.norm(center, axis=1), 1e-6)
    rise = center[:, 1]
    depth = np.zeros(len(center))
    clean = min(extinction, CLEAN)
    for part, height in ((clean, CLEAN_HEIGHT), (extinction - clean, FOG_HEIGHT)):
        x = np.clip(rise / height, -50.0, 50.0)
        small = np.abs(x) < 1e-6
        mean = np.where(small, 1.0, -np.expm1(-x) / np.where(small, 1.0, x))
        depth += part * np.exp(-min(max(camera_height, 0.0) / height, 50.0)) * mean * away
    return -np.expm1(-np.minimum(depth, 50.0))


def haze_color(center: Array, horizon: ArrayLike, zenith: ArrayLike, light: Surround) -> Array:
    """Linear RGB, (n, 3), of the air before clouds: the horizon's, brighter towards the sun."""
    away = np.maximum(np.linalg.norm(center, axis=1), 1e-6)
    sine = np.clip(center[:, 1] / away, 0.0, 1.0)[:, None]
    mixed = np.asarray(horizon) * (1.0 - 0.5 * sine) + np.asarray(zenith) * 0.5 * sine
    ahead = np.maximum(center @ light.direction / away, 0.0)[:, None]
    return mixed + light.sun * (0.10 * ahead**4 + 0.18 * ahead**32)


def depth_inside(eye: Array, centers: NDArray, sizes: NDArray) -> tuple[float, int]:
    """0 to 1, how deep a place (3,) is in the boxes (s, 3), rising smoothly from their ellipsoids'
    surfaces; and the box in which it is deepest.
    """
    reach = np.linalg.norm((eye - centers) / (0.5 * np.maximum(sizes, 1e-6)), axis=1)
    box = int(np.argmin(reach))
    return float(smoothstep(0.0, 0.6, 1.0 - reach[box])), box


def inside_light(
    light: Surround, a: float, ambience: float, darkness: float, height: float = 0.0
) -> Array:
    """Linear RGB (3,) of the white within a cloud: light from all round, less where it is deep."""
    color: Array = ambience * (0.55 * light.above + 0.45 * light.below)
    color = color + sun_at(light.suns, height) * (0.74 * np.exp(-1.1 * a))
    return color * (1.0 - 0.38 * darkness)
