"""Canvases: textures smaller than the picture, on which near clouds are painted every draw."""

from __future__ import annotations

from typing import Any

import moderngl

from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.cloud_groups import Group
from weather_ecs.gpu.cloud_hidden import below
from weather_ecs.gpu.cloud_programs import UNITS, CloudPrograms
from weather_ecs.gpu.cloud_sequence import Items
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader

SHOW = ProgramKey(vertex="cloud_canvas.vert", fragment="cloud_canvas.frag")
UNIT = UNITS["cloud_seeds"]  # which clouds of a canvas do without


class Canvas:
    """One texture, premultiplied and encoded."""

    def __init__(self, ctx: moderngl.Context, size: tuple[int, int]) -> None:
        self.texture = ctx.texture(size, 4)
        self.texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        self.texture.repeat_x = self.texture.repeat_y = False
        self.framebuffer = ctx.framebuffer([self.texture])

    def release(self) -> None:
        self.framebuffer.release()
        self.texture.release()


class CloudCanvases:
    """`paint` fills one for each group, `show` puts it into the picture."""

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader) -> None:
        self._ctx = ctx
        self._program = shaders.program(SHOW)
        self._program["cloud_canvas"] = UNIT
        self._array = ctx.vertex_array(self._program, [])
        self._kept: dict[tuple[int, int, int], Canvas] = {}  # by size and number
        self._size = (0, 0)
        self._shown: list[Canvas] = []

    def paint(
        self, groups: list[Group], items: Items, programs: CloudPrograms,
        size: tuple[int, int], low: float,
    ) -> None:  # fmt: skip
        """Paint what the groups hold, above a height. Changes framebuffer and state.

        size: of the picture, pixels; low: the height in it, -1 to 1.

        What the programs draw, they draw for the picture's camera.
        """
        if size != self._size:
            self.clear()
            self._size = size
        self._shown = []
        self._ctx.enable_only(moderngl.BLEND)
        self._ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        for number, group in enumerate(groups):
            canvas = self._canvas(group.factor, number)
            self._shown.append(canvas)
            canvas.framebuffer.use()
            canvas.framebuffer.clear(0.0, 0.0, 0.0, 0.0)
            programs.meet_from(size, canvas.texture.size, group.depth)
            width, height = canvas.texture.size
            framebuffer: Any = canvas.framebuffer  # moderngl's stubs know no scissor of None
            framebuffer.scissor = 0, below(low, height), width, height
            programs.draw(items.part(group.first, group.last))
            framebuffer.scissor = None

    def _canvas(self, factor: int, number: int) -> Canvas:
        width, height = (-(-side // factor) for side in self._size)
        key = (width, height, number)
        found = self._kept.get(key)
        if found is None:
            found = self._kept[key] = Canvas(self._ctx, (width, height))
        return found

    def show(self, number: int, group: Group) -> None:
        """Blending for premultiplied colours and the depth test are the caller's."""
        self._shown[number].texture.use(UNIT)
        self._program["canvas_depth"] = group.depth
        self._program["canvas_rectangle"] = group.rectangle
        # Beyond the host's far plane there are clouds too.
        self._ctx.enable_direct(e.DEPTH_CLAMP)
        self._array.render(moderngl.TRIANGLE_STRIP, vertices=4)
        self._ctx.disable_direct(e.DEPTH_CLAMP)

    def clear(self) -> None:
        """Give all textures back."""
        for canvas in self._kept.values():
            canvas.release()
        self._kept.clear()
        self._shown = []

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self.clear()
        self._array.release()
