"""The state guard: inside it a known OpenGL state, after it the host's, as if nothing happened."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from types import TracebackType
from typing import Any

import moderngl

from weather_ecs.errors import ContextError
from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.blocks import slot_count
from weather_ecs.gpu.context import RELEASED, is_released
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.saved_state import SavedState

TEXTURE_UNITS = 8  # units 0 to 7 are the passes' to use, and moderngl's default unit
STORAGE_SLOTS = 8  # shader-storage bindings 0 to 7


class StateGuard:
    """`with guard:` around everything that touches OpenGL.

    Inside: the host's framebuffer and viewport bound; scissor, blend, depth test, cull, stencil and
    the like off; depth writes and colours on; LEQUAL; alpha blending chosen; no vertex array, no
    samplers. Textures of the units 0 to 7 and uniform and storage bindings are as the host left
    them; of the textures, those in 2D and arrays of them are put back, which passes sample. Nested
    use is harmless, and sets no baseline.

    Raises ContextError where the context of `ctx` is not current.
    """

    def __init__(self, ctx: moderngl.Context, gl: GL | None = None) -> None:
        self.ctx = ctx
        self.gl = gl if gl is not None else GL()
        self._depth = 0
        self._slots = -1
        self._state = self._make_state()
        self._window = ctx.detect_framebuffer(0)
        self._scope: Any = self._make_scope()
        self._framebuffer = self._window
        self._detected: dict[int, moderngl.Framebuffer] = {}
        self._host: tuple[Any, ...] = ()

    def _make_state(self) -> SavedState:
        self._slots = max(8, slot_count())
        return SavedState(
            self.gl,
            texture_units=TEXTURE_UNITS,
            own_unit=self.ctx.default_texture_unit,
            uniform_slots=self._slots,
            storage_slots=STORAGE_SLOTS,
        )

    def _make_scope(self) -> moderngl.Scope:
        """Keeps moderngl's enable flags, which cannot be read; returns to the window's framebuffer.

        Returning to another one would choose that framebuffer's draw buffers anew.
        """
        mglo: Any = self.ctx.mglo
        bound = mglo.fbo
        mglo.fbo = self._window.mglo
        scope = self.ctx.scope(self._window, enable_only=moderngl.NOTHING)
        mglo.fbo = bound
        return scope

    @property
    def framebuffer(self) -> moderngl.Framebuffer:
        """What the host had bound. To draw to it call `bind_framebuffer`, not its `use`.

        Its size may be out of date: the window's after a resize, another's after it was remade.
        """
        return self._framebuffer

    @property
    def viewport(self) -> tuple[int, int, int, int]:
        """The host's viewport: x, y, width, height in pixels."""
        return self._state.viewport

    def __enter__(self) -> StateGuard:
        if self._depth == 0:
            self._enter()
        self._depth += 1
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self._depth -= 1
        if self._depth == 0:
            self._exit()

    def _check(self) -> None:
        if self._scope is None:
            raise ContextError("the state guard was released")
        if is_released(self.ctx):
            raise ContextError(RELEASED)
        if not self.gl.is_current():
            raise ContextError("the weather's OpenGL context is not current in this thread")

    def _enter(self) -> None:
        self._check()
        if self._slots < slot_count():
            self._state = self._make_state()
        self._state.save()
        ctx: Any = self.ctx
        self._framebuffer = self._find_framebuffer(self._state.draw_framebuffer)
        mglo = self._framebuffer.mglo
        self._host = (
            ctx.fbo,
            ctx.mglo.fbo,
            mglo.viewport,
            mglo.color_mask,
            mglo.depth_mask,
            ctx.wireframe,
            ctx.cull_face,
            ctx.front_face,
            ctx.polygon_offset,
        )
        self._scope.__enter__()
        self._state.baseline()
        self._aim()

    def _exit(self) -> None:
        if not self.gl.is_current():
            raise ContextError("the OpenGL context changed while the weather was drawing")
        ctx: Any = self.ctx
        fbo, bound, viewport, color_mask, depth_mask, wireframe, cull, front, offset = self._host
        self._host = ()
        self._scope.__exit__(None, None, None)
        if ctx.wireframe != wireframe:
            ctx.wireframe = wireframe
        if ctx.cull_face != cull:
            ctx.cull_face = cull
        if ctx.front_face != front:
            ctx.front_face = front
        if ctx.polygon_offset != offset:
            ctx.polygon_offset = offset
        mglo: Any = self._framebuffer.mglo
        mglo.viewport = viewport
        mglo.color_mask = color_mask
        mglo.depth_mask = depth_mask
        ctx.fbo, ctx.mglo.fbo = fbo, bound
        self._state.restore()

    @contextmanager
    def for_buffers(self) -> Iterator[None]:
        """In place of `with guard:` where buffers are made and filled, and nothing else is done.

        moderngl binds them all at one place, so one value is kept. Raises as `with guard:` does.
        """
        self._check()
        bound = self.gl.get_int(e.ARRAY_BUFFER_BINDING)
        try:
            yield
        finally:
            self.gl.glBindBuffer(e.ARRAY_BUFFER, bound)

    def bind_framebuffer(self) -> None:
        """Draw to the host's framebuffer and viewport again, after drawing somewhere else."""
        self._aim()
        gl = self.gl
        gl.glDisable(e.SCISSOR_TEST)
        gl.glColorMask(1, 1, 1, 1)
        gl.glDepthMask(1)

    def _aim(self) -> None:
        """At the host's framebuffer and viewport."""
        ctx: Any = self.ctx
        self.gl.glBindFramebuffer(e.FRAMEBUFFER, self._state.draw_framebuffer)
        ctx.mglo.fbo = self._framebuffer.mglo
        ctx.fbo = self._framebuffer
        # Through moderngl, so that its notion of the viewport is right as well.
        self._framebuffer.mglo.viewport = self._state.viewport

    def reset(self) -> None:
        """The state of the beginning once more: after code of the host's ran inside the guard."""
        self.ctx.enable_only(moderngl.NOTHING)
        self._state.reset()
        self.bind_framebuffer()

    def _find_framebuffer(self, name: int) -> moderngl.Framebuffer:
        """A moderngl framebuffer for `name`: moderngl may know it, or it was bound without it."""
        if name == 0:
            return self._window
        ctx: Any = self.ctx
        fbo = ctx.fbo
        if fbo is not None and fbo.glo == name and fbo.mglo is ctx.mglo.fbo:
            return fbo  # type: ignore[no-any-return]
        # moderngl never frees what it has detected, so each name is asked for once.
        found = self._detected.get(name)
        if found is None:
            found = self._detected[name] = ctx.detect_framebuffer(name)
            # moderngl asks for the size of any attachment as if it were a plain 2D texture.
            while self.gl.error():
                pass
        return found

    def release(self) -> None:
        """Give the guard's moderngl object back; twice does no harm."""
        if self._scope is not None:
            self._scope.release()
            self._scope = None
            self._detected.clear()
