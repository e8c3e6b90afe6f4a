"""What rain falls on: ground, a roofed hut, steps and a thing that moves (seed 001, 4.1)."""

from __future__ import annotations

import math
from collections.abc import Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from benchmarks.models import glsl
from benchmarks.models.stage import Stage
from weather_ecs.components import Occluder

# The stage's camera stands at the origin and looks along -z.
HUT = (-4.0, -12.0)  # m, (x, z) of its middle
STEPS = (3.5, -9.0)
COLORS = ((0.24, 0.25, 0.21), (0.33, 0.27, 0.22), (0.36, 0.36, 0.37), (0.42, 0.20, 0.16))
QUADS = ((0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3))

Corner = tuple[float, float, float]
Mesh = tuple[NDArray[np.float32], NDArray[np.uint32]]


def boxes(spans: Sequence[tuple[Corner, Corner]]) -> Mesh:
    """(vertices (n, 3) in m, indices (m,)) of boxes from their lowest to their highest corners."""
    corners = [
        (x, y, z)
        for low, high in spans
        for x in (low[0], high[0])
        for y in (low[1], high[1])
        for z in (low[2], high[2])
    ]
    faces = np.array([(a, b, c, a, c, d) for a, b, c, d in QUADS], np.uint32).ravel()
    indices = np.concatenate([faces + np.uint32(8 * k) for k in range(len(spans))])
    return np.array(corners, np.float32), indices


def ground() -> Mesh:
    """Gently rolling, 100 m on a side."""
    x, z = np.meshgrid(np.linspace(-50.0, 50.0, 65), np.linspace(-50.0, 50.0, 65))
    y = 0.15 * np.sin(0.21 * x) * np.cos(0.17 * z)
    cell = (np.arange(64)[:, None] * 65 + np.arange(64)).ravel()
    corners = np.array([0, 65, 1, 1, 65, 66])
    vertices = np.stack([x, y, z], axis=-1).reshape(-1, 3)
    return vertices.astype(np.float32), (cell[:, None] + corners).astype(np.uint32).ravel()


def hut() -> Mesh:
    """Three walls, open towards the camera, under a flat roof that juts out."""
    x, z = HUT
    return boxes(
        [
            ((x - 2.5, -0.5, z - 2.0), (x - 2.3, 2.6, z + 2.0)),
            ((x + 2.3, -0.5, z - 2.0), (x + 2.5, 2.6, z + 2.0)),
            ((x - 2.5, -0.5, z - 2.0), (x + 2.5, 2.6, z - 1.8)),
            ((x - 3.2, 2.6, z - 2.7), (x + 3.2, 2.8, z + 2.9)),
        ]
    )


def steps() -> Mesh:
    """Six of them, upwards and away from the camera."""
    x, z = STEPS
    rise = [(k, 0.25 * k) for k in range(1, 7)]
    return boxes([((x - 2.0, -0.5, z - 0.5 * k), (x + 2.0, y, z - 0.5 * k + 0.5)) for k, y in rise])


class Scene:
    """The meshes on the GPU, as a game draws them, and as occluders for the rain."""

    def __init__(self, stage: Stage) -> None:
        self._stage = stage
        ctx = stage.ctx
        self._program = glsl.program(ctx, "scene.vert", fragment="scene.frag")
        self._meshes = [ground(), hut(), steps(), boxes([((-1.2, -0.5, -1.2), (1.2, 2.4, 1.2))])]
        self._parts = []
        for vertices, indices in self._meshes:
            buffers = ctx.buffer(vertices.tobytes()), ctx.buffer(indices.tobytes())
            array = ctx.vertex_array(self._program, [(buffers[0], "3f", "in_vertex")], buffers[1])
            self._parts.append((array, *buffers))
        camera = stage.camera
        self._view_projection = _columns(camera.projection @ camera.view)

    def occluders(self) -> list[Occluder]:
        """One of each mesh; the last one is the thing that moves."""
        moving = len(self._meshes) - 1
        return [
            Occluder(vertices, indices, dynamic=k == moving)
            for k, (vertices, indices) in enumerate(self._meshes)
        ]

    @staticmethod
    def place(time: float) -> NDArray[np.float64]:
        """Where the moving thing is at a time in s, (4, 4): it goes about in a circle."""
        c, s = math.cos(0.5 * time), math.sin(0.5 * time)
        first, second = (c, 0.0, s, 5.0 * s), (-s, 0.0, c, -14.0 + 5.0 * c)
        rows = (*first, 0.0, 1.0, 0.0, 0.0, *second, 0.0, 0.0, 0.0, 1.0)
        return np.array(rows).reshape(4, 4)

    def draw(self, place: NDArray[np.float64]) -> None:
        """Into what is bound, with depth."""
        self._stage.ctx.enable_only(moderngl.DEPTH_TEST)
        glsl.put(self._program, view_projection=self._view_projection)
        for k, (part, color) in enumerate(zip(self._parts, COLORS, strict=True)):
            transform = place if k == len(self._parts) - 1 else np.eye(4)
            glsl.put(self._program, place=_columns(transform), color=color)
            part[0].render(moderngl.TRIANGLES)

    def release(self) -> None:
        for part in self._parts:
            for thing in part:
                thing.release()
        self._program.release()


def _columns(matrix: NDArray[np.float64]) -> tuple[float, ...]:
    """(4, 4) as OpenGL takes it, column by column."""
    return tuple(matrix.T.ravel().tolist())
