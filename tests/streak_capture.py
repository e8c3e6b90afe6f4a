"""Streaks of drops of a test's choosing: what the vertex shader hands on, and what is drawn."""

from __future__ import annotations

from typing import NamedTuple

import moderngl
import numpy as np

from weather_ecs.frame import ContainerData, ViewData
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.rain_blocks import RAIN_DRAW, RAIN_VIEW
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.gpu.view_block import drop_light, fill_view
from weather_ecs.physics.streak import StreakLaw, StreakView

DRAW = ProgramKey(vertex="streak.vert", geometry="streak.geom", fragment="streak.frag")
KEY = ProgramKey(vertex="streak.vert", varyings=("vs_tail", "vs_head", "vs_color", "vs_width"))
FADE = 0.1


class Captured(NamedTuple):
    """Each (n, 4), width (n,)."""

    tail: np.ndarray
    head: np.ndarray
    color: np.ndarray
    width: np.ndarray


def law_of(container: ContainerData, view: ViewData) -> StreakLaw:
    look = view.frame.look
    return StreakLaw(
        container.axis, container.shape, container.area_axis, container.area_shape,
        container.law, container.load, container.count, 1.0 / max(FADE * container.count, 1.0),
        look.size_maximum, container.size_scale, look.width, look.opacity, look.density,
        container.dry,
    )  # fmt: skip


def view_of(view: ViewData, height: int) -> StreakView:
    """The oracle's view for a picture of so many pixels' height; observers slower than a limit."""
    look, sky, rows = view.frame.look, view.frame.sky, view.frame.lights
    return StreakView(
        view.projection @ view.view,
        view.position,
        view.velocity,
        look.exposure,
        0.5 * height * float(view.projection[1, 1]),
        (height * float(view.projection[1, 1] / view.projection[0, 0]), height),
        sky.sun_direction,
        sky.sun_color,
        tuple((view.frame.look.brightness * drop_light(sky)).tolist()),
        np.column_stack([rows["position"], rows["reach"], rows["color"]]),
        view.frame.fog.color,
        view.frame.fog.extinction,
    )


class StreakCapture:
    """Runs the shaders over drops at p with velocities v, as `container` in `view` has them."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._ctx = ctx
        self._shaders = ShaderLoader(ctx)
        self._program = self._shaders.program(KEY)
        self._view = BlockBuffer(ctx, RAIN_VIEW)
        self._draw = BlockBuffer(ctx, RAIN_DRAW)
        # Without a complete framebuffer some drivers write nothing in transform feedback.
        self._color = ctx.renderbuffer((8, 8))
        self._target = ctx.framebuffer([self._color])

    def run(
        self,
        p: np.ndarray,
        v: np.ndarray,
        birth: np.ndarray,
        view: ViewData,
        container: ContainerData,
        size: tuple[int, int] = (320, 180),
    ) -> Captured:
        """The vertex shader's outputs, by transform feedback."""
        self._fill(view, container, size)
        drops, array = self._array(self._program, p, v, birth)
        out = self._ctx.buffer(reserve=len(p) * 52)
        self._target.use()
        array.transform(out, moderngl.POINTS, vertices=len(p))
        found = np.frombuffer(out.read(), np.float32).reshape(-1, 13)
        for thing in (array, out, drops):
            thing.release()
        return Captured(found[:, :4], found[:, 4:8], found[:, 8:12], found[:, 12])

    def opacity(
        self,
        p: np.ndarray,
        v: np.ndarray,
        birth: np.ndarray,
        view: ViewData,
        container: ContainerData,
        size: tuple[int, int] = (320, 180),
    ) -> np.ndarray:
        """The streaks drawn: sum of their opacities in each pixel, (height, width)."""
        self._fill(view, container, size)
        drops, array = self._array(self._shaders.program(DRAW), p, v, birth)
        ctx = self._ctx
        color = ctx.texture(size, 4, dtype="f4")
        target = ctx.framebuffer([color])
        target.use()
        target.clear()
        ctx.enable_only(moderngl.BLEND)
        ctx.blend_func = moderngl.ONE, moderngl.ONE
        array.render(moderngl.POINTS, vertices=len(p))
        ctx.blend_func = moderngl.DEFAULT_BLENDING
        found = np.frombuffer(target.read(components=4, dtype="f4"), np.float32)
        for thing in (array, drops, target, color):
            thing.release()
        return found.reshape(size[1], size[0], 4)[..., 3]

    def _fill(self, view: ViewData, container: ContainerData, size: tuple[int, int]) -> None:
        law = law_of(container, view)
        fill_view(self._view, view, (0, 0, *size))
        data = self._draw.data
        data["container_axis"], data["container_shape"] = law.container_axis, law.container_shape
        data["area_axis"], data["area_shape"] = law.area_axis, law.area_shape
        data["drop_law"], data["drop_dry"] = law.law, law.dry
        data["drop_load"] = (law.load, law.count, law.fade, law.density)
        data["drop_look"] = (law.size_maximum, law.size_scale, law.width, law.opacity)
        for block in (self._view, self._draw):
            block.upload()
            block.bind()

    def _array(
        self, program: moderngl.Program, p: np.ndarray, v: np.ndarray, birth: np.ndarray
    ) -> tuple[moderngl.Buffer, moderngl.VertexArray]:
        drops = self._ctx.buffer(np.hstack([p, v, birth]).astype(np.float32))
        names = ("in_position", "in_velocity", "in_birth")
        return drops, self._ctx.vertex_array(program, [(drops, "3f 3f 4f", *names)])

    def release(self) -> None:
        things = (self._target, self._color, self._draw, self._view, self._shaders)
        for thing in things:
            thing.release()
