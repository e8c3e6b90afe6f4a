"""Splashes: what a drop's water does where the drop hits; the oracle of `shaders/splash*`.

A drop of diameter D that hits at speed v spreads to a radius of D We^(1/4) / 2 at most, with the
Weber number We = density v^2 D / surface tension (Clanet, Beguin, Richard and Quere 2004); a crown
widens with the root of its age (Yarin and Weiss 1995). Both are far too small and too quick to be
seen from a few metres, where a drop that is drawn stands for hundreds: what is drawn is larger by a
factor of the look, within a bound, and lasts as long as the look says. Droplets leave on parabolas.
"""

from __future__ import annotations

import math
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from .checks import FloatArray
from .drops import terminal_speed
from .fall import GRAVITY
from .words import hash_unit, hash_word

SURFACE_TENSION = 0.0728  # N/m, water in air at 20 degrees C
DENSITY = 1000.0  # kg/m3
FIRST = 0.25  # share of its radius that a crown begins with
SMALLEST, GREATEST = 0.3, 2.5  # factors on the size, of the least of the splashes and the most
RESPONSE = 0.2  # s: a droplet of half a millimetre takes on the air's speed
MOST = 5  # droplets of one splash
COMPANIONS = 6  # smaller splashes around one, at most
PLENTY = 3.0  # so many times as many are small as are full-grown
SCATTER = 0.8  # m that they lie off at most
NEAREST = 0.7  # factor on the size of a splash NEAR or closer; 1 FAR away
NEAR, FAR = 1.5, 8.0  # m
LONGEST = 0.5  # s that a droplet is seen at most


@dataclass(frozen=True, slots=True)
class SplashLaw:
    """What is the same for all splashes; see `components.SplashEmitter` for the fields."""

    size: float
    largest: float  # m
    duration: float  # s
    share: float
    droplets: float
    droplet_speed: float
    spread: float  # rad
    acceleration: tuple[float, float, float]  # m/s2, of the droplets


def acceleration(wind: tuple[float, float, float], drift: float) -> tuple[float, float, float]:
    """Of droplets, m/s2: gravity, and the pull of the air that they start at rest in."""
    pull = drift / RESPONSE
    return (wind[0] * pull, wind[1] * pull - GRAVITY, wind[2] * pull)


def weber(diameter: NDArray, speed: NDArray) -> FloatArray:
    """Inertia over surface tension of a drop (diameter in mm, speed in m/s)."""
    return DENSITY * speed**2 * diameter * 1e-3 / SURFACE_TENSION


def spread_radius(diameter: NDArray, speed: NDArray) -> FloatArray:
    """Greatest radius of the water of a drop on a surface, m: D We^(1/4) / 2."""
    return 0.5e-3 * diameter * weber(diameter, speed) ** 0.25


def stature(weight: NDArray, seed: NDArray, law: SplashLaw) -> FloatArray:
    """Factor on its size that a splash is shown with, SMALLEST to GREATEST.

    Of the real splashes that it stands for, `share` are conspicuous: where there are many of
    them it is large, where there may be one or none it often is small.
    """
    chance = np.maximum(hash_unit(bits(seed)).astype(np.float64), 1e-6)
    s = np.sqrt(weight * law.share / chance)
    return np.clip(np.where(s < 1.0, s, np.sqrt(s)), SMALLEST, GREATEST)


def crown_radius(
    diameter: NDArray, speed: NDArray, weight: NDArray, seed: NDArray, law: SplashLaw
) -> FloatArray:
    """Radius to which a crown opens as it is drawn, m."""
    radius = spread_radius(diameter, speed) * law.size * stature(weight, seed, law)
    return law.largest * -np.expm1(-radius / law.largest)


def near_size(away: NDArray) -> FloatArray:
    """Factor on its size that a splash so many m away has: they grow with distance, as drops do."""
    return NEAREST + (1.0 - NEAREST) * _smooth(NEAR, FAR, away)


def companions(weight: NDArray, seed: NDArray, law: SplashLaw) -> FloatArray:
    """How many smaller splashes a splash has around it: the small ones that it stands for."""
    chance = hash_unit(bits(seed) ^ np.uint32(0x165667B1)).astype(np.float64)
    return np.clip(np.floor(PLENTY * weight * law.share - 1.0 + chance), 0.0, COMPANIONS)


