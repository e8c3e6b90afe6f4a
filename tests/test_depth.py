"""Depth copies: what is there, where it is, for every kind of depth buffer, and nothing changed."""

from __future__ import annotations

import ctypes
import logging
from collections.abc import Callable, Iterator
from typing import Any

import moderngl
import numpy as np
import pytest

from tests.processes import run
from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.depth import UPLOAD, DepthCopy
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.guard import StateGuard

Keep = Callable[[Any], Any]
WIDTH, HEIGHT = 16, 8
FORMATS = {
    name: getattr(e, name)
    for name in ("DEPTH_COMPONENT16", "DEPTH_COMPONENT24", "DEPTH_COMPONENT32",
                 "DEPTH_COMPONENT32F", "DEPTH24_STENCIL8", "DEPTH32F_STENCIL8")
}  # fmt: skip
SLOPE = """#version 330
uniform float lift;
void main() {
    vec2 p = vec2(ivec2(gl_VertexID & 1, gl_VertexID >> 1) * 4 - 1);
    gl_Position = vec4(p, p.x * 0.5 + p.y * 0.25 + lift, 1.0);
}
"""
# Reads texels one by one: what a pass sees.
FETCH = """#version 330
uniform sampler2D scene_depth;
out float value;
void main() {
    ivec2 texel = ivec2(gl_VertexID % WIDTH, gl_VertexID / WIDTH);
    value = texelFetch(scene_depth, texel, 0).r;
}
"""


@pytest.fixture
def guard(ctx: moderngl.Context, gl: GL, keep: Keep) -> StateGuard:
    return keep(StateGuard(ctx, gl))


@pytest.fixture
def copier(ctx: moderngl.Context, gl: GL, keep: Keep) -> DepthCopy:
    return keep(DepthCopy(ctx, gl))


@pytest.fixture
def slope(ctx: moderngl.Context, keep: Keep) -> Callable[[float], None]:
    """Draws a slanted plane over the viewport."""
    program = keep(
        ctx.program(
            vertex_shader=SLOPE,
            fragment_shader="#version 330\nout vec4 c;\nvoid main() { c = vec4(0.5); }",
        )
    )
    array = keep(ctx.vertex_array(program, []))

    def draw(lift: float = 0.0) -> None:
        program["lift"] = lift
        ctx.enable_only(moderngl.DEPTH_TEST)
        array.render(moderngl.TRIANGLES, vertices=3)

    return draw


def expected(x0: int = 0, y0: int = 0, width: int = WIDTH, height: int = HEIGHT) -> np.ndarray:
    """The plane's window depth at the centres of a part of its pixels."""
    x = (np.arange(x0, x0 + width) + 0.5) / WIDTH * 2.0 - 1.0
    y = (np.arange(y0, y0 + height) + 0.5) / HEIGHT * 2.0 - 1.0
    return (x[None, :] * 0.5 + y[:, None] * 0.25) * 0.5 + 0.5


def fetched(ctx: moderngl.Context, texture: moderngl.Texture) -> np.ndarray:
    """Texels of `texture` as a shader reads them, lowest row first."""
    width, height = texture.size
    source = FETCH.replace("WIDTH", str(width))
    program = ctx.program(vertex_shader=source, varyings=("value",))
    array, output = ctx.vertex_array(program, []), ctx.buffer(reserve=4 * width * height)
    texture.use(0)
    array.transform(output, moderngl.POINTS, vertices=width * height)
    values = np.frombuffer(output.read(), np.float32).reshape(height, width)
    for thing in (output, array, program):
        thing.release()
    return values


