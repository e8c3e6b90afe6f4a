"""The still shadows on the ground, laid once into the alpha of its painted map."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

from demo_game.place import Place, paint

from .programs import compile_program, release_all, set_matrix, set_uniforms

HEIGHTS = 384  # texels of the height map that shadows are laid by


class GroundShadow:
    """Lays the shadows of what stands still on the painted map, where the sun has moved."""

    def __init__(self, ctx: moderngl.Context, place: Place, painted: moderngl.Texture) -> None:
        self.ctx, self.map = ctx, painted
        self._program = compile_program(ctx, "sky_bake.vert", "ground_shadow.frag")
        size = paint.HIGH - paint.LOW
        window = (*paint.LOW.tolist(), *(1.0 / size).tolist())
        set_uniforms(self._program, map_window=window, shadow_map=0, height_map=1)
        xs = paint.LOW[0] + (np.arange(HEIGHTS) + 0.5) * size[0] / HEIGHTS
        zs = paint.LOW[1] + (np.arange(HEIGHTS) + 0.5) * size[1] / HEIGHTS
        heights = np.asarray(place.height(*np.meshgrid(xs, zs)), "f4")
        self._heights = ctx.texture((HEIGHTS, HEIGHTS), 1, heights.tobytes(), dtype="f4")
        self._target = ctx.framebuffer([painted])
        self._target.color_mask = False, False, False, True
        self._quad = ctx.buffer(np.array([-1, -1, 3, -1, -1, 3], "f4"))
        self._array = ctx.vertex_array(self._program, [(self._quad, "2f4", "in_position")])

    def update(self, shadow_map: moderngl.Texture, lookup: NDArray) -> None:
        """Write the map's alpha."""
        set_matrix(self._program, "shadow_matrix", lookup)
        self.ctx.enable_only(moderngl.NOTHING)
        self._target.use()
        shadow_map.use(0)
        self._heights.use(1)
        self._array.render()
        self.map.build_mipmaps()

    def release(self) -> None:
        """Give everything back."""
        release_all((self._array, self._quad, self._target, self._heights, self._program))
