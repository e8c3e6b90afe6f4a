"""Boulders, and the sphere that rocks and crowns are cut from."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from . import palette
from .mesh import STONE, Builder, Mesh

_OCTA = np.array([[1, 0, 0], [-1, 0, 0], [0, 1, 0], [0, -1, 0], [0, 0, 1], [0, 0, -1]], "f8")
_OCTA_FACES = np.array(
    [[2, 4, 0], [2, 0, 5], [2, 5, 1], [2, 1, 4], [3, 0, 4], [3, 5, 0], [3, 1, 5], [3, 4, 1]]
)


def sphere(cuts: int) -> tuple[NDArray, NDArray]:
    """Points and triangles of an octahedron halved `cuts` times."""
    points, faces = _OCTA, _OCTA_FACES
    for _ in range(cuts):
        a, b, c = points[faces[:, 0]], points[faces[:, 1]], points[faces[:, 2]]
        new = np.concatenate([a, b, c, a + b, b + c, c + a]).round(6)
        new /= np.linalg.norm(new, axis=1, keepdims=True)
        i, j, k, ij, jk, ki = np.arange(len(new)).reshape(6, -1)
        corner = np.concatenate([
            np.stack(t, 1) for t in ((i, ij, ki), (ij, j, jk), (ki, jk, k), (ij, jk, ki))
        ])  # fmt: skip
        points, back = np.unique(new.round(6), axis=0, return_inverse=True)
        faces = back.reshape(-1)[corner]
    return points, faces


def rock(seed: int, cuts: int = 2) -> Mesh:
    """A boulder about one metre across, flattened, half buried."""
    rng = np.random.default_rng(seed)
    build = Builder(seed)
    points, faces = sphere(cuts)
    shape = np.ones(len(points))
    for _ in range(7):  # planes that cut pieces off
        normal = rng.normal(0, 1, 3)
        normal /= np.linalg.norm(normal)
        reach = points @ normal
        shape = np.minimum(shape, np.where(reach > 0, rng.uniform(0.62, 0.9) / reach, 9.0))
    points = points * shape[:, None] * (0.55, 0.38, 0.5)
    color = palette.STONE_COOL if seed % 2 else palette.STONE_WARM
    low = np.clip(0.45 + 1.6 * (points[:, 1] + 0.15), 0.35, 1.0)
    flat = points[faces].reshape(-1, 3)
    shade = np.repeat(1.0 + 0.08 * rng.uniform(-1, 1, len(faces)), 3)[:, None]
    build.faces(
        flat,
        np.arange(len(flat)),
        color * shade,
        uvs=flat[:, [0, 2]] * 0.8 + flat[:, 1:2],
        material=STONE,
        ambient=low[faces].reshape(-1),
    )
    return build.build()
