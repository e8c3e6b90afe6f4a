"""`RippleMap`: what a shader, ours or the game's, needs to draw rippled water."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import moderngl

from weather_ecs.gpu.host_program import set_uniform, use_maps

Four = tuple[float, float, float, float]


@dataclass(frozen=True, slots=True)
class RippleMap:
    """The ripples of one surface as they were drawn last; level where there are none.

    For a program whose shader includes `ripple_sample.glsl`. Good until the next draw.
    """

    texture: moderngl.Texture
    place: Four  # the shader's ripple_place
    scale: Four  # the shader's ripple_scale
    window: Four  # middle and half sizes of the part where real drops make rings, own axes, m

    def use(self, program: Any, unit: int = 0) -> None:
        """Bind the texture to a unit, and set the program's uniforms.

        The program is moderngl's, pyglet's, or the OpenGL name of one; InvalidValueError for
        anything else.
        """
        use_maps(program, unit, ripple_map=self.texture)
        set_uniform(program, self.texture.ctx, "ripple_place", self.place)
        set_uniform(program, self.texture.ctx, "ripple_scale", self.scale)
