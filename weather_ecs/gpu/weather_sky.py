"""`WeatherSky`: the sky's radiance by direction, for our passes and a game's own shaders."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np

from weather_ecs.frame import AtmosphereData, SkyLight
from weather_ecs.gpu.blocks import BlockBuffer, UniformBlock
from weather_ecs.gpu.host_program import use_block, use_maps
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.physics.atmosphere import COLUMNS, ROWS
from weather_ecs.physics.daylight import BLUE_SHIFT, LUMINANCE
from weather_ecs.physics.sky_map import SIZE

# Spelled out once more in shaders/sky.glsl, which games paste into their own shaders.
WEATHER_SKY_LIGHT = UniformBlock(
    "WeatherSkyLight",
    ("weather_sky_ground", "vec4"),  # linear RGB; 1 where there is a map, else 0
    ("weather_sky_zenith", "vec4"),
    ("weather_sky_horizon", "vec4"),
)
SKY_LIGHTS = UniformBlock(
    "SkyLights",
    ("sky_sun", "vec4"),  # direction
    ("sky_moon", "vec4"),
    ("sky_overcast", "vec4"),  # at the zenith
    ("sky_night", "vec4"),
    ("sky_haze", "vec4"),  # light of haze; its optical depth straight up
    ("sky_dark", "vec4"),  # colour that grey takes in the dark; share of it
)
BAKE = ProgramKey(vertex="fullscreen.vert", fragment="sky_map.frag")
UNIT = 12  # at least 16 are there in every stage
TABLES_UNIT = 0


class WeatherSky:
    """The sky as the last draw left it; the same object for good.

    For programs whose shader includes `sky.glsl`. Without an `Atmosphere` it is a gradient between
    the colours of the frame's light.
    """

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader) -> None:
        self._ctx = ctx
        self._program = shaders.program(BAKE)
        self._program["sky_tables"] = TABLES_UNIT
        self._array = ctx.vertex_array(self._program, [])
        self._lights = BlockBuffer(ctx, SKY_LIGHTS)
        self._block = BlockBuffer(ctx, WEATHER_SKY_LIGHT)
        self._tables = ctx.texture((COLUMNS, 4 * ROWS), 4, dtype="f4")
        self._texels = np.zeros((4, ROWS, COLUMNS, 4), np.float32)
        self.texture = ctx.texture((SIZE, SIZE), 4, dtype="f2")
        for texture in (self._tables, self.texture):
            texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
            texture.repeat_x = texture.repeat_y = False
        self._target = ctx.framebuffer([self.texture])
        self._made_of: tuple[AtmosphereData | None, SkyLight] | None = None

    def stale(self, data: AtmosphereData | None, light: SkyLight) -> bool:
        """Whether `update` would change something."""
        made = self._made_of
        return made is None or made[0] is not data or (data is None and made[1] is not light)

    def update(self, data: AtmosphereData | None, light: SkyLight) -> None:
        """Take over a frame's sky. Leaves another framebuffer and viewport bound."""
        if not self.stale(data, light):
            return
        self._made_of = (data, light)
        block = self._block.data
        ground = light.ground_color if data is None else data.ground_light
        block["weather_sky_ground"] = (*ground, float(data is not None))
        block["weather_sky_zenith"] = (*light.zenith_color, 0.0)
        block["weather_sky_horizon"] = (*light.horizon_color, 0.0)
        self._block.upload()
        if data is not None:
            self._bake(data)

    def _bake(self, data: AtmosphereData) -> None:
        lights = self._lights.data
        lights["sky_sun"] = (*data.sun_direction, 0.0)
        lights["sky_moon"] = (*data.moon_direction, 0.0)
        lights["sky_overcast"][:3] = data.overcast_light
        lights["sky_night"][:3] = data.night_light
        lights["sky_haze"] = (*data.haze_light, data.haze_depth)
        dark = BLUE_SHIFT / float(BLUE_SHIFT @ LUMINANCE)
        lights["sky_dark"] = (*dark, data.shift)
        self._lights.upload()
        texels = self._texels[..., :3]
        texels[0] = data.sun_air * data.sun_scale
        texels[1] = data.sun_haze * data.sun_scale
        texels[2] = data.moon_air * data.moon_scale
        texels[3] = data.moon_haze * data.moon_scale
        self._tables.write(self._texels)
        self._target.use()
        self._ctx.enable_only(moderngl.NOTHING)
        self._tables.use(TABLES_UNIT)
        self._lights.bind()
        self._array.render(moderngl.TRIANGLES, vertices=3)

    def use(self, program: Any, unit: int = UNIT) -> None:
        """Bind the map to a texture unit, the block to the binding it has, and point the program's
        uniforms at them. What the shader does not use is left out.

        The program is moderngl's, pyglet's, or the OpenGL name of one; InvalidValueError for
        anything else. The texture stays bound.
        """
        use_maps(program, unit, weather_sky_map=self.texture)
        use_block(program, self._block)

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for thing in (self._array, self._target, self.texture, self._tables):
            thing.release()
        self._lights.release()
        self._block.release()
