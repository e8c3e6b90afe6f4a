"""The state guard with hosts of every kind: their framebuffers, flags and buffers."""

from __future__ import annotations

import ctypes
from typing import Any

import moderngl
import numpy as np
import pytest

from tests.guard_targets import FILL, WHITE, Keep, make_target
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.guard import StateGuard


@pytest.fixture
def guard(ctx: moderngl.Context, gl: GL, keep: Keep) -> StateGuard:
    return keep(StateGuard(ctx, gl))


@pytest.fixture
def fill(ctx: moderngl.Context, keep: Keep) -> moderngl.VertexArray:
    """A triangle that covers the viewport in white."""
    program = keep(ctx.program(vertex_shader=FILL, fragment_shader=WHITE))
    return keep(ctx.vertex_array(program, []))


def pixels(target: moderngl.Framebuffer) -> np.ndarray:
    raw = target.read(components=4)
    return np.frombuffer(raw, np.uint8).reshape(target.height, target.width, 4)


def test_drawing_goes_to_the_hosts_moderngl_framebuffer(
    ctx: moderngl.Context, guard: StateGuard, keep: Keep, fill: moderngl.VertexArray
) -> None:
    target, other = make_target(ctx, keep, (16, 8)), make_target(ctx, keep, (4, 4))
    target.use()
    target.viewport = (4, 2, 8, 4)
    target.scissor = (0, 0, 1, 1)
    with guard:
        assert guard.framebuffer is target
        assert guard.viewport == (4, 2, 8, 4)
        other.use()
        fill.render(moderngl.TRIANGLES, vertices=3)
        guard.bind_framebuffer()
        fill.render(moderngl.TRIANGLES, vertices=3)
    assert ctx.fbo is target
    assert target.viewport == (4, 2, 8, 4)
    assert target.scissor == (0, 0, 1, 1)
    target.scissor = None
    white = pixels(target)[..., 0] == 255
    assert white.sum() == 32
    assert white[2:6, 4:12].all()
    assert (pixels(other) == 255).all()


def test_drawing_goes_to_a_framebuffer_bound_without_moderngl(
    ctx: moderngl.Context, gl: GL, guard: StateGuard, keep: Keep, fill: moderngl.VertexArray
) -> None:
    target, known = make_target(ctx, keep, (16, 8)), make_target(ctx, keep, (4, 4))
    known.use()
    gl.glBindFramebuffer(0x8D40, target.glo)
    gl.glViewport(0, 0, 16, 8)
    with guard:
        assert guard.framebuffer.glo == target.glo
        assert guard.framebuffer.size == (16, 8)
        # Makers of moderngl return to what it thinks is bound.
        keep(ctx.framebuffer([keep(ctx.texture((2, 2), 4))])).clear(1.0, 0.0, 0.0)
        fill.render(moderngl.TRIANGLES, vertices=3)
    assert ctx.fbo is known
    assert gl.get_int(0x8CA6) == target.glo
    assert (pixels(target) == 255).all()
    assert not pixels(known).any()


def test_a_framebuffer_is_detected_once(
    ctx: moderngl.Context, gl: GL, guard: StateGuard, keep: Keep
) -> None:
    target = make_target(ctx, keep, (16, 8))  # moderngl frees nothing that it detects
    gl.glBindFramebuffer(0x8D40, target.glo)
    with guard:
        first = guard.framebuffer
    with guard:
        assert guard.framebuffer is first


def test_a_host_that_thinks_in_moderngl_alone_goes_on(
    ctx: moderngl.Context, guard: StateGuard, keep: Keep, fill: moderngl.VertexArray
) -> None:
    target = make_target(ctx, keep, (8, 8))
    target.use()
    with guard:
        keep(ctx.simple_framebuffer((4, 4))).use()
        for attachment in (*ctx.fbo.color_attachments, ctx.fbo.depth_attachment):
            keep(attachment)
    ctx.clear(0.0, 1.0, 0.0)
    assert pixels(target)[0, 0].tolist() == [0, 255, 0, 0]
    ctx.viewport = (0, 0, 4, 8)
    fill.render(moderngl.TRIANGLES, vertices=3)
    assert (pixels(target)[:, :4] == 255).all()
    assert (pixels(target)[:, 4:, 0] == 0).all()


