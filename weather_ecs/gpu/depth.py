"""A copy of the host's depth that shaders can sample: where the scene ends along a view ray."""

from __future__ import annotations

import ctypes
import logging
from typing import NamedTuple

import moderngl

from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.guard import StateGuard

_log = logging.getLogger("weather_ecs")

# (depth bits, stencil bits, floating point) of a source: the texture format a blit into must have.
FORMATS = {
    (16, 0, False): e.DEPTH_COMPONENT16,
    (24, 0, False): e.DEPTH_COMPONENT24,
    (24, 8, False): e.DEPTH24_STENCIL8,
    (32, 0, False): e.DEPTH_COMPONENT32,
    (32, 0, True): e.DEPTH_COMPONENT32F,
    (32, 8, True): e.DEPTH32F_STENCIL8,
}
UPLOAD = {  # format and type that belong to an internal format; no data is ever uploaded
    e.DEPTH24_STENCIL8: (e.DEPTH_STENCIL, e.UNSIGNED_INT_24_8),
    e.DEPTH32F_STENCIL8: (e.DEPTH_STENCIL, e.FLOAT_32_UNSIGNED_INT_24_8_REV),
}


class Source(NamedTuple):
    """The depth buffer of a framebuffer."""

    depth_bits: int
    stencil_bits: int
    floating: bool
    samples: int


