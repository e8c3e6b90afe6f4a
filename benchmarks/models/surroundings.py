"""What a game may put about the observer: further areas, observers, and houses that rain hits."""

from __future__ import annotations

import math

import numpy as np

from weather_ecs.components import Observer, Occluder, RainArea

# The stage's camera stands at the origin and looks along -z.
RADII = (30.0, 20.0)  # m
NEAREST = 120.0  # m; no area reaches into another's container


def areas_behind(n: int) -> list[RainArea]:
    """Small showers at the observer's back."""
    return _areas(n, math.pi)


def areas_in_view(n: int) -> list[RainArea]:
    """Small showers ahead."""
    return _areas(n, 0.0)


def _areas(n: int, middle: float) -> list[RainArea]:
    """In rows that fan out over 60 degrees about the direction `middle`, from -z."""
    areas = []
    for i in range(n):
        row, place = divmod(i, 8)
        angle = middle + math.radians(-30.0 + 60.0 * place / 7.0)
        away = NEAREST + 60.0 * row
        center = (away * math.sin(angle), -away * math.cos(angle))
        areas.append(RainArea(center=center, radii=RADII, rain_rate=5.0))
    return areas


def observers(n: int) -> list[Observer]:
    """At the stage's camera: its picture is drawn n times."""
    return [Observer(position=(0.0, 1.7, 0.0)) for _ in range(n)]


def houses(n: int) -> list[Occluder]:
    """Boxes on the ground about the observer, none of them moving; each is an Occluder."""
    corners = np.array([(x, y, z) for x in (-1, 1) for y in (0, 1) for z in (-1, 1)], "f4")
    quads = [(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)]
    indices = np.array([(a, b, c, a, c, d) for a, b, c, d in quads], "u4").ravel()
    rng = np.random.default_rng(4)
    found = []
    for _ in range(n):
        transform = np.diag([*rng.uniform((0.5, 1.0, 0.5), (1.5, 4.0, 1.5)), 1.0])
        angle, away = rng.uniform(0.0, 2.0 * math.pi), rng.uniform(6.0, 45.0)
        transform[:3, 3] = away * math.cos(angle), 0.0, away * math.sin(angle)
        found.append(Occluder(corners, indices, transform=transform))
    return found
