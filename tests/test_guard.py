"""The state guard: everything as it was, a known state inside, moderngl's own notions as well."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import moderngl
import pytest

from tests.gl_host import SWITCHES, Host, read_state
from tests.guard_targets import FILL, WHITE, Keep, make_target
from weather_ecs.errors import ContextError
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.guard import StateGuard

SRGB = 0x8DB9


@pytest.fixture
def guard(ctx: moderngl.Context, gl: GL, keep: Keep) -> StateGuard:
    return keep(StateGuard(ctx, gl))


def differences(before: dict[str, Any], after: dict[str, Any]) -> dict[str, Any]:
    return {name: (before[name], after[name]) for name in before if before[name] != after[name]}


@pytest.fixture
def default_state(gl: GL, ctx: moderngl.Context) -> Iterator[None]:
    """Puts the context back after a test that leaves it scrambled."""
    outer = StateGuard(ctx, gl)
    with outer:
        yield
        outer.reset()
        gl.glDisable(SRGB)
    outer.release()


def work(ctx: moderngl.Context, gl: GL, guard: StateGuard) -> None:
    """What passes do: make, fill, draw and release things of every kind."""
    target = ctx.simple_framebuffer((8, 8))
    target.use()
    target.clear(0.1, 0.2, 0.3, 0.4, depth=0.5)
    program = ctx.program(vertex_shader=FILL, fragment_shader=WHITE)
    feedback = ctx.program(
        vertex_shader="#version 330\nout float v;\nvoid main() { v = 1.0; }", varyings=("v",)
    )
    array, feedback_array = ctx.vertex_array(program, []), ctx.vertex_array(feedback, [])
    texture = ctx.texture((4, 4), 4, b"\x01" * 64)
    volume = ctx.texture3d((2, 2, 2), 1, b"\x01" * 8)
    pictures = ctx.texture_array((2, 2, 2), 1, b"\x01" * 8)
    buffers = [ctx.buffer(reserve=256) for _ in range(2)]
    for unit in range(8):
        texture.use(unit)
        pictures.use(unit)
    ctx.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.CULL_FACE)
    ctx.blend_func = moderngl.ADDITIVE_BLENDING
    ctx.blend_equation = moderngl.MAX
    ctx.depth_func = ">"
    ctx.cull_face, ctx.front_face, ctx.wireframe = "front", "cw", True
    ctx.polygon_offset, ctx.provoking_vertex = (2.0, 3.0), moderngl.FIRST_VERTEX_CONVENTION
    gl.glDepthMask(0)
    gl.glColorMask(1, 0, 1, 0)
    gl.glDepthRange(0.2, 0.3)
    for switch in (0x0C11, 0x0B90, 0x8037, 0x864F, 0x8C89, 0x8642):
        gl.glEnable(switch)
    gl.glDisable(0x8C89)
    top = gl.get_int(0x8A2F) - 1
    for slot in range(8):
        buffers[0].bind_to_uniform_block(top - slot)
        if gl.version >= 430:
            buffers[1].bind_to_storage_buffer(slot)
    feedback_array.transform(buffers, moderngl.POINTS, vertices=1)
    array.render(moderngl.TRIANGLES, vertices=3)
    ctx.copy_buffer(buffers[0], buffers[1])
    buffers[0].orphan()
    buffers[0].write(b"\x01" * 16)
    texture.read_into(buffers[1])
    guard.bind_framebuffer()
    for thing in (*buffers, volume, pictures, texture, array, feedback_array, program, feedback):
        thing.release()
    for attachment in (*target.color_attachments, target.depth_attachment, target):
        attachment.release()


@pytest.mark.parametrize("seed", range(12))
@pytest.mark.usefixtures("default_state")
def test_everything_is_put_back(
    ctx: moderngl.Context, gl: GL, guard: StateGuard, keep: Keep, seed: int
) -> None:
    host = Host(ctx, gl, keep, seed)
    host.scramble()
    before = read_state(gl)
    assert gl.error() == 0
    with guard:
        assert gl.error() == 0
        work(ctx, gl, guard)
        assert gl.error() == 0
    assert gl.error() == 0
    assert differences(before, read_state(gl)) == {}


@pytest.mark.parametrize("seed", range(3))
@pytest.mark.usefixtures("default_state")
def test_filling_buffers_alone_changes_nothing(
    ctx: moderngl.Context, gl: GL, guard: StateGuard, keep: Keep, seed: int
) -> None:
    Host(ctx, gl, keep, seed).scramble()
    before = read_state(gl)
    with guard.for_buffers():
        buffer = ctx.buffer(reserve=64, dynamic=True)
        buffer.orphan()
        buffer.write(b"x" * 64)
    assert differences(before, read_state(gl)) == {}
    buffer.release()
    guard.release()
    with pytest.raises(ContextError, match="released"), guard.for_buffers():
        pytest.fail("entered after release")


@pytest.mark.usefixtures("default_state")
def test_the_baseline_does_not_depend_on_the_host(
    ctx: moderngl.Context, gl: GL, guard: StateGuard, keep: Keep
) -> None:
    left_alone = ("buffer", "unit", "framebuffer", "viewport", "color", "index", "draw buffer",
                  "srgb", "dither", "renderbuffer", "coverage", "offset", "copy", "active",
                  "indirect", "program", "logic operation", "clear", "point", "scissor box",
                  "feedback", "pixel")  # fmt: skip
    states = []
    host = Host(ctx, gl, keep, 0)
    for _ in range(8):
        host.scramble()
        with guard:
            state = read_state(gl)
        assert gl.error() == 0
        states.append({n: v for n, v in state.items() if not any(w in n for w in left_alone)})
    assert all(state == states[0] for state in states)
    assert states[0]["blend"] == states[0]["depth"] == states[0]["scissor"] == 0
    assert states[0]["depth mask"] == (1,)
    assert states[0]["depth range"] == (0.0, 1.0)
    assert states[0]["unpack row"] == (0,)


@pytest.mark.usefixtures("default_state")
def test_uploads_are_safe_from_the_hosts_pixel_store(
    ctx: moderngl.Context, gl: GL, guard: StateGuard, keep: Keep
) -> None:
    buffer = keep(ctx.buffer(reserve=64))
    gl.glBindBuffer(0x88EC, buffer.glo)  # as a pixel unpack buffer
    gl.glPixelStorei(0x0CF2, 7)
    gl.glPixelStorei(0x0CF4, 1)
    data = bytes(range(16))
    with guard:
        texture = keep(ctx.texture((4, 4), 1, data))
        assert texture.read() == data


def test_an_exception_passes_and_the_state_is_back(
    ctx: moderngl.Context, gl: GL, guard: StateGuard
) -> None:
    before = read_state(gl)

    def fail() -> None:
        with guard:
            ctx.enable_only(moderngl.BLEND)
            raise ZeroDivisionError

    with pytest.raises(ZeroDivisionError):
        fail()
    assert differences(before, read_state(gl)) == {}


@pytest.mark.usefixtures("default_state")
def test_reset_after_foreign_code(
    ctx: moderngl.Context, gl: GL, guard: StateGuard, keep: Keep
) -> None:
    host = Host(ctx, gl, keep, 1)
    target = make_target(ctx, keep, (8, 8))
    target.use()
    before = read_state(gl)
    units = [name for name in before if "unit " in name or "buffer 0x" in name]
    with guard:
        inside = read_state(gl)
        host.scramble()
        guard.reset()
        after = read_state(gl)
        gl.glDisable(SRGB)
        wrong = differences(inside, after)
    for name in ("draw framebuffer", "viewport", "depth mask", "unpack row", *SWITCHES):
        assert name not in wrong or name == "srgb"
    left = set(differences(before, read_state(gl)))
    # What the guard does not know of is left as that code has it.
    assert {name for name in left if name not in units} <= {"stencil clear"}


def test_nested_use_changes_nothing(ctx: moderngl.Context, gl: GL, guard: StateGuard) -> None:
    with guard:
        gl.glEnable(0x0BE2)
        with guard:
            assert gl.glIsEnabled(0x0BE2)
        assert gl.glIsEnabled(0x0BE2)
    assert not gl.glIsEnabled(0x0BE2)


def test_a_program_deleted_while_in_use(ctx: moderngl.Context, gl: GL, guard: StateGuard) -> None:
    programs = [
        ctx.program(vertex_shader="#version 330\nvoid main() { gl_Position = vec4(0.0); }")
        for _ in range(2)
    ]
    gl.glUseProgram(programs[0].glo)
    programs[0].release()
    with guard:
        gl.glUseProgram(programs[1].glo)
    assert gl.error() == 0
    gl.glUseProgram(0)
    programs[1].release()


def test_another_context_is_refused(ctx: moderngl.Context, guard: StateGuard) -> None:
    other = moderngl.create_context(standalone=True, backend="egl")
    try:
        with other, pytest.raises(ContextError, match="not current"), guard:
            pytest.fail("entered with another context current")
    finally:
        other.release()
        ctx.__enter__()
    with guard:
        pass


def test_release(ctx: moderngl.Context, gl: GL) -> None:
    guard = StateGuard(ctx, gl)
    guard.release()
    guard.release()
    with pytest.raises(ContextError, match="released"), guard:
        pytest.fail("entered after release")