@pytest.fixture(params=sorted(FORMATS))
def target(
    request: pytest.FixtureRequest, ctx: moderngl.Context, gl: GL, keep: Keep
) -> Iterator[moderngl.Framebuffer]:
    """A framebuffer with a depth texture of each format; moderngl makes but one of them."""
    internal = FORMATS[request.param]
    name = ctypes.c_uint()
    gl.glGenTextures(1, ctypes.addressof(name))
    gl.glBindTexture(e.TEXTURE_2D, name.value)
    layout, kind = UPLOAD.get(internal, (e.DEPTH_COMPONENT, e.FLOAT))
    gl.glTexImage2D(e.TEXTURE_2D, 0, internal, WIDTH, HEIGHT, 0, layout, kind, None)
    gl.glTexParameteri(e.TEXTURE_2D, e.TEXTURE_MIN_FILTER, e.NEAREST)
    framebuffer = keep(ctx.framebuffer([keep(ctx.texture((WIDTH, HEIGHT), 4))]))
    framebuffer.use()
    point = e.DEPTH_STENCIL_ATTACHMENT if internal in UPLOAD else e.DEPTH_ATTACHMENT
    gl.glFramebufferTexture2D(e.FRAMEBUFFER, point, e.TEXTURE_2D, name.value, 0)
    framebuffer.depth_mask = True
    framebuffer.clear(0.25, 0.5, 0.75, 1.0, depth=1.0)
    yield framebuffer
    gl.glDeleteTextures(1, ctypes.addressof(name))


def contents(gl: GL, framebuffer: moderngl.Framebuffer) -> tuple[bytes, np.ndarray]:
    """Colours and depth of a single-sampled framebuffer."""
    depth = (ctypes.c_float * (WIDTH * HEIGHT))()
    gl.glBindFramebuffer(e.FRAMEBUFFER, framebuffer.glo)
    gl.glReadPixels(0, 0, WIDTH, HEIGHT, e.DEPTH_COMPONENT, e.FLOAT, ctypes.addressof(depth))
    return framebuffer.read(components=4), np.array(depth).reshape(HEIGHT, WIDTH)


def test_every_format(
    ctx: moderngl.Context,
    gl: GL,
    guard: StateGuard,
    copier: DepthCopy,
    target: moderngl.Framebuffer,
    slope: Callable[[float], None],
) -> None:
    slope(0.0)
    colors, depth = contents(gl, target)
    assert depth == pytest.approx(expected(), abs=2e-5)
    for _ in range(2):  # made, then reused
        with guard:
            texture = copier.copy(guard)
            assert texture is not None
            assert texture.size == (WIDTH, HEIGHT)
            assert gl.get_int(e.DRAW_FRAMEBUFFER_BINDING) == target.glo
            assert fetched(ctx, texture) == pytest.approx(depth, abs=2e-5)
        assert gl.error() == 0
    again, same = contents(gl, target)
    assert again == colors
    assert (same == depth).all()


def test_the_copy_follows_the_scene_and_the_viewport(
    ctx: moderngl.Context,
    guard: StateGuard,
    copier: DepthCopy,
    keep: Keep,
    slope: Callable[[float], None],
) -> None:
    depth = keep(ctx.depth_renderbuffer((WIDTH, HEIGHT)))
    target = keep(ctx.framebuffer([keep(ctx.texture((WIDTH, HEIGHT), 4))], depth))
    target.use()
    target.clear()
    slope(0.0)
    for x, y, width, height in ((0, 0, WIDTH, HEIGHT), (4, 2, 8, 5), (4, 2, 8, 5), (12, 6, 4, 2)):
        target.viewport = (x, y, width, height)
        with guard:
            texture = copier.copy(guard)
            assert texture is not None
            assert fetched(ctx, texture) == pytest.approx(expected(x, y, width, height), abs=2e-5)
    target.viewport = (0, 0, WIDTH, HEIGHT)
    target.clear(depth=0.25)
    with guard:
        texture = copier.copy(guard)
        assert texture is not None
        assert fetched(ctx, texture) == pytest.approx(0.25, abs=2e-5)


@pytest.mark.parametrize("samples", [2, 4])
def test_multisampled(
    ctx: moderngl.Context,
    gl: GL,
    guard: StateGuard,
    copier: DepthCopy,
    keep: Keep,
    slope: Callable[[float], None],
    samples: int,
) -> None:
    if samples > ctx.max_samples:
        pytest.skip(f"at most {ctx.max_samples} samples here")
    size = (WIDTH, HEIGHT)
    color = keep(ctx.renderbuffer(size, 4, samples=samples))
    target = keep(ctx.framebuffer([color], keep(ctx.depth_renderbuffer(size, samples=samples))))
    target.use()
    target.clear()
    slope(0.0)
    with guard:
        texture = copier.copy(guard)
        assert texture is not None
        # One sample stands for the pixel, up to half a pixel from its centre.
        assert fetched(ctx, texture) == pytest.approx(expected(), abs=0.05)
    assert gl.error() == 0


