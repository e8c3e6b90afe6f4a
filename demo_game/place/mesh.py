"""Meshes of the place and the builder that makes them from boxes, tubes and quads."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from numpy.typing import ArrayLike, NDArray

WOOD, STONE, LEAF, PLAIN, GLOW = range(5)  # material: channel of the detail texture, or light


def rgb(code: int) -> NDArray:
    """Linear RGB of a display colour written 0xRRGGBB."""
    c = np.array([code >> 16 & 255, code >> 8 & 255, code & 255], "f8") / 255.0
    return np.where(c <= 0.04045, c / 12.92, ((c + 0.055) / 1.055) ** 2.4)


@dataclass(frozen=True)
class Mesh:
    """Triangles with what the shaders need at each vertex; winding is counter-clockwise."""

    vertices: NDArray  # (n, 3) f4, m
    normals: NDArray  # (n, 3) f4, unit
    colors: NDArray  # (n, 3) f4, linear albedo
    uvs: NDArray  # (n, 2) f4, m along the surface, wood grain runs along u
    material: NDArray  # (n,) u1
    part: NDArray  # (n,) u1, index of the moving part
    sway: NDArray  # (n,) f4, 0..1, how far wind bends the vertex
    ambient: NDArray  # (n,) f4, 0..1, share of the sky it sees
    lamp: NDArray  # (n,) f4, lamp light received, 1 = one metre and a half under a lamp
    indices: NDArray  # (m, 3) u4
    dynamic: bool = False

    @property
    def bounds(self) -> tuple[NDArray, NDArray]:
        """Lowest and highest corner, m."""
        return self.vertices.min(0), self.vertices.max(0)

    def moved(self, transform: ArrayLike) -> Mesh:
        """The mesh under a rigid (4, 4) transform times a uniform scale."""
        m = np.asarray(transform, "f8")
        normals = self.normals @ m[:3, :3].T
        normals /= np.linalg.norm(normals, axis=1, keepdims=True)
        vertices = self.vertices @ m[:3, :3].T + m[:3, 3]
        return replace(self, vertices=vertices.astype("f4"), normals=normals.astype("f4"))


def merge(meshes: Sequence[Mesh], dynamic: bool = False) -> Mesh:
    """One mesh of many."""
    offsets = np.cumsum([0] + [len(m.vertices) for m in meshes])
    names = "vertices normals colors uvs material part sway ambient lamp".split()
    fields = {name: np.concatenate([getattr(m, name) for m in meshes]) for name in names}
    indices = [m.indices + np.uint32(o) for m, o in zip(meshes, offsets, strict=False)]
    return Mesh(**fields, indices=np.concatenate(indices).astype("u4"), dynamic=dynamic)


def yaw_matrix(angle: float) -> NDArray:
    """(3, 3) rotation about +y, counter-clockwise seen from above."""
    c, s = np.cos(angle), np.sin(angle)
    return np.array([[c, 0.0, s], [0.0, 1.0, 0.0], [-s, 0.0, c]])


def axis_matrix(axis: ArrayLike, angle: float) -> NDArray:
    """(3, 3) rotation about any axis (Rodrigues)."""
    x, y, z = np.asarray(axis, "f8") / np.linalg.norm(axis)
    k = np.array([[0, -z, y], [z, 0, -x], [-y, x, 0]])
    return np.eye(3) + np.sin(angle) * k + (1.0 - np.cos(angle)) * k @ k


def placed(rotation: ArrayLike, position: ArrayLike) -> NDArray:
    """(4, 4) transform of a rotation and a position."""
    m = np.eye(4)
    m[:3, :3] = rotation
    m[:3, 3] = position
    return m


_CORNERS = np.array([[i, j, k] for i in (-1, 1) for j in (-1, 1) for k in (-1, 1)], "f8")
# four corners counter-clockwise seen from outside
_FACES = {
    "-x": [0, 1, 3, 2],
    "+x": [4, 6, 7, 5],
    "-y": [0, 4, 5, 1],
    "+y": [2, 3, 7, 6],
    "-z": [0, 2, 6, 4],
    "+z": [1, 5, 7, 3],
}


class Builder:
    """Collects faces; `build` returns the mesh."""

    def __init__(self, seed: int = 0) -> None:
        self.random = np.random.default_rng(seed)
        self._rows: list[tuple[NDArray, ...]] = []
        self._indices: list[NDArray] = []
        self._count = 0
        self.part = 0  # given to every face added from here on
        self.sway = 0.0

    def faces(
        self,
        points: ArrayLike,
        indices: ArrayLike,
        color: ArrayLike,
        *,
        normals: ArrayLike | None = None,
        uvs: ArrayLike | None = None,
        material: int = PLAIN,
        ambient: ArrayLike = 1.0,
        sway: ArrayLike | None = None,
    ) -> None:
        """Triangles on (n, 3) points; without normals they are taken from the triangles."""
        p = np.asarray(points, "f8")
        t = np.asarray(indices, "i8").reshape(-1, 3)
        n = len(p)
        if normals is None:
            flat = np.cross(p[t[:, 1]] - p[t[:, 0]], p[t[:, 2]] - p[t[:, 0]])
            normal = np.zeros_like(p)
            for k in range(3):
                np.add.at(normal, t[:, k], flat)
        else:
            normal = np.broadcast_to(np.asarray(normals, "f8"), (n, 3)).copy()
        length = np.linalg.norm(normal, axis=1, keepdims=True)
        normal = np.where(length > 1e-12, normal / np.maximum(length, 1e-12), (0.0, 1.0, 0.0))
        bend = self.sway if sway is None else sway
        self._rows.append(
            (
                p,
                normal,
                np.broadcast_to(color, (n, 3)),
                p[:, :2] if uvs is None else np.asarray(uvs, "f8"),
                np.full(n, material, "u1"),
                np.full(n, self.part, "u1"),
                np.broadcast_to(np.asarray(bend, "f8"), (n,)),
                np.broadcast_to(np.asarray(ambient, "f8"), (n,)),
            )
        )
        self._indices.append(t + self._count)
        self._count += n

    def quad(
        self, corners: ArrayLike, color: ArrayLike, material: int = PLAIN, cuts: int = 1
    ) -> None:
        """A flat quad, corners counter-clockwise, cut `cuts` times along its first side."""
        a, b, c, d = np.asarray(corners, "f8")
        s = np.linspace(0.0, 1.0, cuts + 1)[:, None]
        points = np.stack([a + (b - a) * s, d + (c - d) * s], 1).reshape(-1, 3)
        k = np.arange(cuts)[:, None] * 2
        indices = np.concatenate([k + (0, 2, 3), k + (0, 3, 1)])
        u = np.linalg.norm(b - a) * s
        v = np.linalg.norm(d - a)
        uvs = np.stack([np.hstack([u, 0 * u]), np.hstack([u, 0 * u + v])], 1).reshape(-1, 2)
        self.faces(points, indices, color, uvs=uvs + self.random.random(2), material=material)

    def box(
        self,
        center: ArrayLike,
        size: ArrayLike,
        color: ArrayLike,
        *,
        rotation: NDArray | None = None,
        material: int = WOOD,
        skip: str = "",
        vary: float = 0.06,
        cuts: int = 1,
    ) -> None:
        """A box; `skip` names faces left out ("-y +x"); `vary` spreads its brightness."""
        half = np.asarray(size, "f8") / 2.0
        turn = np.eye(3) if rotation is None else rotation
        tint = np.asarray(color, "f8") * (1.0 + vary * self.random.uniform(-1.0, 1.0))
        corners = (_CORNERS * half) @ turn.T + np.asarray(center, "f8")
        for name, ring in _FACES.items():
            if name in skip:
                continue
            quad = corners[ring]
            sides = np.linalg.norm(quad[1] - quad[0]), np.linalg.norm(quad[2] - quad[1])
            if sides[1] > sides[0]:  # the first side is the long one: grain and cuts follow it
                quad = np.roll(quad, -1, axis=0)
            self.quad(quad, tint, material, cuts)

    def tube(
        self,
        start: ArrayLike,
        end: ArrayLike,
        radii: tuple[float, float],
        color: ArrayLike,
        *,
        sides: int = 6,
        material: int = WOOD,
        caps: bool = False,
        ambient: tuple[float, float] = (1.0, 1.0),
    ) -> None:
        """A round bar between two points."""
        a, b = np.asarray(start, "f8"), np.asarray(end, "f8")
        along = (b - a) / np.linalg.norm(b - a)
        side = np.cross(along, (0.0, 0.0, 1.0) if abs(along[2]) < 0.9 else (1.0, 0.0, 0.0))
        side /= np.linalg.norm(side)
        angle = np.linspace(0.0, 2.0 * np.pi, sides + 1)
        ring = np.cos(angle)[:, None] * side + np.sin(angle)[:, None] * np.cross(along, side)
        points = np.concatenate([a + ring * radii[0], b + ring * radii[1]])
        k = np.arange(sides)[:, None]
        n = sides + 1
        indices = np.concatenate([k + (0, 1, n + 1), k + (0, n + 1, n)])
        v = angle * max(radii)
        length = np.linalg.norm(b - a)
        uvs = np.concatenate([np.stack([0 * v, v], 1), np.stack([0 * v + length, v], 1)])
        shade = np.repeat(ambient, n)
        normals = np.concatenate([ring, ring])
        self.faces(
            points, indices, color, normals=normals, uvs=uvs, material=material, ambient=shade
        )
        if caps:
            for base, radius, way in ((a, radii[0], -1.0), (b, radii[1], 1.0)):
                if radius > 0.0:
                    disc = base + ring[:-1] * radius
                    fan = np.array([[0, i, i + 1] for i in range(1, sides - 1)])
                    fan = fan if way > 0 else fan[:, ::-1]
                    self.faces(disc, fan, color, normals=along * way, material=material)

    def add(self, mesh: Mesh) -> None:
        """A finished mesh, part index replaced by the builder's."""
        n = len(mesh.vertices)
        rows = (mesh.vertices, mesh.normals, mesh.colors, mesh.uvs, mesh.material)
        self._rows.append((*rows, np.full(n, self.part, "u1"), mesh.sway, mesh.ambient))
        self._indices.append(mesh.indices.astype("i8") + self._count)
        self._count += n

    def build(self, dynamic: bool = False) -> Mesh:
        """The mesh of all faces added."""
        p, n, c, uv, material, part, sway, ambient = (
            np.concatenate(column) for column in zip(*self._rows, strict=True)
        )
        return Mesh(
            p.astype("f4"),
            n.astype("f4"),
            c.astype("f4"),
            uv.astype("f4"),
            material,
            part,
            sway.astype("f4"),
            ambient.astype("f4"),
            np.zeros(len(p), "f4"),
            np.concatenate(self._indices).astype("u4"),
            dynamic,
        )
