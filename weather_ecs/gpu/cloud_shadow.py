"""`CloudShadow`: what a game's own shader needs to know of the clouds' shadows on the ground."""

from __future__ import annotations

from typing import Any

import moderngl

from weather_ecs.gpu.blocks import BlockBuffer, UniformBlock
from weather_ecs.gpu.host_program import use_block, use_maps

# Spelled out once more in shaders/cloud_shadow.glsl, which games paste into their own shaders.
WEATHER_CLOUD_SHADOW = UniformBlock(
    "WeatherCloudShadow",
    ("weather_shadow_frame", "vec4"),  # middle, x and z, m; 1 / side in 1/m; strength, 0: no map
    ("weather_shadow_sun", "vec4"),  # horizontal m per m of height, x and z; height of the map, m
)
UNIT = 11  # of its own, so that one shader may read all maps; 16 are there in every stage


class CloudShadow:
    """The shadows around one observer as the last draw left them; the same object for good.

    For programs whose shader includes `cloud_shadow.glsl`. Before the first draw all is in the sun.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._block = BlockBuffer(ctx, WEATHER_CLOUD_SHADOW)
        self._light = ctx.texture((1, 1), 1, b"\xff")
        self.texture: moderngl.Texture = self._light
        self.set((0.0, 0.0, 1.0), (0.0, 0.0), 0.0, 0.0)

    def set(
        self,
        frame: tuple[float, float, float],
        slope: tuple[float, float],
        height: float,
        strength: float,
    ) -> None:
        """Place (x, z, side) in m of the map at a height, the sun's slope, and how dark it is."""
        data = self._block.data
        data["weather_shadow_frame"] = (*frame[:2], 1.0 / frame[2], strength)
        data["weather_shadow_sun"] = (*slope, height, 0.0)
        self._block.upload()

    def use(self, program: Any, unit: int = UNIT) -> None:
        """Bind the map to a texture unit, the block to the binding it has, and point the program's
        uniforms at them. What the shader does not use is left out.

        The program is moderngl's, pyglet's, or the OpenGL name of one; InvalidValueError for
        anything else. The texture stays bound.
        """
        use_maps(program, unit, weather_shadow_map=self.texture)
        use_block(program, self._block)

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self._light.release()
        self._block.release()