class DepthCopy:
    """Keeps a depth texture of the viewport's size and fills it from the host's framebuffer.

    Texel (0, 0) is the viewport's lower left corner; values are window depth in [0, 1].
    """

    def __init__(self, ctx: moderngl.Context, gl: GL) -> None:
        self._ctx = ctx
        self._gl = gl
        self._texture: moderngl.Texture | None = None
        self._made_for: tuple[Source, int, int] | None = None
        self._blit = True
        self._told = False
        self._texture_name = ctypes.c_uint()
        self._framebuffer_name = ctypes.c_uint()

    def copy(self, guard: StateGuard) -> moderngl.Texture | None:
        """The depth under the host's viewport as it is now; its framebuffer is bound afterwards.

        None, and one line in the log, where there is no depth or the driver cannot copy it.
        """
        guard.bind_framebuffer()
        x, y, width, height = guard.viewport
        source = self._source(guard.framebuffer.glo)
        if source is None or width < 1 or height < 1:
            if source is None:
                self._tell("the framebuffer has no depth buffer")
            return None
        key = (source, width, height)
        if key != self._made_for:
            self._made_for = key
            self._make(guard, source, x, y, width, height)
        elif self._texture is not None:
            self._transfer(guard, x, y, width, height)
        return self._texture

    def available(self, guard: StateGuard) -> bool:
        """Whether the host's framebuffer, which is bound afterwards, has a depth."""
        guard.bind_framebuffer()
        found = self._source(guard.framebuffer.glo) is not None
        if not found:
            self._tell("the framebuffer has no depth buffer")
        return found

    def _source(self, framebuffer: int) -> Source | None:
        gl = self._gl
        attachment = e.DEPTH_ATTACHMENT if framebuffer else e.DEPTH
        if not self._attached(attachment, e.FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE):
            return None
        depth_bits = self._attached(attachment, e.FRAMEBUFFER_ATTACHMENT_DEPTH_SIZE)
        if depth_bits == 0:
            return None
        stencil_bits = self._attached(attachment, e.FRAMEBUFFER_ATTACHMENT_STENCIL_SIZE)
        kind = self._attached(attachment, e.FRAMEBUFFER_ATTACHMENT_COMPONENT_TYPE)
        return Source(depth_bits, stencil_bits, kind == e.FLOAT, gl.get_int(e.SAMPLES))

    def _attached(self, attachment: int, name: int) -> int:
        return self._gl.get_attachment(e.DRAW_FRAMEBUFFER, attachment, name)

    def _make(
        self, guard: StateGuard, source: Source, x: int, y: int, width: int, height: int
    ) -> None:
        """Find a way that works for this source, the cheaper one on Mesa first."""
        gl = self._gl
        exact = FORMATS.get(source[:3], e.DEPTH_COMPONENT24)
        plain = e.DEPTH_COMPONENT32F if source.floating else e.DEPTH_COMPONENT24
        ways = [(True, exact), (False, plain)]
        if source.samples:
            ways = [(True, exact), (True, plain)]  # only a blit resolves samples
        elif source.stencil_bits:
            # Blitting into a depth-stencil texture carries the stencil along: seven times the cost.
            ways.reverse()
        for blit, internal in ways:
            self._allocate(internal, width, height)
            self._blit = blit
            while gl.error():
                pass
            complete = not blit or self._complete()
            if complete:
                self._transfer(guard, x, y, width, height)
            if complete and gl.error() == e.NO_ERROR:
                return
        self._drop()
        guard.bind_framebuffer()
        self._tell(f"the driver cannot copy {source}")

    def _allocate(self, internal: int, width: int, height: int) -> None:
        self._drop()
        gl = self._gl
        gl.glGenTextures(1, ctypes.addressof(self._texture_name))
        gl.glActiveTexture(e.TEXTURE0 + self._ctx.default_texture_unit)
        name = self._texture_name.value
        gl.glBindTexture(e.TEXTURE_2D, name)
        layout, kind = UPLOAD.get(internal, (e.DEPTH_COMPONENT, e.FLOAT))
        gl.glTexImage2D(e.TEXTURE_2D, 0, internal, width, height, 0, layout, kind, None)
        for parameter, value in (
            (e.TEXTURE_MIN_FILTER, e.NEAREST),
            (e.TEXTURE_MAG_FILTER, e.NEAREST),
            (e.TEXTURE_WRAP_S, e.CLAMP_TO_EDGE),
            (e.TEXTURE_WRAP_T, e.CLAMP_TO_EDGE),
        ):
            gl.glTexParameteri(e.TEXTURE_2D, parameter, value)
        gl.glGenFramebuffers(1, ctypes.addressof(self._framebuffer_name))
        gl.glBindFramebuffer(e.DRAW_FRAMEBUFFER, self._framebuffer_name.value)
        point = e.DEPTH_STENCIL_ATTACHMENT if internal in UPLOAD else e.DEPTH_ATTACHMENT
        gl.glFramebufferTexture2D(e.DRAW_FRAMEBUFFER, point, e.TEXTURE_2D, name, 0)
        gl.glDrawBuffer(e.NONE)
        self._texture = self._ctx.external_texture(name, (width, height), 1, 0, "f4")

    def _complete(self) -> bool:
        status = self._gl.glCheckFramebufferStatus(e.DRAW_FRAMEBUFFER)
        return status == e.FRAMEBUFFER_COMPLETE

    def _transfer(self, guard: StateGuard, x: int, y: int, width: int, height: int) -> None:
        gl = self._gl
        if self._blit:
            gl.glBindFramebuffer(e.DRAW_FRAMEBUFFER, self._framebuffer_name.value)
            gl.glBlitFramebuffer(
                x, y, x + width, y + height, 0, 0, width, height, e.DEPTH_BUFFER_BIT, e.NEAREST
            )
        else:
            gl.glActiveTexture(e.TEXTURE0 + self._ctx.default_texture_unit)
            gl.glBindTexture(e.TEXTURE_2D, self._texture_name.value)
            gl.glCopyTexSubImage2D(e.TEXTURE_2D, 0, 0, 0, x, y, width, height)
        guard.bind_framebuffer()

    def _tell(self, reason: str) -> None:
        if not self._told:
            self._told = True
            _log.warning("no copy of the scene's depth: %s", reason)

    def _drop(self) -> None:
        if self._texture is not None:
            self._texture.release()
            self._texture = None
            self._gl.glDeleteFramebuffers(1, ctypes.addressof(self._framebuffer_name))
            self._gl.glDeleteTextures(1, ctypes.addressof(self._texture_name))

    def release(self) -> None:
        """Give texture and framebuffer back; twice does no harm."""
        self._drop()
        self._made_for = None
