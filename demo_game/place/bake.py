"""Sky light and lamp light at vertices, by rays against solid blocks."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import numpy as np
from numpy.typing import NDArray

from .cabin_solid import Block
from .mesh import Mesh

LAMP_SOFTNESS = 1.1  # m, keeps the light under a lamp finite


def blocked(
    origins: NDArray, directions: NDArray, blocks: Sequence[Block], reach: NDArray | float
) -> NDArray:
    """(n,) whether each ray meets a block between 2 cm and `reach` metres."""
    hit = np.zeros(len(origins), bool)
    points, ways = origins.astype("f4"), directions.astype("f4")
    for block in blocks:
        turn, half = block.rotation.astype("f4"), (block.size / 2.0).astype("f4")
        local = (points - block.center.astype("f4")) @ turn
        way = ways @ turn
        pace = np.float32(1.0) / np.where(np.abs(way) < 1e-6, np.float32(1e-6), way)
        middle, width = -local * pace, half * np.abs(pace)
        low, high = middle - width, middle + width
        enter = np.maximum(np.maximum(low[:, 0], low[:, 1]), low[:, 2])
        leave = np.minimum(np.minimum(high[:, 0], high[:, 1]), high[:, 2])
        hit |= (leave > np.maximum(enter, 0.02)) & (enter < reach)
    return hit


def hemisphere(count: int) -> NDArray:
    """(count, 3) directions about +z, as many as the cosine weighs (golden spiral)."""
    k = np.arange(count) + 0.5
    radius, angle = np.sqrt(k / count), k * 2.399963
    return np.stack([radius * np.cos(angle), radius * np.sin(angle), np.sqrt(1 - k / count)], 1)


def sky_seen(points: NDArray, normals: NDArray, blocks: Sequence[Block], rays: int = 32) -> NDArray:
    """(n,) cosine-weighted share of the half sphere above each point that is open."""
    helper = np.where(np.abs(normals[:, 1:2]) < 0.9, (0.0, 1.0, 0.0), (1.0, 0.0, 0.0))
    side = np.cross(helper, normals)
    side /= np.linalg.norm(side, axis=1, keepdims=True)
    other = np.cross(normals, side)
    origins = points + normals * 0.04
    seen = np.zeros(len(points))
    for x, y, z in hemisphere(rays):
        way = side * x + other * y + normals * z
        seen += ~blocked(origins, way, blocks, 30.0)
    return seen / rays


def lamp_light(
    points: NDArray, normals: NDArray, lamps: Sequence[tuple], blocks: Sequence[Block]
) -> NDArray:
    """(n,) light of lamps (position (3,), strength), 1 at LAMP_SOFTNESS below a lamp of 1."""
    total = np.zeros(len(points))
    origins = points + normals * 0.04
    for position, strength in lamps:
        to = np.asarray(position, "f8") - points
        distance = np.linalg.norm(to, axis=1)
        near = distance < 16.0 * np.sqrt(strength)
        if not near.any():
            continue
        way = to[near] / np.maximum(distance[near, None], 1e-6)
        facing = np.clip(np.sum(way * normals[near], axis=1) * 0.75 + 0.25, 0.0, 1.0)
        light = strength * 2.0 * LAMP_SOFTNESS**2 * facing
        light = light / (distance[near] ** 2 + LAMP_SOFTNESS**2)
        if blocks:
            reach = np.maximum(distance[near] - 0.25, 0.0)
            light = np.where(blocked(origins[near], way, blocks, reach), 0.0, light)
        total[near] += light
    return total


def bake(mesh: Mesh, blocks: Sequence[Block], lamps: Sequence[tuple], bounce: float) -> Mesh:
    """The mesh with its sky and lamp light; `bounce` is the light no wall keeps out."""
    keys = np.concatenate([mesh.vertices, mesh.normals], 1).round(3)
    unique, back = np.unique(keys, axis=0, return_inverse=True)
    back = back.reshape(-1)
    points, normals = unique[:, :3].astype("f8"), unique[:, 3:].astype("f8")
    seen = sky_seen(points, normals, blocks)
    lamp = lamp_light(points, normals, lamps, blocks)
    ambient = mesh.ambient * (bounce + (1.0 - bounce) * seen[back])
    return replace(mesh, ambient=ambient.astype("f4"), lamp=lamp[back].astype("f4"))


def lamp_lit(mesh: Mesh, lamps: Sequence[tuple]) -> Mesh:
    """The mesh with the light of (position, colour, ...) lamps, nothing in their way."""
    pairs = [(lamp[0], max(lamp[1])) for lamp in lamps]
    light = lamp_light(mesh.vertices.astype("f8"), mesh.normals.astype("f8"), pairs, [])
    return replace(mesh, lamp=light.astype("f4"))
