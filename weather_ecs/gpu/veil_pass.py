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
from weather_ecs.gpu.veil_list import TOGETHER, VEIL, Seen, fill, important, rays, rectangle
from weather_ecs.physics.front import SETTLED

DEPTH_UNIT = 0
COARSE = 4  # pixels on a side of a texel of the sheet
LARGE = 400  # pixels, height of a picture from which on the sky's veils are drawn coarser
FRONT = 1.2  # of the distance of the far plane: nothing of the scene stands beyond


class VeilPass:
    """Draws the veils of a view over the scene whose depth it is given.

    Before the empty sky they are soft, so that in large pictures they are drawn there into a
    coarse sheet that is then laid over it. Before the scene every pixel has its own.
    """

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader) -> None:
        self._ctx = ctx
        self._block = BlockBuffer(ctx, VEIL)
        self._shaders = shaders
        self._arrays: dict[ProgramKey, moderngl.VertexArray] = {}  # made when first needed
        over = shaders.program(ProgramKey(vertex="veil.vert", fragment="veil_over.frag"))
        self._over = self._array(over)
        self._sheet: moderngl.Texture | None = None
        self._target: moderngl.Framebuffer | None = None

    def _array(self, program: Any) -> moderngl.VertexArray:
        for name in ("scene_depth", "veil_sheet"):
            if name in program:
                program[name] = DEPTH_UNIT
        return self._ctx.vertex_array(program, [])

    def draw(
        self,
        view: ViewData,
        veils: Sequence[VeilData],
        depth: moderngl.Texture,
        guard: StateGuard | None = None,
    ) -> None:
        """Draw some of the view's. Blending on, depth test and culling off are the caller's.

        guard: of a framebuffer whose depth is `depth`, where the sheet may be used.
        """
        seen = important(view, veils)
        if not seen or not view.projection[3, 2]:
            return
        self._block.bind()
        self._block["veil_rays"][:, :3] = rays(view)
        if guard is None or guard.viewport[3] < LARGE:
            self._draw(view, seen, depth)
            return
        self._draw_sheet(view, seen, guard)
        p = view.projection
        past = 1.0 + float(p[2, 2])
        far = float(p[2, 3]) / past if abs(past) > 1e-9 else 1e9
        before = [each for each in seen if each.distance < FRONT * abs(far)]
        if before:
            # Only where something has been drawn.
            self._ctx.enable(moderngl.DEPTH_TEST)
            self._ctx.depth_func = ">"
            self._draw(view, before, depth)
            self._ctx.depth_func = "<="
            self._ctx.disable(moderngl.DEPTH_TEST)

    def _draw(self, view: ViewData, seen: Sequence[Seen], depth: moderngl.Texture | None) -> None:
        """Into what is bound; before an empty scene where there is no depth."""
        if depth is not None:
            depth.use(DEPTH_UNIT)
        place = "EMPTY" if depth is None else ""
        data = self._block.data
        for some in groups(seen):
            data["veil_frame"] = rectangle(view, some)
            fill(data, view, some)
            self._block.upload()
            look = "CURTAIN" if any(each.veil.ragged or each.veil.top for each in some) else ""
            dry = "" if some[0].veil.dry == SETTLED else "CHANGING"
            names = tuple([name for name in (place, look, dry) if name])
            count = 1 if len(some) == 1 else TOGETHER
            self._of(names, count).render(moderngl.TRIANGLE_STRIP, vertices=4)

    def _of(self, names: tuple[str, ...], count: int) -> moderngl.VertexArray:
        defines: tuple[str | Define, ...] = (("COUNT", count), *names)
        key = ProgramKey(vertex="veil.vert", fragment="veil.frag", defines=defines)
        if key not in self._arrays:
            self._arrays[key] = self._array(self._shaders.program(key))
        return self._arrays[key]

    def _draw_sheet(self, view: ViewData, seen: Sequence[Seen], guard: StateGuard) -> None:
        """The veils before the empty sky."""
        ctx = self._ctx
        _, _, width, height = guard.viewport
        target = self._target_of((-(-width // COARSE), -(-height // COARSE)))
        target.use()
        target.clear()
        blending: Any = ctx  # moderngl's stubs know no separate ones for alpha
        blending.blend_func = (
            moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA,
            moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA,
        )  # fmt: skip
        self._draw(view, seen, None)
        guard.bind_framebuffer()
        guard.gl.glDepthMask(0)
        ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        ctx.enable(moderngl.DEPTH_TEST)
        ctx.depth_func = "=="
        assert self._sheet is not None
        self._sheet.use(DEPTH_UNIT)
        self._block.data["veil_frame"] = rectangle(view, seen)
        self._block.upload()
        self._over.render(moderngl.TRIANGLE_STRIP, vertices=4)
        ctx.depth_func = "<="
        ctx.disable(moderngl.DEPTH_TEST)
        ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA

    def _target_of(self, size: tuple[int, int]) -> moderngl.Framebuffer:
        if self._target is None or self._target.size != size:
            self._drop()
            self._sheet = self._ctx.texture(size, 4, dtype="f1")
            self._sheet.filter = moderngl.LINEAR, moderngl.LINEAR
            self._sheet.repeat_x = self._sheet.repeat_y = False
            self._target = self._ctx.framebuffer([self._sheet])
        return self._target

    def _drop(self) -> None:
        if self._target is not None and self._sheet is not None:
            self._target.release()
            self._sheet.release()
            self._target = self._sheet = None

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self._drop()
        for array in (*self._arrays.values(), self._over):
            array.release()
        self._block.release()


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
