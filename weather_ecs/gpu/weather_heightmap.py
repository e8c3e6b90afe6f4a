"""`WeatherHeightmap`: what rain meets first, for a game's own shaders."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.gpu.blocks import BlockBuffer, UniformBlock
from weather_ecs.gpu.heightmap import Heightmap
from weather_ecs.gpu.host_program import use_block, use_maps
from weather_ecs.physics.footprint import Footprint

# Spelled out once more in shaders/heightmap.glsl, which games paste into their own shaders.
WEATHER_HEIGHTMAP = UniformBlock(
    "WeatherHeightmap",
    ("weather_height_matrix", "mat4"),  # world to u, v and depth, all in [0, 1] in the map
    # Height at depth 0, m; how far down depth 1 is, m; side of a texel, m; 1 where there is a map.
    ("weather_height_range", "vec4"),
)
FIRST_UNIT = 13


class WeatherHeightmap:
    """The collision heightmap around one observer as the last draw left it; the same for good.

    For programs whose shader includes `heightmap.glsl`. Before the first draw in rain, and where
    there are no occluders, nothing is over anything.
    """

    def __init__(self, ctx: moderngl.Context, current: Callable[[], Heightmap | None]) -> None:
        self._current = current
        self._block = BlockBuffer(ctx, WEATHER_HEIGHTMAP)
        self._nothing = ctx.texture((1, 1), 1, np.ones(1, np.float32), dtype="f4")
        self._written: tuple[Footprint, int] | None = None
        self._block.upload()

    @property
    def texture(self) -> moderngl.Texture | None:
        """Depth of what rain meets, 0 at `top` to 1 at `bottom`; None where there is no map."""
        found = self._current()
        return None if found is None or found.footprint is None else found.texture

    @property
    def matrix(self) -> NDArray[np.float64] | None:
        """(4, 4) for column vectors, from the world to the map: u, v and depth in [0, 1]."""
        found = self._current()
        return None if found is None or found.footprint is None else found.footprint.matrix()

    def use(self, program: Any, unit: int = FIRST_UNIT) -> None:
        """Bind the texture to a unit, the block to the binding it has, and point the program's
        uniforms at them. What the shader does not use is left out.

        The program is moderngl's, pyglet's, or the OpenGL name of one; InvalidValueError for
        anything else. The texture stays bound.
        """
        found = self._current()
        if found is None or found.footprint is None:
            self._write(None, 0)
            use_maps(program, unit, weather_height_map=self._nothing)
        else:
            self._write(found.footprint, found.size)
            use_maps(program, unit, weather_height_map=found.texture)
        use_block(program, self._block)

    def _write(self, place: Footprint | None, size: int) -> None:
        new = None if place is None else (place, size)
        if new == self._written:
            return
        self._written, data = new, self._block.data
        if place is None:
            data["weather_height_range"] = (0.0, 1.0, 1.0, 0.0)
        else:
            self._block["weather_height_matrix"] = place.matrix()
            span = place.top - place.bottom
            data["weather_height_range"] = (place.top, span, 2.0 * place.half / size, 1.0)
        self._block.upload()

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self._nothing.release()
        self._block.release()
