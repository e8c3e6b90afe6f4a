"""`ShelterIndex`: whether something stands over a point, along the rain's fall; no OpenGL.

Answers for the collision heightmap where there is none: on a server, and for game code, which must
not wait for the GPU. Occluders are found by their boxes on the ground, carried along the fall to
the height 0, in grids of several cell sizes; then their triangles are asked
(`physics.heightfield`), which are got ready when somebody first asks, and again when their mesh or
the wind has turned.
Callback occluders draw on the GPU alone and are not seen here.
"""

from __future__ import annotations

import math
from math import floor

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import OccluderData
from weather_ecs.physics.heightfield import Facets, Piece, pieces
from weather_ecs.systems.box_grid import FINEST, BoxGrid, Near

MARGIN = 0.25  # m above a point from which on something counts as cover; walls do from it on
# Work is counted and not timed, so that a slow machine gives the same answers.
_CHEAP = 500  # pieces, about 1 ms; an update of more is made at most every _SOON seconds
_SOON = 0.1  # s of the weather's clock
_BUDGET = 400  # triangles, about 4 ms, of facets that an older version can stand in for
_KEPT = 4096  # facets that are remembered
_FEW = 24  # points that are quicker asked about one by one
_OVER_FINEST = 1.0 / FINEST


class ShelterIndex:
    """What keeps the rain off, ready for thousands of questions a frame."""

    def __init__(self) -> None:
        self._meshes = _Meshes()
        self._facets = _FacetStore()
        self._still = _Layer(self._meshes, self._facets)
        self._moving = _Layer(self._meshes, self._facets)
        self._layers = self._still, self._moving
        self._seen: tuple[OccluderData, ...] = ()
        self._slope = (0.0, 0.0)
        self._cost = 0  # pieces that the last update carried along
        self._made = -math.inf  # s, the weather's clock then
        self._told = -math.inf  # s, the weather's clock at the last update that was told
        self._waits = True  # whether the clock moves, so that what is put off comes about
        self._due: tuple[tuple[OccluderData, ...], tuple[float, float], float] | None = None

    def update(
        self, occluders: tuple[OccluderData, ...], slope: tuple[float, float], time: float
    ) -> None:
        """What the frame knows: taken over when somebody asks, so that a draw pays nothing."""
        self._waits, self._told = time != self._told, time
        self._due = (occluders, slope, time)

    def _catch_up(
        self, occluders: tuple[OccluderData, ...], slope: tuple[float, float], time: float
    ) -> None:
        if occluders is not self._seen or slope != self._slope:
            soon = abs(time - self._made) < _SOON
            if self._cost > _CHEAP and soon and self._waits:
                return
            self._facets.spent = 0
            solid = [o for o in occluders if o.vertices is not None]
            self._cost = self._still.update([o for o in solid if not o.dynamic], slope)
            self._cost += self._moving.update([o for o in solid if o.dynamic], slope)
            self._meshes.keep_used()
            self._seen, self._slope, self._made = occluders, slope, time
        self._due = None

    def covers(self, x: float, y: float, z: float) -> bool:
        """Whether something at least MARGIN above the point keeps the rain off it."""
        if self._due is not None:
            self._catch_up(*self._due)
        level = y + MARGIN
        u, w = x + y * self._slope[0], z + y * self._slope[1]
        place = floor(u * _OVER_FINEST), floor(w * _OVER_FINEST)
        for layer in self._layers:
            near = layer.known.get(place)
            if near is None:
                near = layer.grid.near(place)
            if near and near[0][0] > level and layer.covers(near, u, w, level):
                return True
        return False

    def many(self, x: NDArray, y: NDArray, z: NDArray) -> NDArray[np.bool_]:
        """`covers` for many points (n,)."""
        if self._due is not None:
            self._catch_up(*self._due)
        level = y + MARGIN
        u, w = x + y * self._slope[0], z + y * self._slope[1]
        covered = self._still.many(u, w, level)
        left = np.flatnonzero(~covered)
        covered[left] = self._moving.many(u[left], w[left], level[left])
        return covered


class _Meshes:
    """The pieces of every mesh in use, by the identity of its arrays and by its scale."""

    def __init__(self) -> None:
        self._known: dict[tuple[int, int, int], tuple[NDArray, NDArray, list[Piece]]] = {}
        self._used: set[tuple[int, int, int]] = set()

    def pieces(self, vertices: NDArray, indices: NDArray, exponent: int) -> list[Piece]:
        key = (id(vertices), id(indices), exponent)
        known = self._known.get(key)
        if known is None:
            # The arrays are kept too, so that no identity is used twice.
            known = (vertices, indices, pieces(vertices, indices, 2.0**exponent))
            self._known[key] = known
        self._used.add(key)
        return known[2]

    def keep_used(self) -> None:
        """Forget what nobody has asked for for a while."""
        if self._used and len(self._known) > 2 * len(self._used) + 64:
            self._known = {k: v for k, v in self._known.items() if k in self._used}
        self._used.clear()


class _FacetStore:
    """Facets by piece, turn and fall: what is only carried along, or shares a mesh, shares them."""

    def __init__(self) -> None:
        self._known: dict[tuple[Piece, bytes, tuple[float, float]], Facets] = {}
        self.spent = 0  # triangles made ready since the last update

    def get(
        self,
        piece: Piece,
        transform: NDArray,
        slope: tuple[float, float],
        before: Facets | None,
    ) -> tuple[Facets, bool]:
        """(facets, whether they are the ones asked for and not the ones before)."""
        turn = transform[:3, :3]
        key = (piece, turn.tobytes(), slope)
        known = self._known.get(key)
        if known is not None:
            return known, True
        if before is not None and self.spent > _BUDGET:
            return before, False
        known = self._known[key] = Facets(piece, turn, slope, MARGIN)
        if len(self._known) > _KEPT:
            self._known.pop(next(iter(self._known)))
        self.spent += len(piece.corners)
        return known, True


