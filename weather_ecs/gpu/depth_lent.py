"""The host's own depth texture, read where it is, where a copy of it costs much."""

from __future__ import annotations

import ctypes
from typing import Any

import moderngl

from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.guard import StateGuard

# What a texture must be like to be read in place of a copy, and the value of a new one.
PLAIN = (
    (e.TEXTURE_TARGET, e.TEXTURE_2D),
    (e.TEXTURE_BASE_LEVEL, 0),
    (e.DEPTH_STENCIL_TEXTURE_MODE, e.DEPTH_COMPONENT),
    (e.TEXTURE_SWIZZLE_R, e.RED),
)
# How it is read, as a copy is: the host's own values come back afterwards.
READ = (
    (e.TEXTURE_COMPARE_MODE, e.NONE),
    (e.TEXTURE_MIN_FILTER, e.NEAREST),
    (e.TEXTURE_MAG_FILTER, e.NEAREST),
    (e.TEXTURE_WRAP_S, e.CLAMP_TO_EDGE),
    (e.TEXTURE_WRAP_T, e.CLAMP_TO_EDGE),
)
# Of the attachment: a texture, whole, and the first of its images.
WHOLE = (
    (e.FRAMEBUFFER_ATTACHMENT_OBJECT_TYPE, e.TEXTURE),
    (e.FRAMEBUFFER_ATTACHMENT_TEXTURE_LEVEL, 0),
    (e.FRAMEBUFFER_ATTACHMENT_TEXTURE_LAYER, 0),
    (e.FRAMEBUFFER_ATTACHMENT_LAYERED, 0),
)
MOST = 8  # textures of hosts that are known at once


class LentDepth:
    """Lends the depth texture of the host's framebuffer to passes that write no depth.

    OpenGL 4.5 allows that for what was written before its texture barrier. To Mesa's software
    rasteriser a copy is a pass over the memory that waits for all drawing; other drivers copy at
    once, and keep their compressed depth to themselves: there nothing is lent.
    """

    def __init__(self, ctx: moderngl.Context, gl: GL) -> None:
        self._ctx = ctx
        self._gl: Any = gl  # with the functions of OpenGL 4.5, where it is able
        software = str(ctx.info["GL_RENDERER"]).startswith("llvmpipe")
        self._able = software and gl.glTextureBarrier is not None
        self._value = ctypes.c_int()
        self._place = ctypes.addressof(self._value)
        # moderngl never frees all of what it makes for a host's texture, so each is made once.
        self._known: dict[tuple[int, tuple[int, int]], moderngl.Texture] = {}
        # The host's values of what READ changes, each with the name of its texture.
        self._given: list[tuple[int, int, int]] = []

    def take(self, guard: StateGuard) -> moderngl.Texture | None:
        """The depth as it is now, to be read until `give_back`; None where a copy is needed.

        The host's framebuffer must be bound, and its viewport be the whole of the texture.
        """
        if not self._able or not guard.framebuffer.glo:
            return None
        gl, attached = self._gl, self._gl.get_attachment
        point = e.DRAW_FRAMEBUFFER, e.DEPTH_ATTACHMENT
        for name, wanted in WHOLE:
            if attached(*point, name) != wanted:
                return None
        texture = attached(*point, e.FRAMEBUFFER_ATTACHMENT_OBJECT_NAME)
        # What the host has deleted stays attached, but is known by its name no more.
        if not gl.glIsTexture(texture):
            return None
        if any(self._of(texture, name) != wanted for name, wanted in PLAIN):
            return None
        size = self._size(texture)
        if guard.viewport != (0, 0, *size):
            return None
        for name, wanted in READ:
            found = self._of(texture, name)
            if found != wanted:
                self._given.append((texture, name, found))
                gl.glTextureParameteri(texture, name, wanted)
        gl.glTextureBarrier()
        return self._wrapped(texture, size)

    def give_back(self) -> None:
        """The host's own ways of reading it again; without `take` nothing is done."""
        for given in self._given:
            self._gl.glTextureParameteri(*given)
        self._given.clear()

    def _of(self, texture: int, name: int) -> int:
        self._gl.glGetTextureParameteriv(texture, name, self._place)
        return self._value.value

    def _size(self, texture: int) -> tuple[int, int]:
        read = self._gl.glGetTextureLevelParameteriv
        sides = []
        for name in (e.TEXTURE_WIDTH, e.TEXTURE_HEIGHT):
            read(texture, 0, name, self._place)
            sides.append(self._value.value)
        return sides[0], sides[1]

    def _wrapped(self, texture: int, size: tuple[int, int]) -> moderngl.Texture:
        """moderngl's object for the texture, which stays the host's."""
        known = self._known.get((texture, size))
        if known is None:
            if len(self._known) == MOST:
                self.release()
            known = self._ctx.external_texture(texture, size, 1, 0, "f4")
            self._known[texture, size] = known
        return known

    def release(self) -> None:
        """Forget the host's textures; twice does no harm."""
        for texture in self._known.values():
            texture.release()
        self._known.clear()
