"""The veil: rain beyond what the drops show, one box per area and a closed integral per pixel."""

from __future__ import annotations

from collections.abc import Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import FrameData, VeilData, ViewData
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.flake_blocks import flake_light
from weather_ecs.gpu.flash import VEIL as VEIL_FLASH
from weather_ecs.gpu.flash import flash_of
from weather_ecs.gpu.rain_blocks import VEIL
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.gpu.view_block import encode, veil_light

DRAW = ProgramKey(vertex="veil.vert", fragment="veil.frag")
DEPTH_UNIT = 0


class VeilPass:
    """Draws the veils of a view over the scene whose depth it is given."""

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader) -> None:
        self._ctx = ctx
        self._program = shaders.program(DRAW)
        self._program["scene_depth"] = DEPTH_UNIT
        self._array = ctx.vertex_array(self._program, [])
        self._block = BlockBuffer(ctx, VEIL)

    def draw(self, view: ViewData, veils: Sequence[VeilData], depth: moderngl.Texture) -> None:
        """Draw some of the view's.

        Depth test off, culling of front faces and blending on are the caller's.
        """
        depth.use(DEPTH_UNIT)
        self._block.bind()
        data = self._block.data
        flash = flash_of(view.frame, view.position)
        more = np.zeros(3) if flash is None else VEIL_FLASH * flash.here
        rain = encode(veil_light(view.frame.sky) + more)
        for veil in veils:
            data["veil_axis"] = veil.axis
            data["veil_shape"] = (*veil.shape, 0.0)
            data["veil_span"] = (*veil.span, 0.0, 0.0)
            data["veil_load"] = (veil.extinction, veil.shown, veil.slope, 0.0)
            data["veil_dry"] = veil.dry
            snow = veil.snow
            data["veil_tint"][:3] = encode(mixed(view.frame, snow) + more) if snow > 0.0 else rain
            self._block.upload()
            self._array.render(moderngl.TRIANGLE_STRIP, vertices=14)

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self._array.release()
        self._block.release()


def mixed(frame: FrameData, snow: float) -> NDArray:
    """Colour of a veil of which a share is snow, linear RGB: snow is white in the same light."""
    sun = np.array(frame.sky.sun_color) * 0.22
    white = frame.flakes.brightness * flake_light(frame.sky) + sun
    return (1.0 - snow) * veil_light(frame.sky) + snow * white
