"""The sun's shadows: one map of all that stands still, kept up to date where something moves."""

from __future__ import annotations

import math
from collections.abc import Callable

import moderngl
import numpy as np
from numpy.typing import NDArray

from .programs import compile_program, release_all, scissor

LOW = np.array([-64.0, -4.0, -170.0])  # m, what the map covers
HIGH = np.array([64.0, 22.0, 94.0])
TURN_STILL, TURN_MOVING = math.radians(0.3), math.radians(4.0)  # turns that ask for a new map
BIAS = 0.00014  # in the map's depth


def light_matrix(sun: NDArray) -> NDArray:
    """(4, 4) clip matrix of the sun's view of the covered box, z of the world up in the map."""
    v = np.array([0.0, 0.0, -1.0]) + sun[2] * sun
    if np.linalg.norm(v) < 0.05:
        v = np.array([1.0, 0.0, 0.0]) - sun[0] * sun
    v /= np.linalg.norm(v)
    basis = np.stack([np.cross(v, sun), v, sun])
    corners = np.array([[x, y, z] for x in (LOW[0], HIGH[0]) for y in (LOW[1], HIGH[1])
                        for z in (LOW[2], HIGH[2])]) @ basis.T  # fmt: skip
    low, high = corners.min(0), corners.max(0)
    scale = 2.0 / (high - low)
    scale[2] *= -1.0
    matrix = np.eye(4)
    matrix[:3, :3] = basis * scale[:, None]
    matrix[:3, 3] = -(low + high) * 0.5 * scale
    return matrix


class Shadows:
    """Depth maps and the matrix to look them up."""

    def __init__(self, ctx: moderngl.Context, size: int) -> None:
        self.ctx, self.size = ctx, size
        self.still = ctx.depth_texture((size, size))
        self.still.compare_func = ""
        self.still.filter = (moderngl.NEAREST, moderngl.NEAREST)
        self.live = ctx.depth_texture((size, size))
        self.live.compare_func = "<="
        self.live.filter = (moderngl.LINEAR, moderngl.LINEAR)
        self.live.repeat_x = self.live.repeat_y = False
        self._still_target = ctx.framebuffer([], self.still)
        self._live_target = ctx.framebuffer([], self.live)
        self._copy = compile_program(ctx, "sky_bake.vert", "depth_copy.frag")
        self._quad = ctx.buffer(np.array([-1, -1, 3, -1, -1, 3], "f4"))
        self._copy_array = ctx.vertex_array(self._copy, [(self._quad, "2f4", "in_position")])
        self.sun: NDArray | None = None  # the map's
        self._seen: NDArray | None = None  # the last frame's
        self.matrix = np.eye(4)
        self.lookup = np.eye(4)
        self._dirty: list[tuple[int, int, int, int]] = []

    def needs(self, sun: NDArray) -> bool:
        """Whether the sun is too far from the map's; while it moves more is let pass."""
        moves = self._seen is not None and float(np.abs(self._seen - sun).max()) > 1e-6
        self._seen = sun
        allowed = TURN_MOVING if moves else TURN_STILL
        return self.sun is None or float(self.sun @ sun) < math.cos(allowed)

    def draw_still(self, sun: NDArray, draw: Callable[[NDArray], None]) -> None:
        """Make the map anew; `draw(matrix)` draws what stands still."""
        self.sun, self.matrix = sun, light_matrix(sun)
        to_map = np.diag([0.5, 0.5, 0.5, 1.0])
        to_map[:3, 3] = (0.5, 0.5, 0.5 - BIAS)
        self.lookup = to_map @ self.matrix
        target = self._still_target
        target.use()
        scissor(target, None)
        target.clear(depth=1.0)
        target.scissor = (2, 2, self.size - 4, self.size - 4)  # the rim stays lit
        self.ctx.enable_only(moderngl.DEPTH_TEST)
        self.ctx.depth_func = "<="
        self.ctx.polygon_offset = 0.6, 1.0
        draw(self.matrix)
        self.ctx.polygon_offset = 0.0, 0.0
        self._live_target.use()
        self._restore([(0, 0, self.size, self.size)])
        self._dirty = []

    def draw_moving(
        self, spheres: list[tuple[NDArray, float]], draw: Callable[[NDArray], None]
    ) -> None:
        """Wipe where things were, draw them where they are (centre, radius m)."""
        boxes = [box for box in map(self._box, spheres) if box is not None]
        if not boxes and not self._dirty:
            return
        self._live_target.use()
        self._restore(self._dirty)
        self.ctx.enable_only(moderngl.DEPTH_TEST)
        self.ctx.depth_func = "<="
        self.ctx.polygon_offset = 0.6, 1.0
        self._live_target.scissor = (2, 2, self.size - 4, self.size - 4)
        if boxes:
            draw(self.matrix)
        self.ctx.polygon_offset = 0.0, 0.0
        scissor(self._live_target, None)
        self._dirty = boxes

    def _box(self, sphere: tuple[NDArray, float]) -> tuple[int, int, int, int] | None:
        center, radius = sphere
        at = (self.matrix @ np.append(center, 1.0))[:2] * 0.5 + 0.5
        reach = np.linalg.norm(self.matrix[:2, :3], axis=1) * 0.5 * radius
        low = np.clip((at - reach) * self.size - 2, 0, self.size).astype(int)
        high = np.clip((at + reach) * self.size + 3, 0, self.size).astype(int)
        if (high <= low).any():
            return None
        return int(low[0]), int(low[1]), int(high[0] - low[0]), int(high[1] - low[1])

    def _restore(self, boxes: list[tuple[int, int, int, int]]) -> None:
        self.ctx.enable_only(moderngl.DEPTH_TEST)
        self.ctx.depth_func = "1"
        self.still.use(0)
        self._copy["depth_map"] = 0
        for box in boxes:
            scissor(self._live_target, box)
            self._copy_array.render()
        scissor(self._live_target, None)
        self.ctx.depth_func = "<="

    def release(self) -> None:
        """Give everything back."""
        release_all((self._copy_array, self._quad, self._copy, self._live_target,
                     self._still_target, self.live, self.still))  # fmt: skip
