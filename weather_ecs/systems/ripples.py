"""`RippleList`: the water surfaces as the GPU is told of them, and as what catches the rain."""

from __future__ import annotations

import math
from operator import is_
from weakref import WeakKeyDictionary

import numpy as np
from numpy.typing import NDArray

from weather_ecs.components import RippleSurface
from weather_ecs.frame import OccluderData, RippleData
from weather_ecs.systems.queries import alive
from weather_ecs.systems.state import WeatherState

_RIM = 48  # corners of an ellipse
_HERE = np.eye(4)
_HERE.setflags(write=False)


class RippleList:
    """One `RippleData` for each surface, and the level face that rain falls on.

    Both are made again only where that surface has changed: captures go by their identity.
    """

    def __init__(self) -> None:
        self.surfaces: tuple[RippleData, ...] = ()
        self._faces: tuple[OccluderData, ...] = ()
        self._known: WeakKeyDictionary[RippleSurface, tuple[RippleData, OccluderData]] = (
            WeakKeyDictionary()
        )
        self._given: tuple[OccluderData, ...] = ()
        self._all: tuple[OccluderData, ...] = ()

    def collect(self, state: WeatherState) -> None:
        """Take the living surfaces over."""
        found = alive(RippleSurface, state.uids)
        parts = [self._of(uid, surface) for uid, surface in found]
        surfaces = tuple([data for data, _ in parts])
        catching = [surface.catches_rain for _, surface in found]
        faces = tuple([face for (_, face), catches in zip(parts, catching, strict=True) if catches])
        if not _same(surfaces, self.surfaces):
            self.surfaces = surfaces
        if not _same(faces, self._faces):
            self._faces = faces
            self._all = self._given + faces

    def with_faces(self, occluders: tuple[OccluderData, ...]) -> tuple[OccluderData, ...]:
        """`occluders` and the surfaces' own; the same tuple as before where nothing has changed."""
        if occluders is not self._given:
            self._given, self._all = occluders, occluders + self._faces
        return self._all if self._faces else occluders

    def find(self, surface: RippleSurface) -> RippleData | None:
        """What a surface was taken over as, while it lives."""
        data = self._known.get(surface, (None, None))[0]
        return data if any(data is known for known in self.surfaces) else None

    def _of(self, uid: int, surface: RippleSurface) -> tuple[RippleData, OccluderData]:
        data = RippleData(
            uid,
            surface.center,
            surface.size,
            surface.heading,
            surface.shape == "ellipse",
            surface.cell,
            surface.speed,
            surface.damping,
            surface.amplitude,
            surface.color,
            surface.clarity,
            surface.draw,
        )
        known = self._known.get(surface)
        if known is not None and known[0] == data:
            return known
        if known is not None and _place(known[0]) == _place(data):
            face = known[1]
        else:
            vertices, indices = _face(data)
            # The game's own occluders count their keys from 0 up.
            face = OccluderData(-1 - uid, _HERE, False, vertices, indices)
        self._known[surface] = (data, face)
        return data, face


def _place(data: RippleData) -> tuple[object, ...]:
    return data.key, data.center, data.size, data.heading, data.ellipse


def _face(data: RippleData) -> tuple[NDArray[np.float32], NDArray[np.uint32]]:
    """The surface as triangles round its first corner."""
    if data.ellipse:
        turn = np.arange(_RIM) * (2.0 * math.pi / _RIM)
        corners = np.stack([np.cos(turn), np.sin(turn)], axis=1)
    else:
        corners = np.array([(1.0, 1.0), (-1.0, 1.0), (-1.0, -1.0), (1.0, -1.0)])
    u, w = (corners * data.size * 0.5).T
    cos, sin = math.cos(data.heading), math.sin(data.heading)
    x, y, z = data.center
    vertices = np.stack([x + u * cos + w * sin, np.full_like(u, y), z - u * sin + w * cos], axis=1)
    last = np.arange(2, len(corners), dtype=np.uint32)
    indices = np.stack([np.zeros_like(last), last - 1, last], axis=1).reshape(-1)
    result = vertices.astype(np.float32)
    for array in (result, indices):
        array.setflags(write=False)
    return result, indices


def _same(one: tuple[object, ...], other: tuple[object, ...]) -> bool:
    return len(one) == len(other) and all(map(is_, one, other))
