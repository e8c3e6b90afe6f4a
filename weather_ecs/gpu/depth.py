"""A copy of the host's depth that shaders can sample: where the scene ends along a view ray."""

from __future__ import annotations

import ctypes
import logging
from typing import NamedTuple

import moderngl

from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.by_size import BySize
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


class _Copy:
    """A depth texture of a size, to be filled by a blit or by a copy of texels."""

    def __init__(
        self, ctx: moderngl.Context, gl: GL, internal: int, size: tuple[int, int], blit: bool
    ) -> None:
        self._gl, self._size, self._blit = gl, size, blit
        self._unit = e.TEXTURE0 + ctx.default_texture_unit
        self._texture_name, self._framebuffer_name = ctypes.c_uint(), ctypes.c_uint()
        gl.glGenTextures(1, ctypes.addressof(self._texture_name))
        gl.glActiveTexture(self._unit)
        name = self._texture_name.value
        gl.glBindTexture(e.TEXTURE_2D, name)
        layout, kind = UPLOAD.get(internal, (e.DEPTH_COMPONENT, e.FLOAT))
        gl.glTexImage2D(e.TEXTURE_2D, 0, internal, *size, 0, layout, kind, None)
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
        self.texture: moderngl.Texture | None = ctx.external_texture(name, size, 1, 0, "f4")

    def usable(self) -> bool:
        """Whether the driver can blit into it, where it has to; right after it was made."""
        status = self._gl.glCheckFramebufferStatus(e.DRAW_FRAMEBUFFER)
        return not self._blit or status == e.FRAMEBUFFER_COMPLETE

    def fill(self, x: int, y: int) -> None:
        """From the framebuffer that is bound for reading, from a pixel on; binds others."""
        gl, (width, height) = self._gl, self._size
        if self._blit:
            gl.glBindFramebuffer(e.DRAW_FRAMEBUFFER, self._framebuffer_name.value)
            gl.glBlitFramebuffer(
                x, y, x + width, y + height, 0, 0, width, height, e.DEPTH_BUFFER_BIT, e.NEAREST
            )
        else:
            gl.glActiveTexture(self._unit)
            gl.glBindTexture(e.TEXTURE_2D, self._texture_name.value)
            gl.glCopyTexSubImage2D(e.TEXTURE_2D, 0, 0, 0, x, y, width, height)

    def release(self) -> None:
        """Give texture and framebuffer back; twice does no harm."""
        if self.texture is not None:
            self.texture.release()
            self.texture = None
            self._gl.glDeleteFramebuffers(1, ctypes.addressof(self._framebuffer_name))
            self._gl.glDeleteTextures(1, ctypes.addressof(self._texture_name))


class _NoCopy:
    """Stands for that of a source that the driver cannot copy."""

    texture = None

    def fill(self, x: int, y: int) -> None:
        """Nothing."""

    def release(self) -> None:
        """Nothing."""


class DepthCopy:
    """Keeps a depth texture of each viewport's size and fills it from the host's framebuffer.

    Texel (0, 0) is the viewport's lower left corner; values are window depth in [0, 1].
    """

    def __init__(self, ctx: moderngl.Context, gl: GL) -> None:
        self._ctx = ctx
        self._gl = gl
        self._copies: BySize[_Copy | _NoCopy] = BySize()
        self._told = False

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
        found = self._copies.get(
            (source, width, height), lambda: self._make(guard, source, (width, height))
        )
        found.fill(x, y)
        guard.bind_framebuffer()
        return found.texture

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

    def _make(self, guard: StateGuard, source: Source, size: tuple[int, int]) -> _Copy | _NoCopy:
        """A way that works for this source, the cheaper one on Mesa first."""
        gl = self._gl
        exact = FORMATS.get(source[:3], e.DEPTH_COMPONENT24)
        plain = e.DEPTH_COMPONENT32F if source.floating else e.DEPTH_COMPONENT24
        ways = [(True, exact), (False, plain)]
        if source.samples:
            ways = [(True, exact), (True, plain)]  # only a blit resolves samples
        elif source.stencil_bits:
            # Blitting into a depth-stencil texture carries the stencil along: seven times the cost.
            ways.reverse()
        x, y, _, _ = guard.viewport
        for blit, internal in ways:
            made = _Copy(self._ctx, gl, internal, size, blit)
            while gl.error():
                pass
            usable = made.usable()
            if usable:
                made.fill(x, y)
            fine = usable and gl.error() == e.NO_ERROR
            guard.bind_framebuffer()
            if fine:
                return made
            made.release()
        self._tell(f"the driver cannot copy {source}")
        return _NoCopy()

    def _tell(self, reason: str) -> None:
        if not self._told:
            self._told = True
            _log.warning("no copy of the scene's depth: %s", reason)

    def release(self) -> None:
        """Give textures and framebuffers back; twice does no harm."""
        self._copies.release()
