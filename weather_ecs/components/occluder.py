"""`Occluder`: something that rain falls on."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass, field
from typing import Any, ClassVar

import numpy as np
from numpy.typing import NDArray

from weather_ecs.components._base import (
    FAR,
    Check,
    Component,
    count_assignment,
    flag,
    integer,
    set_raw,
)
from weather_ecs.errors import InvalidValueError

_VERTICES = "a finite array of shape (n, 3), n >= 3, within 1e7"
_INDICES = "whole numbers of shape (3 t,) or (t, 3), t >= 1, each >= 0 and below the vertex count"
_TRANSFORM = (
    "None, or a finite affine matrix that can be inverted: shape (4, 4) for column vectors, or 16 "
    "floats column by column"
)


def _vertices(name: str, value: Any) -> NDArray[np.float32]:
    try:
        array = np.asarray(value)
        if array.dtype.kind not in "iuf" or array.ndim != 2 or array.shape[1] != 3:
            raise ValueError
        if len(array) < 3 or not np.all(np.abs(array) <= FAR):
            raise ValueError
    except (TypeError, ValueError):
        raise InvalidValueError(name, value, _VERTICES) from None
    result = np.array(array, np.float32, order="C")
    result.setflags(write=False)
    return result


def _indices(name: str, value: Any, vertex_count: int) -> NDArray[np.uint32]:
    try:
        array = np.asarray(value)
        if array.dtype.kind not in "iu" or array.ndim not in (1, 2) or array.size == 0:
            raise ValueError
        if array.size % 3 or (array.ndim == 2 and array.shape[1] != 3):
            raise ValueError
        if int(array.min()) < 0 or int(array.max()) >= vertex_count:
            raise ValueError
    except (TypeError, ValueError):
        raise InvalidValueError(name, value, _INDICES) from None
    result = np.array(array.reshape(-1), np.uint32)
    result.setflags(write=False)
    return result


def _transform(name: str, value: Any) -> NDArray[np.float64]:
    if value is None:
        value = np.eye(4)
    try:
        result = np.array(value, np.float64)
    except (TypeError, ValueError):
        raise InvalidValueError(name, value, _TRANSFORM) from None
    if result.shape == (16,):
        result = result.reshape(4, 4).T.copy()
    if result.shape != (4, 4):
        raise InvalidValueError(name, value, _TRANSFORM)
    (a, b, c, x), (d, e, f, y), (g, h, i, z), last = result.tolist()
    volume = a * (e * i - f * h) - b * (d * i - f * g) + c * (d * h - e * g)
    size = max(map(abs, (a, b, c, d, e, f, g, h, i)))
    # The volume is judged against the matrix's own scale. All comparisons are false for NaN.
    if not (size <= FAR and abs(volume) > 1e-9 * size * size * size):
        raise InvalidValueError(name, value, _TRANSFORM)
    if not (abs(x) <= FAR and abs(y) <= FAR and abs(z) <= FAR):
        raise InvalidValueError(name, value, _TRANSFORM)
    if last != [0.0, 0.0, 0.0, 1.0]:
        raise InvalidValueError(name, value, _TRANSFORM)
    result.setflags(write=False)
    return result


@dataclass(eq=False, slots=True)
class Occluder(Component):
    """A mesh in metres that the game may move, or a callback that draws the game's own geometry.

    Give `vertices` and `indices`, or `draw`, never both. `draw(view_projection)` gets the matrix
    as an array of shape (4, 4) for column vectors. What a vertex array holds is copied once and
    kept read-only; `set_mesh` replaces both arrays together.
    """

    # (n, 3), m, the mesh's own axes; triangles are three indices each, (3 t,)
    vertices: NDArray[np.float32] | None = field(default=None, repr=False)
    indices: NDArray[np.uint32] | None = field(default=None, repr=False)
    transform: NDArray[np.float64] | None = None  # (4, 4), mesh to world, column vectors
    dynamic: bool = False  # moves often: kept out of the cached layer
    layers: int = 1  # bit mask, 1 to 2**32 - 1; what rain on other layers ignores
    draw: Callable[[NDArray[np.float64]], None] | None = field(default=None, kw_only=True)

    checks: ClassVar[dict[str, Check]] = {
        "transform": _transform,
        "dynamic": flag(),
        "layers": integer(1, 2**32 - 1),
    }

    def __post_init__(self) -> None:
        allowed = "both vertices and indices, or draw alone"
        if self.draw is None and (self.vertices is None or self.indices is None):
            raise InvalidValueError("Occluder", None, allowed)
        if self.draw is not None and (self.vertices is not None or self.indices is not None):
            raise InvalidValueError("Occluder", self.draw, allowed)

    def __setattr__(self, name: str, value: Any) -> None:
        if name in self.checks:
            Component.__setattr__(self, name, value)
            return
        complete = hasattr(self, "draw")  # the last field that construction sets
        if name == "vertices":
            value = self._checked_vertices(value, complete)
        elif name == "indices":
            value = self._checked_indices(value, complete)
        elif name == "draw":
            possible = callable(value) if complete else value is None or callable(value)
            if not possible or (complete and self.vertices is not None):
                raise InvalidValueError("Occluder.draw", value, "a function, where no mesh is set")
        else:
            raise AttributeError(f"Occluder has no field {name!r}")
        set_raw(self, name, value)
        count_assignment(self)

    def _checked_vertices(self, value: Any, complete: bool) -> NDArray[np.float32] | None:
        if value is None and not complete:
            return None
        result = _vertices("Occluder.vertices", value)
        if complete and (self.indices is None or int(self.indices.max()) >= len(result)):
            raise InvalidValueError("Occluder.vertices", value, "enough vertices for the indices")
        return result

    def _checked_indices(self, value: Any, complete: bool) -> NDArray[np.uint32] | None:
        if value is None and not complete:
            return None
        count = 0 if self.vertices is None else len(self.vertices)
        return _indices("Occluder.indices", value, count)

    def set_mesh(self, vertices: Any, indices: Any) -> None:
        """Replace the mesh; with a bad one, the old mesh stays."""
        if self.draw is not None:
            raise InvalidValueError("Occluder.vertices", vertices, "no mesh where draw is set")
        checked = _vertices("Occluder.vertices", vertices)
        checked_indices = _indices("Occluder.indices", indices, len(checked))
        set_raw(self, "vertices", checked)
        set_raw(self, "indices", checked_indices)
        count_assignment(self)
