"""`Marks`: boxes and lines over a picture; `Sketch` gathers them."""

from __future__ import annotations

from functools import cache
from importlib import resources
from typing import Any

import moderngl
import numpy as np
from numpy.typing import ArrayLike, NDArray

from weather_ecs import glsl

LINE = np.dtype([("from", "f4", 3), ("to", "f4", 3), ("color", "f4", 4), ("width", "f4")])
FACE = np.dtype([("center", "f4", 3), ("size", "f4", 3), ("color", "f4", 4)])

_SIGNS = np.array([[x, y, z] for x in (-0.5, 0.5) for y in (-0.5, 0.5) for z in (-0.5, 0.5)])
_EDGES = np.array(
    [(i, j) for i in range(8) for j in range(i) if np.abs(_SIGNS[i] - _SIGNS[j]).sum() == 1.0]
)


class Sketch:
    """Lines and boxes with their colours, m, before they are drawn."""

    def __init__(self) -> None:
        self._lines: list[NDArray] = []
        self._faces: list[NDArray] = []

    def lines(self, start: ArrayLike, end: ArrayLike, color: ArrayLike, width: float) -> None:
        """Lines between points (n, 3); one colour (4,) or one each; width in pixels."""
        begin = np.atleast_2d(np.asarray(start, np.float64))
        rows = np.zeros(len(begin), LINE)
        rows["from"], rows["to"], rows["color"], rows["width"] = begin, end, color, width
        self._lines.append(rows)

    def path(self, points: ArrayLike, color: ArrayLike, width: float) -> None:
        """Lines from each of the points (n, 3) to the next."""
        places = np.asarray(points, np.float64)
        self.lines(places[:-1], places[1:], color, width)

    def boxes(self, centers: NDArray, sizes: NDArray, color: ArrayLike, width: float) -> None:
        """The edges of boxes, centres and whole sides (n, 3)."""
        corners = centers[:, None, :] + _SIGNS * sizes[:, None, :]
        colors = np.asarray(color, np.float64)
        if colors.ndim == 2:
            colors = np.repeat(colors, len(_EDGES), axis=0)
        ends = corners[:, _EDGES]
        self.lines(ends[:, :, 0].reshape(-1, 3), ends[:, :, 1].reshape(-1, 3), colors, width)

    def faces(self, centers: NDArray, sizes: NDArray, color: ArrayLike) -> None:
        """The faces of boxes."""
        rows = np.zeros(len(centers), FACE)
        rows["center"], rows["size"], rows["color"] = centers, sizes, color
        self._faces.append(rows)

    def add(self, other: Sketch) -> None:
        """What another one has, as it is now."""
        self._lines += other._lines
        self._faces += other._faces

    def gathered(self) -> tuple[NDArray, NDArray]:
        """All faces and all lines, in the order in which they came."""
        faces = np.concatenate(self._faces) if self._faces else np.zeros(0, FACE)
        lines = np.concatenate(self._lines) if self._lines else np.zeros(0, LINE)
        return faces, lines


class Marks:
    """Draws a sketch; keeps it on the GPU until another one comes."""

    def __init__(self, gl: moderngl.Context) -> None:
        self._gl = gl
        self._programs = [program(gl, "faces"), program(gl, "marks")]
        self._buffers = [gl.buffer(reserve=FACE.itemsize), gl.buffer(reserve=LINE.itemsize)]
        self._counts = [0, 0]
        formats = [
            ("3f 3f 4f /i", "in_center", "in_size", "in_color"),
            ("3f 3f 4f 1f /i", "in_from", "in_to", "in_color", "in_width"),
        ]
        self._arrays = [
            gl.vertex_array(each, [(buffer, *form)])
            for each, buffer, form in zip(self._programs, self._buffers, formats, strict=True)
        ]

    def take(self, sketch: Sketch) -> None:
        """Another sketch in place of the last."""
        for index, rows in enumerate(sketch.gathered()):
            self._counts[index] = len(rows)
            if len(rows):
                self._buffers[index].orphan(rows.nbytes)
                self._buffers[index].write(rows.tobytes())

    def draw(self, matrix: NDArray, size: tuple[int, int]) -> None:
        """Over what is bound; matrix: from the sketch's metres to the picture, column vectors."""
        gl = self._gl
        gl.enable_only(moderngl.BLEND)
        gl.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
        data = np.ascontiguousarray(matrix.T, np.float32).tobytes()
        self._programs[1]["mark_size"] = size
        shapes = ((moderngl.TRIANGLES, 36), (moderngl.TRIANGLE_STRIP, 4))
        for index, (mode, vertices) in enumerate(shapes):
            if self._counts[index]:
                self._programs[index]["mark_matrix"].write(data)
                self._arrays[index].render(mode, vertices, instances=self._counts[index])

    def release(self) -> None:
        """Give everything back."""
        parts: tuple[Any, ...] = (*self._arrays, *self._buffers, *self._programs)
        for part in parts:
            part.release()


def program(gl: moderngl.Context, name: str) -> Any:
    """The editor's own program of this name; the caller releases it."""
    return gl.program(vertex_shader=_text(f"{name}.vert"), fragment_shader=_text(f"{name}.frag"))


@cache
def _text(name: str) -> str:
    folder = resources.files("weather_ecs.editor").joinpath("shaders")
    text = folder.joinpath(name).read_text(encoding="utf-8")
    return text.replace('#include "sky.glsl"', glsl("sky.glsl"))
