"""Fog over the whole picture, for games that cannot change their shaders."""

from __future__ import annotations

import moderngl

from weather_ecs.frame import ViewData
from weather_ecs.gpu.blocks import BlockBuffer, UniformBlock
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.gpu.view_block import LOG2_E
from weather_ecs.physics.optics import CLEAR, falling_extinction, layer_rim
from weather_ecs.physics.phase import share_at, temperature_at
from weather_ecs.physics.rain_field import RainField

FOG_VIEW = UniformBlock(
    "FogView",
    ("fog_frustum", "vec4"),  # 1 / the projection's diagonal, and its off-centre shares
    ("fog_up", "vec4"),  # world's upwards, in the camera's axes; unit of the rays' rise
    # Optical depth times log2(e) of a scene whose depth and the second add up to 1; the rise, in
    # its unit, that a level ray has on the round Earth.
    ("fog_law", "vec4"),
)
DRAW = ProgramKey(vertex="fog.vert", fragment="fog.frag")
DEPTH_UNIT = 0


class FogPass:
    """Blends a view's fog over the scene whose depth it is given."""

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader) -> None:
        self._ctx = ctx
        self._program = shaders.program(DRAW)
        self._program["scene_depth"] = DEPTH_UNIT
        self._array = ctx.vertex_array(self._program, [])
        self._block = BlockBuffer(ctx, FOG_VIEW)

    def draws(self, view: ViewData) -> bool:
        """Whether there is fog to draw; a picture without perspective has no distances."""
        return view.frame.fog.draw and bool(view.projection[3, 2])

    def draw(self, view: ViewData, depth: moderngl.Texture) -> None:
        """Depth test off and blending on are the caller's."""
        fog, p = view.frame.fog, view.projection
        # What falls where the observer stands is the veils' work, where there are any.
        extinction = fog.extinction + (0.0 if view.veils else falling_here(view))
        data = self._block.data
        data["fog_frustum"] = (1.0 / p[0, 0], 1.0 / p[1, 1], p[0, 2], p[1, 2])
        # t = near / (depth + beyond), as the projection's third row has it.
        near, beyond = 0.5 * abs(float(p[2, 3])), 0.5 * (float(p[2, 2]) - 1.0)
        unit = near * extinction * LOG2_E
        # The fog's layer, from clean air on, which the host's sky has already: its optical depth is
        # the unit over the rise then.
        overhead = max(fog.extinction - CLEAR, 1e-12) * max(fog.depth, 1e-6) * LOG2_E
        rise = unit / overhead
        data["fog_up"] = (*view.view[:3, 1].tolist(), rise)
        data["fog_law"] = (unit, beyond, rise * layer_rim(fog.depth), 0.0)
        self._block.upload()
        self._block.bind()
        depth.use(DEPTH_UNIT)
        self._ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        self._array.render(moderngl.TRIANGLES, vertices=3)
        self._ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self._array.release()
        self._block.release()


def falling_here(view: ViewData) -> float:
    """Extinction (1/m) of the rain and snow at the observer."""
    frame, (x, y, z) = view.frame, view.position
    if not len(frame.areas):
        return 0.0
    rate = RainField(frame.areas, frame.fronts).rate(x, y, z)
    snow = rate * share_at(temperature_at(frame.air.temperature, y), frame.air.humidity)
    return falling_extinction(rate - snow, snow)
