"""What is blended over the rest: the pond, the lamps' light on the ground, their glow."""

from __future__ import annotations

import math

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
POOL_TINT = (0.55, 0.40, 0.22)  # display values
UNSEEN = 0.4 / 255.0  # less of it adds nothing to a picture
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
        self.ctx, self._block = ctx, block
        self.program = compile_program(ctx, "lamp_pool.vert", "lamp_pool.frag")
        block.attach(self.program)
        self.program["tint"] = POOL_TINT
        mesh = place.ground
        whole = mesh.indices[: mesh.chunks.sum(1).max()]  # without the coarse ones
        middle = mesh.vertices[whole].mean(1)
        rows, self._first, first = [], [], 0
        self._greatest = []  # light there may be in each triangle, falling
        for lamp in place.lamps[:-1]:
            x, _, z = lamp.position
            close = np.hypot(middle[:, 0] - x, middle[:, 2] - z) < POOL_RADIUS
            triangles = mesh.vertices[whole[close]]
            greatest = max(lamp.color) * pool_light(np.array(lamp.position), triangles)
            order = np.argsort(-greatest, kind="stable")
            points = triangles[order].reshape(-1, 3)
            light = np.broadcast_to((*lamp.position, max(lamp.color)), (len(points), 4))
            rows.append(np.hstack([points, light]).astype("f4"))
            self._first.append(first)
            self._greatest.append(-greatest[order])
            first += len(points)
        self._centers = np.array([lamp.position for lamp in place.lamps[:-1]])
        self._vertices = ctx.buffer(np.concatenate(rows).tobytes())
        content = [(self._vertices, "3f4 4f4", "in_position", "in_lamp")]
        self._array = ctx.vertex_array(self.program, content)

    def draw(self, planes: NDArray, camera: NDArray) -> None:
        """Draw those that are seen, as far as they add anything; depth is tested."""
        self.ctx.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND)
        self.ctx.blend_func = moderngl.ONE, moderngl.ONE
        side = self._centers @ planes[:, :3].T + planes[:, 3]
        away = np.linalg.norm(self._centers - camera, axis=1)
        burn, haze = (float(self._block.data[k][0, 3]) for k in ("sun_direction", "horizon_color"))
        for k in np.flatnonzero((side > -POOL_RADIUS).all(axis=1) & (away < 150.0)).tolist():
            left = burn * math.exp(-max(float(away[k]) - POOL_RADIUS, 0.0) * haze)
            count = int(np.searchsorted(self._greatest[k], -UNSEEN / max(left, 1e-6)))
            if count:
                self._array.render(moderngl.TRIANGLES, vertices=3 * count, first=self._first[k])

    def release(self) -> None:
        """Give everything back."""
        release_all((self._array, self._vertices, self.program))


def pool_light(lamp: NDArray, triangles: NDArray) -> NDArray:
    """(n,) the most that lamp_pool.frag adds in triangles (n, 3, 3), at a strength of 1."""
    a, b = np.meshgrid(np.linspace(0.0, 1.0, 6), np.linspace(0.0, 1.0, 6))
    inside = a + b < 1.001
    shares = np.stack([a, b, 1.0 - a - b], -1)[inside]
    way = lamp - shares @ triangles
    near2 = (way**2).sum(-1)
    rim = np.clip(1.0 - (way[..., [0, 2]] ** 2).sum(-1) * 0.016, 0.0, 1.0)
    light = 9.0 * np.clip(way[..., 1], 0.0, None) / (np.sqrt(near2) * (near2 + 1.5)) * rim**2
    return np.asarray(max(POOL_TINT) * light.max(1))


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
