"""The cloth of the flag by the cabin; its pole is part of the yard."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from demo_game.place import Place, bake, flag

from .frame_block import FrameBlock
from .programs import Look, Variants, compile_program, release_all

COLUMNS, ROWS = 24, 12


class Flag:
    """A grid that the vertex shader waves."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, place: Place) -> None:
        self._hoist = flag.hoist(place.terrain)
        lamps = [(lamp.position, max(lamp.color)) for lamp in place.lamps]
        light = bake.lamp_light(self._hoist[None], np.array([[0.0, 1.0, 0.0]]), lamps, [])
        self._vertices = ctx.buffer(grid().tobytes())
        content = [(self._vertices, "2f4 3f4", "in_grid", "in_color")]

        def look(*defines: str) -> Look:
            program = compile_program(ctx, "flag.vert", "object.frag", "SOFT", *defines)
            block.attach(program)
            program["hoist"] = (*self._hoist.tolist(), float(light[0]))
            program["size"] = flag.SIZE
            return program, [ctx.vertex_array(program, content)]

        self.looks = (Variants(look),)

    def draw(self, planes: NDArray, camera: NDArray) -> None:
        """Draw it where it may be seen, from both sides."""
        reach = float(np.hypot(*flag.SIZE))
        seen = (planes[:, :3] @ self._hoist + planes[:, 3] > -reach).all()
        if seen and np.linalg.norm(camera - self._hoist) < flag.SEEN:
            self.looks[0].arrays[0].render(moderngl.TRIANGLES)

    def release(self) -> None:
        """Give everything back."""
        release_all((*self.looks, self._vertices))


def grid() -> NDArray:
    """(6 COLUMNS ROWS, 5) f4: place along and down, 0..1, and colour, two triangles a cell."""
    corners = np.array([(0, 0), (1, 0), (1, 1), (0, 0), (1, 1), (0, 1)])
    column, row = np.meshgrid(np.arange(COLUMNS), np.arange(ROWS))
    cells = np.stack([column.ravel(), row.ravel()], 1)
    at = (cells[:, None] + corners) / (COLUMNS, ROWS)
    band = cells[:, 1] * len(flag.BANDS) // ROWS
    colors = np.repeat(np.array(flag.BANDS)[band][:, None], 6, axis=1)
    return np.concatenate([at, colors], axis=2).reshape(-1, 5).astype("f4")