def test_without_depth_one_line_in_the_log(
    ctx: moderngl.Context,
    gl: GL,
    guard: StateGuard,
    copier: DepthCopy,
    keep: Keep,
    caplog: pytest.LogCaptureFixture,
) -> None:
    target = keep(ctx.framebuffer([keep(ctx.texture((8, 8), 4))]))
    target.use()
    with caplog.at_level(logging.WARNING, "weather_ecs"):
        for _ in range(3):
            with guard:
                assert copier.copy(guard) is None
    assert gl.error() == 0
    assert [record.getMessage() for record in caplog.records] == [
        "no copy of the scene's depth: the framebuffer has no depth buffer"
    ]


def test_a_driver_that_refuses(
    ctx: moderngl.Context,
    gl: GL,
    guard: StateGuard,
    copier: DepthCopy,
    keep: Keep,
    caplog: pytest.LogCaptureFixture,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    target = keep(ctx.simple_framebuffer((8, 8)))
    keep(target.color_attachments[0])
    keep(target.depth_attachment)
    target.use()

    def refuse(*_: int) -> None:
        gl.glEnable(0xFFFF)  # leaves an error behind

    monkeypatch.setattr(gl, "glBlitFramebuffer", refuse)
    with guard:
        assert copier.copy(guard) is not None  # the other way
    monkeypatch.setattr(gl, "glCopyTexSubImage2D", refuse)
    target.viewport = (0, 0, 4, 4)
    with guard:
        assert copier.copy(guard) is None
        assert gl.get_int(e.DRAW_FRAMEBUFFER_BINDING) == target.glo
    with guard:
        assert copier.copy(guard) is None
    assert gl.error() == 0
    assert len(caplog.records) == 1


def test_an_empty_viewport(guard: StateGuard, copier: DepthCopy, gl: GL) -> None:
    gl.glViewport(0, 0, 0, 0)
    with guard:
        assert copier.copy(guard) is None
    assert gl.error() == 0


def test_release(ctx: moderngl.Context, gl: GL, guard: StateGuard, keep: Keep) -> None:
    target = keep(ctx.simple_framebuffer((8, 8)))
    keep(target.color_attachments[0])
    keep(target.depth_attachment)
    target.use()
    copier = DepthCopy(ctx, gl)
    with guard:
        assert copier.copy(guard) is not None
        copier.release()
        copier.release()


WINDOW = """
import pyglet
pyglet.options.headless = True
from pyglet import gl as host
import numpy as np
config = host.Config(double_buffer=True, depth_size=24, stencil_size=%d, sample_buffers=0)
window = pyglet.window.Window(64, 32, config=config)
host.glViewport(0, 0, 64, 32)
host.glClearDepth(0.75)
host.glClear(host.GL_DEPTH_BUFFER_BIT | host.GL_COLOR_BUFFER_BIT)
host.glEnable(host.GL_SCISSOR_TEST)
host.glScissor(0, 0, 32, 32)
host.glClearDepth(0.25)
host.glClear(host.GL_DEPTH_BUFFER_BIT)
from tests.test_depth import fetched
from weather_ecs.gpu.context import obtain
from weather_ecs.gpu.depth import DepthCopy
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.guard import StateGuard
ctx, gl = obtain(), GL()
guard, copier = StateGuard(ctx, gl), DepthCopy(ctx, gl)
with guard:
    texture = copier.copy(guard)
    values = fetched(ctx, texture)
print(texture.size, values[:, :32].min(), values[:, :32].max(), values[:, 32:].min(), gl.error())
print(gl.get_int(0x8CA6), host.glIsEnabled(host.GL_SCISSOR_TEST))
"""


@pytest.mark.parametrize("stencil", [0, 8])
def test_the_framebuffer_of_a_window(stencil: int) -> None:
    lines = run(WINDOW % stencil).splitlines()
    size, numbers = lines[0].split(") ")
    assert size == "(64, 32"
    low, high, far, error = (float(number) for number in numbers.split())
    assert (low, high, far) == pytest.approx((0.25, 0.25, 0.75), abs=1e-5)
    assert error == 0
    assert lines[1] == "0 1"
