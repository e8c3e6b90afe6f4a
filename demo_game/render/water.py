"""The pond's still water, and the lamps' glow: what is blended over the rest."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from demo_game.place import Place
from demo_game.place.ground_mesh import pond_mesh

from . import geometry
from .frame_block import FrameBlock
from .programs import compile_program, set_matrix, set_uniforms

UNITS = {"detail_map": 1, "sky_map": 3, "mirror_map": 4}


class Water:
    """The pond's sheet."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, place: Place) -> None:
        self.ctx, self.level = ctx, place.pond.level
        self.program = compile_program(ctx, "water.vert", "water.frag")
        block.attach(self.program)
        set_uniforms(self.program, **UNITS)
        vertices, indices = pond_mesh(place.terrain)
        self._vertices = ctx.buffer(vertices.tobytes())
        self._indices = ctx.buffer(indices.tobytes())
        content = [(self._vertices, "4f4", "in_position")]
        self._array = ctx.vertex_array(self.program, content, self._indices)
        self._low = vertices[:, :3].min(0)[None]
        self._high = vertices[:, :3].max(0)[None]

    def seen(self, planes: NDArray, camera: NDArray) -> float:
        """Distance of the pond from the camera, m; inf where it is out of view or above it."""
        if camera[1] <= self.level or not geometry.boxes_seen(planes, self._low, self._high)[0]:
            return float("inf")
        return float(geometry.box_distance(camera, self._low, self._high)[0])

    def draw(self, mirror: tuple[float, float, float, float]) -> None:
        """Draw it; `mirror` is 1 / width, 1 / height of the picture and the mirror's share."""
        self.program["mirror"] = mirror
        self.ctx.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND)
        self.ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
        self._array.render()

    def release(self) -> None:
        """Give everything back."""
        for item in (self._array, self._vertices, self._indices, self.program):
            item.release()


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
        for item in (self._array, self._corners, self._lamps, self.program):
            item.release()
