"""What is blended over the rest: the pond, the lamps' light on the ground, their glow."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from demo_game.place import Place
from demo_game.place.ground_mesh import pond_mesh

from . import geometry
from .environment import Ripples
from .frame_block import FrameBlock
from .programs import (
    Look,
    Variants,
    compile_program,
    release_all,
    set_matrix,
    set_uniforms,
)

RIPPLE_UNIT = 5
POOL_RADIUS = 9.0  # m
UNITS = {"detail_map": 1, "sky_map": 3}


class Water:
    """The pond's sheet."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, place: Place) -> None:
        self.ctx, self.level = ctx, place.pond.level
        vertices, indices = pond_mesh(place.terrain)
        self._vertices = ctx.buffer(vertices.tobytes())
        self._indices = ctx.buffer(indices.tobytes())
        content = [(self._vertices, "4f4", "in_position")]

        def look(*defines: str) -> Look:
            program = compile_program(ctx, "water.vert", "water.frag", *defines)
            block.attach(program)
            set_uniforms(program, **UNITS, ripple_map=UNITS["detail_map"])
            return program, [ctx.vertex_array(program, content, self._indices)]

        self.looks = (Variants(look),)
        self._low = vertices[:, :3].min(0)[None]
        self._high = vertices[:, :3].max(0)[None]

    def seen(self, planes: NDArray, camera: NDArray) -> float:
        """Distance of the pond from the camera, m; inf where it is out of view or above it."""
        if camera[1] <= self.level or not geometry.boxes_seen(planes, self._low, self._high)[0]:
            return float("inf")
        return float(geometry.box_distance(camera, self._low, self._high)[0])

    def draw(self, ripples: Ripples | None = None) -> None:
        """Draw it; without ripples it lies still."""
        look = self.looks[0]
        if ripples is not None:
            ripples.use(look.program, RIPPLE_UNIT)
        else:
            look.program["ripple_scale"] = (0.0, 0.0, 0.0, 0.0)
        self.ctx.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND)
        self.ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
        look.arrays[0].render()

    def release(self) -> None:
        """Give everything back."""
        release_all((*self.looks, self._vertices, self._indices))


class LampPools:
    """The lamps' light on the ground: the ground around them drawn again, added."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, place: Place) -> None:
        self.ctx = ctx
        self.program = compile_program(ctx, "lamp_pool.vert", "lamp_pool.frag")
        block.attach(self.program)
        self.program["tint"] = (0.55, 0.40, 0.22)
        mesh = place.ground
        whole = mesh.indices[: mesh.chunks.sum(1).max()]  # without the coarse ones
        middle = mesh.vertices[whole].mean(1)
        rows, self._ranges, first = [], [], 0
        for lamp in place.lamps[:-1]:
            x, _, z = lamp.position
            close = np.hypot(middle[:, 0] - x, middle[:, 2] - z) < POOL_RADIUS
            points = mesh.vertices[whole[close].ravel()]
            light = np.broadcast_to((*lamp.position, max(lamp.color)), (len(points), 4))
            rows.append(np.hstack([points, light]).astype("f4"))
            self._ranges.append((first, len(points)))
            first += len(points)
        self._centers = np.array([lamp.position for lamp in place.lamps[:-1]])
        self._vertices = ctx.buffer(np.concatenate(rows).tobytes())
        content = [(self._vertices, "3f4 4f4", "in_position", "in_lamp")]
        self._array = ctx.vertex_array(self.program, content)

    def draw(self, planes: NDArray, camera: NDArray) -> None:
        """Draw those that are seen; blending adds, depth is tested."""
        self.ctx.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND)
        self.ctx.blend_func = moderngl.ONE, moderngl.ONE
        side = self._centers @ planes[:, :3].T + planes[:, 3]
        away = np.linalg.norm(self._centers - camera, axis=1)
        for k in np.flatnonzero((side > -POOL_RADIUS).all(axis=1) & (away < 150.0)).tolist():
            first, count = self._ranges[k]
            self._array.render(moderngl.TRIANGLES, vertices=count, first=first)

    def release(self) -> None:
        """Give everything back."""
        release_all((self._array, self._vertices, self.program))


class Halos:
    """Soft light round every lamp, added to the picture."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, place: Place) -> None:
        self.ctx = ctx
        self.program = compile_program(ctx, "halo.vert", "halo.frag")
        block.attach(self.program)
        corners = np.array([-1, -1, 1, -1, -1, 1, 1, 1], "f4")
        lamps = np.array([(*lamp.position, max(lamp.color)) for lamp in place.lamps], "f4")
        self._corners, self._lamps = ctx.buffer(corners), ctx.buffer(lamps)
        self._count = len(lamps)
        content = [(self._corners, "2f4", "in_corner"), (self._lamps, "4f4/i", "in_lamp")]
        self._array = ctx.vertex_array(self.program, content)

    def draw(self, view: NDArray) -> None:
        """Draw all; tested against depth, not written to it."""
        set_matrix(self.program, "view", view)
        self.ctx.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND)
        self.ctx.blend_func = moderngl.ONE, moderngl.ONE
        self._array.render(moderngl.TRIANGLE_STRIP, instances=self._count)

    def release(self) -> None:
        """Give everything back."""
        release_all((self._array, self._corners, self._lamps, self.program))
