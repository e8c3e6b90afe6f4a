"""Grass near the camera."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from demo_game.place import Place, bake

from .frame_block import FrameBlock
from .programs import Look, Variants, compile_program, release_all
from .quality import Quality


class Meadow:
    """Grass near the camera; patches thin out with distance."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, place: Place) -> None:
        grass = place.grass
        n = len(grass.vertices)
        data = np.zeros(n, [("position", "f4", 3), ("color", "u1", 4), ("root", "f4", 4)])
        data["position"] = grass.vertices
        data["color"][:, :3] = np.round(np.sqrt(np.clip(grass.colors, 0, 1)) * 255)
        data["color"][:, 3] = np.round(grass.sway * 255)
        data["root"][:, :3] = grass.roots
        lamps = [(lamp.position, max(lamp.color)) for lamp in place.lamps]
        up = np.zeros((n, 3)) + (0.0, 1.0, 0.0)
        data["root"][:, 3] = bake.lamp_light(grass.roots.astype("f8"), up, lamps, []) / 4.0
        self._patches, self._centers = grass.patches, grass.centers
        self._vertices = ctx.buffer(data.tobytes())
        content = [(self._vertices, "3f4 4f1 4f4", "in_position", "in_color", "in_root")]

        def look(*defines: str) -> Look:
            program = compile_program(ctx, "grass.vert", "object.frag", "SOFT", *defines)
            block.attach(program)
            return program, [ctx.vertex_array(program, content)]

        self.looks = (Variants(look),)

    def draw(self, planes: NDArray, camera: NDArray, quality: Quality) -> None:
        """Draw the patches within reach."""
        reach = quality.grass_reach
        look = self.looks[0]
        look.program["reach"] = (reach * 0.6, reach)
        away = np.linalg.norm(self._centers - camera, axis=1)
        side = self._centers @ planes[:, :3].T + planes[:, 3]
        seen = (side > -8.0).all(axis=1) & (away < reach + 6.0)
        for first, count in self._patches[seen].tolist():
            look.arrays[0].render(moderngl.TRIANGLES, vertices=count, first=first)

    def release(self) -> None:
        """Give everything back."""
        release_all((*self.looks, self._vertices))
