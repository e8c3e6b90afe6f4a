"""Meshes packed for the GPU, and which of them the camera sees."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from demo_game.place.mesh import Mesh

CELL = 32.0  # m, side of the pieces that wide meshes are cut into
VERTEX_DTYPE = np.dtype(
    [("position", "f4", 3), ("normal", "i1", 4), ("color", "u1", 4), ("extra", "u1", 4),
     ("uv", "f2", 2)]
)  # fmt: skip
VERTEX_FORMAT = "3f4 4i1 4f1 4f1 2f2"
VERTEX_NAMES = ("in_position", "in_normal", "in_color", "in_extra", "in_uv")
PLAIN_FORMAT = "3f4 4i1 4f1 4f1 4x1"  # for programs without grain
PLAIN_NAMES = VERTEX_NAMES[:4]


def _byte(values: NDArray, scale: float = 255.0) -> NDArray:
    return np.clip(np.round(np.asarray(values) * scale), 0, 255).astype("u1")


def pack(mesh: Mesh) -> NDArray:
    """(n,) VERTEX_DTYPE of a mesh."""
    out = np.zeros(len(mesh.vertices), VERTEX_DTYPE)
    out["position"] = mesh.vertices
    out["normal"][:, :3] = np.round(mesh.normals * 127.0)
    out["normal"][:, 3] = np.round(np.clip(mesh.sway, 0.0, 1.0) * 127.0)
    out["color"][:, :3] = _byte(np.sqrt(np.clip(mesh.colors, 0.0, 1.0)))
    out["color"][:, 3] = _byte(mesh.ambient)
    out["extra"][:, 0] = mesh.material
    out["extra"][:, 1] = mesh.part
    out["extra"][:, 2] = _byte(mesh.lamp, 255.0 / 4.0)
    out["uv"] = mesh.uvs
    return out


@dataclass(frozen=True)
class Pieces:
    """Triangle ranges of one index buffer with their boxes."""

    indices: NDArray  # (m, 3) u4, sorted by piece
    ranges: NDArray  # (p, 2) first index, indices
    low: NDArray  # (p, 3) m
    high: NDArray


def cut(mesh: Mesh) -> Pieces:
    """A mesh's triangles by cells of the ground, where the mesh is wider than a cell."""
    low, high = mesh.bounds
    triangles = mesh.indices
    if max(high[0] - low[0], high[2] - low[2]) > CELL:
        middle = mesh.vertices[triangles].mean(1)
        key = np.floor(middle[:, [0, 2]] / CELL).astype("i8") @ (4096, 1)
        order = np.argsort(key, kind="stable")
        triangles, key = triangles[order], key[order]
        starts = np.flatnonzero(np.diff(key, prepend=key[0] - 1))
    else:
        starts = np.array([0])
    counts = np.diff(np.append(starts, len(triangles)))
    boxes = [mesh.vertices[triangles[s : s + c]] for s, c in zip(starts, counts, strict=True)]
    lows = np.array([b.min((0, 1)) for b in boxes])
    highs = np.array([b.max((0, 1)) for b in boxes])
    return Pieces(triangles, np.stack([starts, counts], 1) * 3, lows, highs)


def frustum_planes(
    view_projection: NDArray, frame: tuple[float, float, float, float] = (-1.0, -1.0, 1.0, 1.0)
) -> NDArray:
    """(5, 4) planes whose positive side is seen: left, right, bottom, top, near; normals unit.

    frame: left, bottom, right, top of the picture's part that counts, -1 to 1.
    """
    m, (left, bottom, right, top) = view_projection, frame
    sides = m[0] - left * m[3], right * m[3] - m[0], m[1] - bottom * m[3], top * m[3] - m[1]
    planes = np.stack([*sides, m[3] + m[2]])
    return planes / np.linalg.norm(planes[:, :3], axis=1, keepdims=True)


def boxes_seen(planes: NDArray, low: NDArray, high: NDArray) -> NDArray:
    """(n,) whether boxes may be seen."""
    middle, half = (low + high) * 0.5, (high - low) * 0.5
    reach = middle @ planes[:, :3].T + planes[:, 3] + half @ np.abs(planes[:, :3]).T
    return (reach > 0.0).all(axis=1)


def box_distance(point: NDArray, low: NDArray, high: NDArray) -> NDArray:
    """(n,) distance of a point from boxes, m."""
    return np.linalg.norm(np.maximum(np.maximum(low - point, point - high), 0.0), axis=1)
