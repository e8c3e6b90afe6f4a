"""Drops that the cabin's eaves shed while its roof is wet, and rings on puddles."""

from __future__ import annotations

import itertools
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from demo_game.place import Place, bake, eaves, rings

from . import geometry
from .environment import Environment
from .frame_block import FrameBlock
from .programs import Look, Variants, compile_program, release_all, set_uniforms

SLOTS = 4  # drops of one place that may be on their way at once
SEEN = 45.0  # m from the camera
FAINTEST = 1e-3  # mm/h, of rain that wets a roof
RINGS_SEEN = 7.5  # m from the camera
STRETCH = 1.5  # m of the trails that are drawn or not
UNITS = {"detail_map": 1, "sky_map": 3}


def _variants(
    ctx: moderngl.Context, block: FrameBlock, name: str, content: list[Any], **uniforms: Any
) -> Variants:
    """Programs of the shaders of a name, each with one vertex array of the content."""

    def look(*defines: str) -> Look:
        program = compile_program(ctx, f"{name}.vert", f"{name}.frag", *defines)
        block.attach(program)
        set_uniforms(program, **uniforms)
        return program, [ctx.vertex_array(program, content)]

    return Variants(look)


class Drips:
    """One instanced quad a drop; the shader finds from the clock where each is."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, place: Place) -> None:
        self._ctx, self._block = ctx, block
        points = eaves.points(place.cabin_origin, place.floor_height)
        lamps = [(lamp.position, max(lamp.color)) for lamp in place.lamps]
        up = np.broadcast_to((0.0, 1.0, 0.0), (len(points), 3))
        light = bake.lamp_light(points[:, :3], up, lamps, [])
        rows = np.repeat(np.column_stack([points, light]), SLOTS, axis=0).astype("f4")
        self._count = len(rows)
        self._low = np.column_stack([points[:, 0], points[:, 3], points[:, 2]]).min(0)[None] - 0.3
        self._high = points[:, :3].max(0)[None] + 0.3
        corners = np.array([-1, 0, 1, 0, -1, 1, 1, 1], "f4")
        self._corners, self._drips = ctx.buffer(corners.tobytes()), ctx.buffer(rows.tobytes())
        content = [
            (self._corners, "2f4", "in_corner"),
            (self._drips, "4f4 1f4/i", "in_drip", "in_lamp"),
        ]

        self.looks = (_variants(ctx, block, "drip", content),)

    def draw(
        self, planes: NDArray, camera: NDArray, environment: Environment, projection: NDArray,
        size: tuple[int, int],
    ) -> None:  # fmt: skip
        """Draw those that are on their way; tested against depth, not written to it."""
        wet = environment.wetness > 0.0 or environment.water is not None
        if not (wet or any(area[3] > FAINTEST for area in environment.rain_areas)):
            return
        away = float(geometry.box_distance(camera, self._low, self._high)[0])
        if away > SEEN or not geometry.boxes_seen(planes, self._low, self._high)[0]:
            return
        width, height = size
        lens = (2.0 / width, 2.0 / height, 0.5 * height * float(projection[1, 1]))
        look = self.looks[0]
        look.program["lens"] = lens
        self._ctx.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND)
        self._ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
        look.arrays[0].render(moderngl.TRIANGLE_STRIP, instances=self._count)

    def release(self) -> None:
        """Give everything back."""
        release_all((*self.looks, self._corners, self._drips))


class PuddleRings:
    """A point a place, of those near the camera; the shader finds which have a ring."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, place: Place) -> None:
        self._ctx = ctx
        sites = rings.sites(place.terrain, place.meadow)
        # Stretches of the trails with their boxes, from south to north.
        steps = np.arange(-sites[0, 2], -sites[-1, 2] + STRETCH, STRETCH)
        ends = np.unique(np.searchsorted(-sites[:, 2], steps))
        parts = [sites[a:b] for a, b in itertools.pairwise(ends)]
        self._ends = ends
        self._low = np.array([part.min(0) for part in parts]) - 0.3
        self._high = np.array([part.max(0) for part in parts]) + 0.3
        self._vertices = ctx.buffer(sites.astype("f4").tobytes())
        content = [(self._vertices, "3f4", "in_place")]

        self.looks = (_variants(ctx, block, "ring", content, reach=RINGS_SEEN, **UNITS),)

    def draw(
        self, planes: NDArray, camera: NDArray, environment: Environment, projection: NDArray,
        size: tuple[int, int],
    ) -> None:  # fmt: skip
        """Draw those near the camera where it rains; tested against depth, not written to it."""
        if not any(area[3] > FAINTEST for area in environment.rain_areas):
            return
        seen = geometry.box_distance(camera, self._low, self._high) < RINGS_SEEN
        seen &= geometry.boxes_seen(planes, self._low, self._high)
        shown = np.flatnonzero(seen)
        if not len(shown):
            return
        first, last = self._ends[shown[0]], self._ends[shown[-1] + 1]
        self.looks[0].program["lens"] = 0.5 * size[1] * float(projection[1, 1])
        self._ctx.enable_only(moderngl.DEPTH_TEST | moderngl.BLEND | moderngl.PROGRAM_POINT_SIZE)
        self._ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
        array = self.looks[0].arrays[0]
        array.render(moderngl.POINTS, vertices=int(last - first), first=int(first))

    def release(self) -> None:
        """Give everything back."""
        release_all((*self.looks, self._vertices))