class _Layer:
    """Occluders in grids by their boxes; (u, w) are places carried along the fall to height 0."""

    def __init__(self, meshes: _Meshes, facets: _FacetStore) -> None:
        self._meshes = meshes
        self._store = facets
        self._occluders: list[OccluderData] = []
        self._slope = (0.0, 0.0)
        self._shape: list[tuple[int, int, int]] = []
        self._pieces: list[Piece] = []
        self._owner: list[int] = []
        self._middle = self._half = np.zeros((0, 3))
        self._facets: list[Facets | None] = []
        self._ready: list[NDArray | None] = []  # the transforms that the facets are for
        self._shift: list[list[float]] = []  # of every occluder: u, height, w
        self.grid = BoxGrid(np.zeros((0, 2)), np.zeros((0, 2)), np.zeros(0))
        self.known = self.grid.known

    def update(self, occluders: list[OccluderData], slope: tuple[float, float]) -> int:
        """Take over these occluders; returns how many pieces were carried along."""
        if occluders == self._occluders and slope == self._slope:
            return 0
        if slope != self._slope:
            self._ready = [None] * len(self._pieces)
        self._occluders, self._slope = occluders, slope
        count = len(occluders)
        transforms = np.array([o.transform for o in occluders]).reshape(count, 4, 4)
        stretch = np.linalg.norm(transforms[:, :3, :3], axis=1).max(axis=1)
        exponents = np.round(np.log2(stretch)).astype(int).tolist()
        shape = [
            (id(o.vertices), id(o.indices), e) for o, e in zip(occluders, exponents, strict=True)
        ]
        if shape != self._shape:
            self._restructure(exponents)
            self._shape = shape
        self._place(transforms)
        return len(self._pieces)

    def _restructure(self, exponents: list[int]) -> None:
        self._pieces, self._owner = [], []
        for number, (o, exponent) in enumerate(zip(self._occluders, exponents, strict=True)):
            assert o.vertices is not None and o.indices is not None
            found = self._meshes.pieces(o.vertices, o.indices, exponent)
            self._pieces += found
            self._owner += [number] * len(found)
        self._middle = np.array([p.middle for p in self._pieces]).reshape(-1, 3)
        self._half = np.array([p.half for p in self._pieces]).reshape(-1, 3)
        self._facets = [None] * len(self._pieces)
        self._ready = [None] * len(self._pieces)

    def _place(self, transforms: NDArray) -> None:
        slope = np.array(self._slope)
        turns, shifts = transforms[:, :3, :3], transforms[:, :3, 3]
        carried = shifts.copy()
        carried[:, [0, 2]] += shifts[:, 1:2] * slope
        self._shift = carried.tolist()
        owner = np.array(self._owner, np.int64)
        middle = np.einsum("nij,nj->ni", turns[owner], self._middle) + shifts[owner]
        half = np.einsum("nij,nj->ni", np.abs(turns[owner]), self._half)
        places = middle[:, [0, 2]] + middle[:, 1:2] * slope
        wide = half[:, [0, 2]] + half[:, 1:2] * np.abs(slope)
        top = middle[:, 1] + half[:, 1] + MARGIN  # as walls are asked for
        self.grid = BoxGrid(places - wide, places + wide, top)
        self.known = self.grid.known

    def covers(self, near: list[Near], u: float, w: float, level: float) -> bool:
        """Whether a surface of these boxes, the highest first, stands above `level` at a place."""
        for top, u0, u1, w0, w1, k in near:
            if top <= level:
                return False
            if u0 <= u <= u1 and w0 <= w <= w1:
                owner, facets = self._owner[k], self._facets[k]
                if facets is None or self._ready[k] is not self._occluders[owner].transform:
                    facets = self._of(k)
                su, sh, sw = self._shift[owner]
                if facets.cover(u - su, w - sw, level - sh):
                    return True
        return False

    def many(self, u: NDArray, w: NDArray, level: NDArray) -> NDArray[np.bool_]:
        """`covers` for many places (n,)."""
        covered = np.zeros(len(u), bool)
        for k, places in self.grid.pairs(u, w, level):
            left = places[~covered[places]]
            facets = self._of(k)
            su, sh, sw = self._shift[self._owner[k]]
            if len(left) > _FEW:
                covered[left] = facets.many(u[left] - su, w[left] - sw, level[left] - sh)
                continue
            for n in left.tolist():
                covered[n] = facets.cover(u.item(n) - su, w.item(n) - sw, level.item(n) - sh)
        return covered

    def _of(self, k: int) -> Facets:
        """The facets of a piece as it stands."""
        transform = self._occluders[self._owner[k]].transform
        facets = self._facets[k]
        if facets is None or self._ready[k] is not transform:
            facets = self._prepare(k, transform, facets)
        return facets

    def _prepare(self, k: int, transform: NDArray, before: Facets | None) -> Facets:
        facets, exact = self._store.get(self._pieces[k], transform, self._slope, before)
        self._facets[k] = facets
        self._ready[k] = transform if exact else None
        return facets
