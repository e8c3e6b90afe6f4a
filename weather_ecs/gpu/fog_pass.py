"""Fog over the whole picture, for games that cannot change their shaders."""

from __future__ import annotations

import moderngl

from weather_ecs.frame import ViewData
from weather_ecs.gpu.blocks import BlockBuffer, UniformBlock
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.gpu.view_block import LOG2_E
from weather_ecs.physics.optics import CLEAR, EARTH, falling_extinction
from weather_ecs.physics.phase import share_at, temperature_at
from weather_ecs.physics.rain_field import RainField

FOG_VIEW = UniformBlock(
    "FogView",
    ("fog_frustum", "vec4"),  # 1 / the projection's diagonal, and its off-centre shares
    ("fog_up", "vec4"),  # world's upwards, in the camera's axes
    # Optical depth times log2(e): per m times the depth's numerator, of the layer overhead; square
    # of the sine of the elevation below which the Earth's roundness ends the layer.
    ("fog_law", "vec4"),
)
DRAW = ProgramKey(vertex="fog.vert", fragment="fog.frag")
DEPTH_UNIT = 0


class FogPass:
    """Blends a view's fog over the scene whose depth it is given."""

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader) -> None:
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
        data["fog_up"] = (*view.view[:3, 1].tolist(), 0.0)
        # Clean air is in the host's sky already.
        overhead = max(fog.extinction - CLEAR, 0.0) * fog.depth
        rim = max(2.0 * fog.depth / EARTH, 1e-9)
        near = abs(float(p[2, 3])) * extinction
        data["fog_law"] = (near * LOG2_E, overhead * LOG2_E, rim, 0.0)
        self._block.upload()
        self._block.bind()
        depth.use(DEPTH_UNIT)
        self._array.render(moderngl.TRIANGLES, vertices=3)

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
