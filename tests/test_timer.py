"""GPU timer and primitive counter: right, late, and never in anyone's way."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any

import moderngl
import pytest

from tests.gl_names import living
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.timer import RING, GpuTimer, PrimitiveCounter

Keep = Callable[[Any], Any]


@pytest.fixture
def draw(ctx: moderngl.Context, keep: Keep) -> Callable[[int], None]:
    """Draws so many points."""
    target = keep(ctx.simple_framebuffer((64, 64)))
    keep(target.color_attachments[0])
    keep(target.depth_attachment)
    target.use()
    program = keep(
        ctx.program(
            vertex_shader="#version 330\nvoid main() { gl_Position = vec4(0, 0, 0, 1); }",
            fragment_shader="#version 330\nout vec4 c;\nvoid main() { c = vec4(1.0); }",
        )
    )
    array = keep(ctx.vertex_array(program, []))
    return lambda count: array.render(moderngl.POINTS, vertices=count)


def test_time_comes_when_the_gpu_is_done(
    ctx: moderngl.Context, gl: GL, keep: Keep, draw: Callable[[int], None]
) -> None:
    timer = keep(GpuTimer(gl))
    assert timer.latest_ms is None
    with timer:
        draw(1000)
    ctx.finish()
    assert timer.latest_ms is not None
    assert 0.0 <= timer.latest_ms < 10_000.0


def test_more_work_takes_longer(
    ctx: moderngl.Context, gl: GL, keep: Keep, draw: Callable[[int], None]
) -> None:
    timer = keep(GpuTimer(gl))

    def measured(count: int) -> float:
        with timer:
            draw(count)
        ctx.finish()
        assert timer.latest_ms is not None
        return timer.latest_ms

    measured(10)  # the first draw compiles
    # The least of several: on a busy machine any of them may have waited.
    assert min(measured(400_000) for _ in range(2)) > min(measured(10) for _ in range(8))


def test_primitives_are_counted(
    ctx: moderngl.Context, gl: GL, keep: Keep, draw: Callable[[int], None]
) -> None:
    counter = keep(PrimitiveCounter(gl))
    assert counter.latest is None
    for count in (7, 9):
        with counter:
            draw(count)
            draw(count)
        ctx.finish()
        assert counter.latest == 2 * count


@pytest.mark.parametrize("kind", [GpuTimer, PrimitiveCounter])
def test_a_busy_gpu_costs_measurements_not_time(
    gl: GL, keep: Keep, kind: type[GpuTimer | PrimitiveCounter], monkeypatch: pytest.MonkeyPatch
) -> None:
    thing = keep(kind(gl))
    monkeypatch.setattr(gl, "glGetQueryObjectiv", lambda query, name, address: None)
    monkeypatch.setattr(
        gl, "glGetQueryObjectui64v", lambda *_: pytest.fail("asked for what is not there")
    )
    for _ in range(3 * RING):
        with thing:
            pass
    assert gl.error() == 0
    monkeypatch.undo()
    gl.glFinish()
    with thing:  # and goes on
        pass
    gl.glFinish()
    assert (thing.latest_ms if isinstance(thing, GpuTimer) else thing.latest) is not None


def test_the_hosts_queries_go_on(
    ctx: moderngl.Context, gl: GL, keep: Keep, draw: Callable[[int], None]
) -> None:
    timer, counter = keep(GpuTimer(gl)), keep(PrimitiveCounter(gl))
    with timer, counter:  # a query object is one once it was used
        draw(1)
    gl.glFinish()
    assert counter.latest == 1
    before = living(gl)["query"]
    host = ctx.query(time=True, primitives=True)
    with host:
        with timer, counter:
            draw(3)
        draw(2)
    assert gl.error() == 0
    assert host.primitives == 5
    assert timer.latest_ms is not None
    assert counter.latest == 1  # left out while the host counts
    for name in living(gl)["query"] - before:  # moderngl has no way to release a query
        gl.glDeleteQueries(1, ctypes.addressof(ctypes.c_uint(name)))


def test_begin_and_end_in_any_order(gl: GL, keep: Keep) -> None:
    for thing in (keep(GpuTimer(gl)), keep(PrimitiveCounter(gl))):
        thing.end()
        thing.begin()
        thing.begin()
        thing.end()
        thing.end()
        assert gl.error() == 0


def test_release(gl: GL) -> None:
    for thing in (GpuTimer(gl), PrimitiveCounter(gl)):
        thing.begin()
        thing.release()
        thing.release()
        thing.begin()
        thing.end()
        assert gl.error() == 0