def test_moderngl_s_flags_survive(
    ctx: moderngl.Context, gl: GL, guard: StateGuard, keep: Keep
) -> None:
    target = make_target(ctx, keep, (8, 8))
    target.use()
    ctx.enable_only(moderngl.DEPTH_TEST | moderngl.PROGRAM_POINT_SIZE)
    with guard:
        ctx.enable_only(moderngl.BLEND | moderngl.CULL_FACE)
    with ctx.scope(target, moderngl.RASTERIZER_DISCARD):
        pass  # a scope goes back to the flags moderngl remembers
    on = {name: gl.glIsEnabled(value) for name, value in
          {"blend": 0x0BE2, "cull": 0x0B44, "depth": 0x0B71, "point": 0x8642}.items()}  # fmt: skip
    assert on == {"blend": 0, "cull": 0, "depth": 1, "point": 1}


def test_what_moderngl_remembers_of_faces_survives(
    ctx: moderngl.Context, guard: StateGuard
) -> None:
    def remembered() -> tuple[Any, ...]:
        return ctx.wireframe, ctx.cull_face, ctx.front_face, ctx.polygon_offset

    before = remembered()
    with guard:
        ctx.wireframe, ctx.cull_face, ctx.front_face = True, "front", "cw"
        ctx.polygon_offset = (1.0, 2.0)
    assert remembered() == before


def test_the_choice_of_draw_buffers_survives(
    ctx: moderngl.Context, gl: GL, guard: StateGuard, keep: Keep, fill: moderngl.VertexArray
) -> None:
    colors = [keep(ctx.texture((4, 4), 4)) for _ in range(2)]
    target = keep(ctx.framebuffer(colors))
    target.clear()
    target.use()
    chosen = (ctypes.c_uint * 2)(0, 0x8CE1)
    gl.glDrawBuffers(2, ctypes.addressof(chosen))
    with guard:
        guard.framebuffer.use()  # moderngl chooses all of them here
        guard.bind_framebuffer()
    assert (gl.get_int(0x8825), gl.get_int(0x8826)) == (0, 0x8CE1)


@pytest.mark.parametrize("number", [1, 2, 3])
def test_what_one_of_several_targets_has_of_its_own_survives(
    ctx: moderngl.Context, gl: GL, guard: StateGuard, keep: Keep, number: int
) -> None:
    target = keep(ctx.framebuffer([keep(ctx.texture((4, 4), 4)) for _ in range(4)]))
    target.use()
    found = (ctypes.c_int * 4)()

    def masks() -> list[tuple[int, ...]]:
        every = []
        for index in range(4):
            gl.glGetIntegeri_v(0x0C23, index, ctypes.addressof(found))  # COLOR_WRITEMASK
            every.append((gl.glIsEnabledi(0x0BE2, index), *found))  # BLEND
        return every

    gl.glColorMaski(number, 1, 0, 1, 0)
    gl.glEnablei(0x0BE2, number)
    before = masks()
    assert before[0] != before[number]
    with guard:
        assert masks() == [(0, 1, 1, 1, 1)] * 4
    assert masks() == before
    gl.glColorMask(1, 1, 1, 1)
    gl.glDisable(0x0BE2)


def test_layered_and_multisampled_framebuffers_raise_no_error(
    ctx: moderngl.Context, gl: GL, guard: StateGuard, keep: Keep
) -> None:
    cube = keep(ctx.texture_cube((8, 8), 4))
    targets = [
        keep(ctx.framebuffer([keep(ctx.texture((8, 8), 4, samples=4))])),
        keep(ctx.framebuffer([keep(ctx.texture_array((8, 8, 3), 4))])),
        keep(ctx.framebuffer([keep(ctx.texture((8, 8), 4))])),
        keep(ctx.framebuffer([], keep(ctx.depth_texture((8, 8))))),
    ]
    gl.glBindFramebuffer(0x8D40, targets[2].glo)
    gl.glFramebufferTexture2D(0x8D40, 0x8CE0, 0x8515, cube.glo, 0)
    for target in targets:
        gl.glBindFramebuffer(0x8D40, target.glo)
        with guard:
            assert guard.framebuffer.glo == target.glo
            assert gl.error() == 0
        assert gl.error() == 0
        assert gl.get_int(0x8CA6) == target.glo
