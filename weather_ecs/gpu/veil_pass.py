"""The veil: rain beyond what the drops show, a closed integral per pixel and area."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from typing import Any

import moderngl

from weather_ecs.frame import VeilData, ViewData
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.guard import StateGuard
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.gpu.shader_source import Define
from weather_ecs.gpu.veil_list import (
    TOGETHER,
    VEIL,
    Seen,
    fill,
    important,
    nearest,
    rays,
    rectangle,
)
from weather_ecs.gpu.veil_sheet import VeilSheet
from weather_ecs.physics.front import SETTLED

DEPTH_UNIT, SHEET_UNIT = 0, 1
COARSE = 4  # pixels on a side of a texel of the sheets
LARGE = 400  # pixels, height of a picture from which on veils are drawn coarser
WIDE = 600.0  # m, radius of areas before whose ends most of what stands in the picture stands
BEYOND = 1.2  # of the distance of the far plane: nothing of the scene stands there
MIX = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA


class VeilPass:
    """Draws the veils of a view over the scene whose depth it is given.

    Several wide ones in large pictures by way of two coarse sheets: of what is before the empty
    sky, and of the optical depth for a km before the scene, of which every pixel takes its own
    share. Of small areas, which end among the things of the scene, it would be too little: they are
    drawn pixel for pixel, each where the scene is not nearer than all of it. So is the only wide
    one, for which two sheets and what lays them over the picture would cost more.
    """

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader) -> None:
        self._ctx = ctx
        self._block = BlockBuffer(ctx, VEIL)
        self._shaders = shaders
        self._arrays: dict[ProgramKey, moderngl.VertexArray] = {}  # made when first needed
        self._sheets = (VeilSheet(ctx, "f1"), VeilSheet(ctx, "f2"))  # before sky and scene

    def draw(
        self,
        view: ViewData,
        veils: Sequence[VeilData],
        depth: moderngl.Texture,
        guard: StateGuard | None = None,
    ) -> None:
        """Draw some of the view's. Blending on, depth test and culling off are the caller's.

        guard: of a framebuffer whose depth is `depth`, where the sheets may be used.
        """
        seen = important(view, veils)
        if not seen or not view.projection[3, 2]:
            return
        self._block.bind()
        self._block["veil_rays"][:, :3] = rays(view)
        if guard is None or guard.viewport[3] < LARGE:
            depth.use(DEPTH_UNIT)
            self._draw(view, seen)
            return
        p = view.projection
        past = 1.0 + float(p[2, 2])
        far = abs(float(p[2, 3]) / past) if abs(past) > 1e-9 else 1e9
        small, wide = halves(seen)
        if wide:
            self._draw_sheet(view, wide, guard, None)
            before = [each for each in wide if each.distance < BEYOND * far]
            if before:
                self._draw_sheet(view, before, guard, depth)
        if small:
            depth.use(DEPTH_UNIT)
            self._ctx.enable(moderngl.DEPTH_TEST)
            for each in sorted(small, key=lambda each: -each.distance):
                self._draw_alone(view, each)
            self._ctx.disable(moderngl.DEPTH_TEST)

    def _draw_alone(self, view: ViewData, each: Seen) -> None:
        data = self._block.data
        frame = rectangle(view, [each])
        data["veil_frame"] = frame
        data["veil_place"] = nearest(view, each, frame)
        fill(data, view, [each])
        self._block.upload()
        below = ("BELOW",) if view.position[1] < each.veil.span[1] else ()
        self._render("veil.frag", ("ALONE", *below, ("COUNT", 1), *look([each])))

    def _draw(self, view: ViewData, seen: Sequence[Seen], place: str = "") -> None:
        """Into what is bound. place: what the rays end at, if not each at the scene's own depth."""
        data = self._block.data
        for some in groups(seen):
            data["veil_frame"] = rectangle(view, some)
            data["veil_place"] = 1.0
            fill(data, view, some)
            self._block.upload()
            count = ("COUNT", 1 if len(some) == 1 else TOGETHER)
            self._render("veil.frag", (*((place,) if place else ()), count, *look(some)))

    def _render(self, fragment: str, defines: tuple[str | Define, ...] = ()) -> None:
        key = ProgramKey(vertex="veil.vert", fragment=fragment, defines=defines)
        if key not in self._arrays:
            program = self._shaders.program(key)
            for name, unit in (("scene_depth", DEPTH_UNIT), ("veil_sheet", SHEET_UNIT)):
                if name in program:
                    program[name] = unit
            self._arrays[key] = self._ctx.vertex_array(program, [])
        self._arrays[key].render(moderngl.TRIANGLE_STRIP, vertices=4)

    def _draw_sheet(
        self,
        view: ViewData,
        seen: Sequence[Seen],
        guard: StateGuard,
        depth: moderngl.Texture | None,
    ) -> None:
        """The veils before the empty sky, or before a scene of this depth."""
        ctx: Any = self._ctx  # moderngl's stubs know no separate blending for alpha
        _, _, width, height = guard.viewport
        sheet = self._sheets[0 if depth is None else 1]
        sheet.begin((-(-width // COARSE), -(-height // COARSE)))
        if depth is None:
            ctx.blend_func = (*MIX, moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA)
        else:
            depth.use(DEPTH_UNIT)
            ctx.blend_func = moderngl.ONE, moderngl.ONE
        self._draw(view, seen, "EMPTY" if depth is None else "SCENE")
        guard.bind_framebuffer()
        guard.gl.glDepthMask(0)
        sheet.use(SHEET_UNIT)
        ctx.enable(moderngl.DEPTH_TEST)
        self._block.data["veil_frame"] = rectangle(view, seen)
        self._block.data["veil_place"] = 1.0  # of the empty sky
        self._block.upload()
        if depth is None:
            ctx.depth_func = "=="
            ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
            self._render("veil_over.frag")
        else:
            ctx.depth_func = ">"
            ctx.blend_func = MIX
            self._render("veil_scene.frag")
        ctx.depth_func = "<="
        ctx.disable(moderngl.DEPTH_TEST)
        ctx.blend_func = MIX

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for sheet in self._sheets:
            sheet.release()
        for array in self._arrays.values():
            array.release()
        self._block.release()


def halves(seen: Sequence[Seen]) -> tuple[list[Seen], list[Seen]]:
    """Those that are drawn pixel for pixel, and those by way of the sheets."""
    wide = [each for each in seen if each.veil.shape[0] >= WIDE]
    if len(wide) == 1 and wide[0].veil.dry == SETTLED:
        return list(seen), []
    return [each for each in seen if each.veil.shape[0] < WIDE], wide


def look(some: Sequence[Seen]) -> tuple[str, ...]:
    """What the shader must know how to draw."""
    curtain = any(each.veil.ragged or each.veil.top for each in some)
    darker = any(each.veil.cloud for each in some)
    changing = some[0].veil.dry != SETTLED
    shown = any(each.veil.shown for each in some)
    names = (curtain, "CURTAIN"), (darker, "DARKER"), (changing, "CHANGING"), (shown, "SHOWN")
    return tuple([name for there, name in names if there])


def groups(seen: Sequence[Seen]) -> Iterator[list[Seen]]:
    """The farthest first, TOGETHER at a time; alone what begins or ends."""
    order = sorted(seen, key=lambda each: -each.distance)
    settled = [each for each in order if each.veil.dry == SETTLED]
    for each in order:
        if each.veil.dry != SETTLED:
            yield [each]
    first = len(settled) % TOGETHER
    if first:
        yield settled[:first]
    for k in range(first, len(settled), TOGETHER):
        yield settled[k : k + TOGETHER]
