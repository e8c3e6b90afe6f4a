"""Canvases: textures smaller than the picture, on which clouds are painted every draw."""

from __future__ import annotations

import math
from typing import Any

import moderngl

from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.cloud_groups import Group
from weather_ecs.gpu.cloud_hidden import below
from weather_ecs.gpu.cloud_programs import UNITS, CloudPrograms
from weather_ecs.gpu.cloud_sequence import PICTURES, Items
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader

FAR = ProgramKey(vertex="cloud_far.vert", fragment="cloud_far.frag")
SHOW = ProgramKey(vertex="cloud_canvas.vert", fragment="cloud_canvas.frag")
UNIT = UNITS["cloud_seeds"]  # which clouds of a canvas do without
KEPT = 64  # times that others are painted, until canvases of a picture's size are given back
SIZES = 4  # of pictures whose canvases are kept, at most


class Canvas:
    """One texture, premultiplied and encoded, and what of the scene is beyond its guard."""

    def __init__(self, ctx: moderngl.Context, size: tuple[int, int]) -> None:
        self.texture = ctx.texture(size, 4)
        self.texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        self.texture.repeat_x = self.texture.repeat_y = False
        self.depth = ctx.depth_renderbuffer(size)
        self.framebuffer = ctx.framebuffer([self.texture], self.depth)

    def release(self) -> None:
        self.framebuffer.release()
        self.depth.release()
        self.texture.release()


class CloudCanvases:
    """`paint` fills one for each group, `show` puts it into the picture."""

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader) -> None:
        self._ctx = ctx
        self._program = shaders.program(SHOW)
        self._program["cloud_canvas"] = UNIT
        self._far = shaders.program(FAR)
        self._far["scene_depth"] = UNITS["scene_depth"]
        self._arrays = [ctx.vertex_array(each, []) for each in (self._program, self._far)]
        # By number and factor, of each size of a picture: observers may have several.
        self._kept: dict[tuple[int, int], dict[tuple[int, int], Canvas]] = {}
        self._asked: dict[tuple[int, int], int] = {}  # when for each size
        self._times = 0
        self._size = (0, 0)
        self._shown: list[Canvas] = []
        self._used = 0

    def paint(
        self, groups: list[Group], items: Items, programs: CloudPrograms,
        size: tuple[int, int], low: float,
    ) -> None:  # fmt: skip
        """Paint what the groups hold, above a height. Changes framebuffer and state.

        size: of the picture, pixels; low: the height in it, -1 to 1.

        What the programs draw, they draw for the picture's camera.
        """
        self._size = size
        self._times += 1
        self._asked.pop(size, None)
        self._asked[size] = self._times  # the latest comes last
        self._forget_unused()
        self._used = 0
        self._shown = [self._paint(group, items, programs, low) for group in groups]

    def _paint(self, group: Group, items: Items, programs: CloudPrograms, low: float) -> Canvas:
        inner = [self._paint(each, items, programs, low) for each in group.inner]
        canvas = self._canvas(group.factor)
        width, height = canvas.texture.size
        framebuffer: Any = canvas.framebuffer  # moderngl's stubs know no scissor of None
        framebuffer.depth_mask = True
        framebuffer.use()
        framebuffer.clear(0.0, 0.0, 0.0, 0.0, depth=1.0)
        framebuffer.scissor = _part(group.rectangle, low, width, height)
        if items.shows(group.first, group.last, PICTURES):
            self._find_far(group)
        framebuffer.depth_mask = False
        self._ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        self._ctx.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST)
        programs.meet_from(self._size, canvas.texture.size, group.depth)
        first = group.first
        for each, painted in zip(group.inner, inner, strict=True):
            programs.draw(items.part(first, each.first))
            self._ctx.disable(moderngl.DEPTH_TEST)
            self._show(painted, each)
            self._ctx.enable(moderngl.DEPTH_TEST)
            first = each.last
        programs.draw(items.part(first, group.last))
        framebuffer.scissor = None
        return canvas

    def _find_far(self, group: Group) -> None:
        """Put in the scene's depth where it is beyond the guard, of a group's pictures."""
        self._ctx.enable_only(moderngl.DEPTH_TEST)
        self._ctx.depth_func = "1"
        self._far["canvas_depth"], self._far["canvas_factor"] = group.depth, group.factor
        self._arrays[1].render(moderngl.TRIANGLES, vertices=3)
        self._ctx.depth_func = "<="

    def _canvas(self, factor: int) -> Canvas:
        width, height = (-(-side // factor) for side in self._size)
        key = self._used, factor
        self._used += 1
        kept = self._kept.setdefault(self._size, {})
        found = kept.get(key)
        if found is None:
            found = kept[key] = Canvas(self._ctx, (width, height))
        return found

    def _forget_unused(self) -> None:
        """Give back what was made for a size that no picture has any more."""
        sizes = list(self._asked)
        gone = [size for size in sizes[:-1] if self._asked[size] + KEPT < self._times]
        for size in {*gone, *sizes[:-SIZES]}:
            del self._asked[size]
            for canvas in self._kept.pop(size, {}).values():
                canvas.release()

    def show(self, number: int, group: Group) -> None:
        """Blending for premultiplied colours and the depth test are the caller's."""
        self._show(self._shown[number], group)

    def _show(self, canvas: Canvas, group: Group) -> None:
        canvas.texture.use(UNIT)
        self._program["canvas_depth"] = group.depth
        self._program["canvas_rectangle"] = group.rectangle
        # Beyond the host's far plane there are clouds too.
        self._ctx.enable_direct(e.DEPTH_CLAMP)
        self._arrays[0].render(moderngl.TRIANGLE_STRIP, vertices=4)
        self._ctx.disable_direct(e.DEPTH_CLAMP)

    def clear(self) -> None:
        """Give all textures back."""
        for kept in self._kept.values():
            for canvas in kept.values():
                canvas.release()
        self._kept.clear()
        self._asked.clear()
        self._shown = []

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self.clear()
        for array in self._arrays:
            array.release()


def _part(
    rectangle: tuple[float, float, float, float], low: float, width: int, height: int
) -> tuple[int, int, int, int]:
    """Column, row, width and height of what a rectangle holds of a canvas above a height."""
    left, right = (0.5 * width * (1.0 + x) for x in rectangle[::2])
    first, last = max(math.floor(left) - 1, 0), min(math.ceil(right) + 1, width)
    bottom = max(below(max(rectangle[1], low), height) - 1, 0)
    top = min(below(rectangle[3], height) + 2, height)
    # Wholly below that height there is nothing to paint, and OpenGL knows no height below 0.
    return first, bottom, last - first, max(top - bottom, 0)
