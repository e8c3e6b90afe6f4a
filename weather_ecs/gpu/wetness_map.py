"""`WetnessMap`: what a game's own shader needs to know how wet its surfaces are."""

from __future__ import annotations

from typing import Any

import moderngl

from weather_ecs.gpu.blocks import BlockBuffer, UniformBlock
from weather_ecs.gpu.host_program import use_block, use_maps

# Spelled out once more in shaders/wetness.glsl, which games paste into their own shaders.
WEATHER_WETNESS = UniformBlock(
    "WeatherWetness",
    ("weather_wet_frame", "vec4"),  # middle, x and z at height 0, m; 1 / side in 1/m
    ("weather_wet_fall", "vec4"),  # horizontal m per m of fall, x and z; 1 where there is a map
    ("weather_wet_far_place", "vec4"),  # middle, x and z, m; 1 / side in 1/m
)
FIRST_UNIT = 14  # of two; at least 16 are there in every stage


class WetnessMap:
    """Water and snow around one observer as the last draw left it; the same object for good.

    For programs whose shader includes `wetness.glsl`. Before the first draw everything is dry.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._block = BlockBuffer(ctx, WEATHER_WETNESS)
        self._dry = ctx.texture((1, 1), 4, bytes(16), dtype="f4")
        self.texture = self.far = self._dry
        self.set((0.0, 0.0, 1.0), None, (0.0, 0.0, 1.0))

    def set(
        self,
        frame: tuple[float, float, float],
        fall: tuple[float, float] | None,
        far: tuple[float, float, float],
    ) -> None:
        """Places of map and far field, (x, z, side) in m, and the fall; None: there is no map."""
        if self._block.holds == (frame, fall, far):
            return
        self._block.holds = frame, fall, far
        data = self._block.data
        data["weather_wet_frame"] = (*frame[:2], 1.0 / frame[2], 0.0)
        data["weather_wet_fall"] = (0.0, 0.0, 0.0, 0.0) if fall is None else (*fall, 1.0, 0.0)
        data["weather_wet_far_place"] = (*far[:2], 1.0 / far[2], 0.0)
        self._block.upload()

    def use(self, program: Any, unit: int = FIRST_UNIT) -> None:
        """Bind the textures to two units from `unit` on, the block to the binding it has, and
        point the program's uniforms at them. What the shader does not use is left out.

        The program is moderngl's, pyglet's, or the OpenGL name of one; InvalidValueError for
        anything else. The textures stay bound.
        """
        use_maps(program, unit, weather_wet_map=self.texture, weather_wet_far=self.far)
        use_block(program, self._block)

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self._dry.release()
        self._block.release()
