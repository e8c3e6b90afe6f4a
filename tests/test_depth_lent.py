"""The host's depth texture lent in place of a copy: when, how it reads, nothing left changed."""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from typing import Any

import moderngl
import numpy as np
import pytest

from tests.rain_frames import camera, frame, quality
from weather_ecs.frame import FogData, ViewData
from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.depth_lent import MOST, READ, LentDepth
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.guard import StateGuard
from weather_ecs.gpu.renderer import Renderer
from weather_ecs.systems.rain_view import RainView

Keep = Callable[[Any], Any]
SIZE = 24, 16


@pytest.fixture
def lent(ctx: moderngl.Context, gl: GL, keep: Keep) -> LentDepth:
    made = keep(LentDepth(ctx, gl))
    if not made._able:
        pytest.skip("a copy is cheaper on this renderer")
    return made


@pytest.fixture
def guard(ctx: moderngl.Context, gl: GL, keep: Keep) -> StateGuard:
    return keep(StateGuard(ctx, gl))


def values(gl: GL, texture: int) -> list[int]:
    """How the host reads its texture."""
    found = ctypes.c_int()
    read = []
    for name, _ in READ:
        assert gl.glGetTextureParameteriv is not None
        gl.glGetTextureParameteriv(texture, name, ctypes.addressof(found))
        read.append(found.value)
    return read


@pytest.fixture
def host(ctx: moderngl.Context, keep: Keep) -> tuple[moderngl.Framebuffer, Any]:
    """A framebuffer whose depth, 0.25 on the left and 0.75 on the right, the host compares with."""
    depth = np.full(SIZE[::-1], 0.25, np.float32)
    depth[:, SIZE[0] // 2 :] = 0.75
    texture = keep(ctx.depth_texture(SIZE, depth.tobytes()))
    texture.compare_func = ">="
    texture.filter = moderngl.LINEAR, moderngl.LINEAR
    target = keep(ctx.framebuffer([keep(ctx.texture(SIZE, 4))], texture))
    target.use()
    return target, texture


def test_a_plain_texture_is_lent_and_given_back_as_it_was(
    ctx: moderngl.Context, gl: GL, guard: StateGuard, lent: LentDepth, host: Any
) -> None:
    _, texture = host
    before = values(gl, texture.glo)
    assert before != [wanted for _, wanted in READ]
    for _ in range(2):
        with guard:
            taken = lent.take(guard)
            assert taken is not None and taken.glo == texture.glo and taken.size == SIZE
            assert values(gl, texture.glo) == [wanted for _, wanted in READ]
            lent.give_back()
            assert values(gl, texture.glo) == before
            lent.give_back()  # harmless
        assert values(gl, texture.glo) == before
    lent.release()
    assert gl.glIsTexture(texture.glo) and gl.error() == 0


def test_what_is_not_the_whole_of_a_plain_texture_is_copied(
    ctx: moderngl.Context, gl: GL, keep: Keep, guard: StateGuard, lent: LentDepth, host: Any
) -> None:
    target, texture = host
    target.viewport = (2, 0, SIZE[0] - 2, SIZE[1])
    with guard:
        assert lent.take(guard) is None
    target.viewport = (0, 0, *SIZE)
    gl.glTextureParameteri(texture.glo, e.TEXTURE_SWIZZLE_R, e.ZERO)  # type: ignore[misc]
    with guard:
        assert lent.take(guard) is None
    color = keep(ctx.renderbuffer(SIZE, 4))
    for depth in (keep(ctx.depth_renderbuffer(SIZE)), None):
        keep(ctx.framebuffer([color], depth)).use()
        with guard:
            assert lent.take(guard) is None
    many = keep(ctx.renderbuffer(SIZE, 4, samples=4))
    keep(ctx.framebuffer([many], keep(ctx.depth_texture(SIZE, samples=4)))).use()
    with guard:
        assert lent.take(guard) is None
    assert gl.error() == 0


def test_a_texture_that_the_host_has_deleted_is_copied(
    ctx: moderngl.Context, gl: GL, keep: Keep, guard: StateGuard, lent: LentDepth
) -> None:
    depth = ctx.depth_texture(SIZE)
    target = keep(ctx.framebuffer([keep(ctx.texture(SIZE, 4))], depth))
    keep(ctx.framebuffer([keep(ctx.texture(SIZE, 4))])).use()
    depth.release()
    target.use()
    with guard:
        assert lent.take(guard) is None
    assert gl.error() == 0


def test_targets_that_take_turns_are_known_again(
    ctx: moderngl.Context, keep: Keep, guard: StateGuard, lent: LentDepth
) -> None:
    targets = [
        keep(ctx.framebuffer([keep(ctx.texture(SIZE, 4))], keep(ctx.depth_texture(SIZE))))
        for _ in range(MOST + 1)
    ]

    def taken(target: moderngl.Framebuffer) -> Any:
        target.use()
        with guard:
            found = lent.take(guard)
            lent.give_back()
        assert found is not None and found.glo == target.depth_attachment.glo  # type: ignore
        return found

    few = [taken(target) for target in targets[:2]]
    assert [taken(target) for target in targets[:2]] == few
    for target in targets:
        taken(target)
    assert len(lent._known) <= MOST


def test_fog_is_the_same_over_a_lent_depth_and_a_copy(
    ctx: moderngl.Context, gl: GL, keep: Keep, lent: LentDepth, host: Any
) -> None:
    target, texture = host
    at = camera()
    fog = FogData(1.0, (0.6, 0.65, 0.7), draw=True)
    seen: ViewData = RainView().view(frame(fog=fog), at, 0, quality(drops=10))
    renderer = keep(Renderer(ctx))
    pictures = []
    taken = []
    for may in (True, False):
        own = renderer._layers._lent
        own._able = may
        plain = own.take
        own.take = lambda guard, plain=plain: taken.append(plain(guard)) or taken[-1]
        target.use()
        target.depth_mask = True
        target.color_mask = (True,) * 4
        target.clear(0.2, 0.2, 0.2, 1.0, depth=0.3, viewport=(0, 0, 10, 16))
        target.clear(0.2, 0.2, 0.2, 1.0, depth=0.8, viewport=(10, 0, 14, 16))
        before = values(gl, texture.glo)
        renderer.draw(seen, quality())
        assert values(gl, texture.glo) == before
        pictures.append(np.frombuffer(target.read(components=3), np.uint8).reshape(16, 24, 3))
        own.take = plain
    assert taken[0] is not None and taken[1] is None
    assert (pictures[0] == pictures[1]).all()
    # The scene that is clearly nearer has clearly less fog.
    assert pictures[0][:, :9].mean() + 20 < pictures[0][:, 11:].mean()