def companion(seed: NDArray, k: int, law: SplashLaw) -> tuple[FloatArray, FloatArray, FloatArray]:
    """Companion k: (n, 2) m along x and z off the hit, s later, and its own radius in m."""
    word = hash_word(bits(seed) + np.uint32(0x9E3779B9 * (k + 11) & 0xFFFFFFFF))
    turn = 2.0 * math.pi * hash_unit(word ^ np.uint32(0x27D4EB2F)).astype(np.float64)
    off = SCATTER * np.sqrt(hash_unit(word ^ np.uint32(0x85EBCA6B)).astype(np.float64))
    chance = hash_unit(word ^ np.uint32(0xC2B2AE35)).astype(np.float64)
    later = max(LONGEST - law.duration, 0.0) * chance
    place = np.stack([off * np.cos(turn), off * np.sin(turn)], axis=-1)
    diameter = 0.8 + 1.4 * hash_unit(word).astype(np.float64)
    radius = spread_radius(diameter, terminal_speed(diameter)) * law.size
    return place, later, law.largest * -np.expm1(-radius / law.largest)


def growth(x: NDArray) -> FloatArray:
    """Share of its radius that a splash has at the share x of its life."""
    return FIRST + (1.0 - FIRST) * np.sqrt(x)


def bits(seed: NDArray) -> NDArray[np.uint32]:
    return np.ascontiguousarray(seed, np.float32).view(np.uint32)


def tangents(normal: NDArray) -> tuple[FloatArray, FloatArray]:
    """Two unit vectors across each normal, (n, 3); the normals point upwards."""
    x, y = normal[:, 0], normal[:, 1]
    first = np.stack([y, -x, np.zeros_like(x)], axis=1)
    first /= np.linalg.norm(first, axis=1, keepdims=True)
    return first, np.cross(normal, first)


def launches(
    normal: NDArray, speed: NDArray, height: NDArray, seed: NDArray, k: int, law: SplashLaw
) -> tuple[FloatArray, NDArray[np.bool_]]:
    """Velocity (n, 3) of droplet k of each splash, m/s, and which splashes throw it.

    speed: the drop's, m/s; height: the splash's `stature`.
    """
    h = hash_word(bits(seed) + np.uint32(0x9E3779B9 * (k + 1) & 0xFFFFFFFF))
    a = hash_unit(h)
    b = hash_unit(h ^ np.uint32(0x85EBCA6B))
    c = hash_unit(h ^ np.uint32(0xC2B2AE35))
    number = np.floor(law.droplets + hash_unit(bits(seed) ^ np.uint32(0x27D4EB2F)))
    turn = (k + 0.8 * a) * (2.0 * math.pi / np.maximum(number, 1.0)) + 40.0 * seed
    tilt = law.spread * (0.35 + 0.65 * b)
    pace = speed * law.droplet_speed * (0.5 + 0.5 * c) * np.minimum(height, 1.0)
    first, second = tangents(normal)
    across = first * np.cos(turn)[:, None] + second * np.sin(turn)[:, None]
    way = normal * np.cos(tilt)[:, None] + across * np.sin(tilt)[:, None]
    return way * pace[:, None], k < number


def way(velocity: NDArray, age: NDArray, law: SplashLaw) -> FloatArray:
    """Where droplets are from the hit after `age`, (n, 3), m."""
    pull = np.asarray(law.acceleration)
    return velocity * age[:, None] + 0.5 * pull * (age * age)[:, None]


def landing(normal: NDArray, velocity: NDArray, law: SplashLaw) -> FloatArray:
    """Age at which droplets come back to the plane of the hit, s; LONGEST where they do not."""
    fall = normal @ np.asarray(law.acceleration)
    rise = (normal * velocity).sum(axis=1)
    back = np.where(fall < 0.0, -2.0 * rise / np.minimum(fall, -1e-6), LONGEST)
    return np.minimum(back, LONGEST)


def opacities(
    weight: NDArray, depth: NDArray, pixels: NDArray, facing: NDArray, opacity: float, detail: float
) -> tuple[FloatArray, FloatArray]:
    """Of crowns, and of films and droplets, before the texture and age take their share.

    depth: m in front of the camera; pixels: of the crown's radius; facing: cosine of the angle
    between the way to the camera and the normal; detail: m.
    """
    whole = opacity * np.minimum(weight * 0.1, 1.0) * _smooth(0.2, 0.6, depth)
    crown = whole * np.minimum(pixels, 1.0) * (1.0 - _smooth(0.55, 0.92, np.abs(facing)))
    return crown, whole * (1.0 - _smooth(0.6 * detail, detail, depth))


def _smooth(low: float, high: float, x: NDArray) -> FloatArray:
    t = np.clip((x - low) / max(high - low, 1e-9), 0.0, 1.0)
    return t * t * (3.0 - 2.0 * t)
