"""`Target`: a picture that a view draws into and a panel shows."""

from __future__ import annotations

import moderngl
from imgui_bundle import imgui
from pyglet import gl

LARGEST = 8192  # pixels on a side


class Target:
    """Colour and depth of the size that is asked for, kept while it stays the same."""

    def __init__(self, gl: moderngl.Context) -> None:
        self._gl = gl
        self._color: moderngl.Texture | None = None
        self._depth: moderngl.Renderbuffer | None = None
        self._framebuffer: moderngl.Framebuffer | None = None

    @property
    def size(self) -> tuple[int, int]:
        """Pixels; (0, 0) before it was used."""
        return (0, 0) if self._color is None else self._color.size

    def use(self, size: tuple[int, int]) -> moderngl.Framebuffer:
        """Bind it with this size in pixels, its viewport all of it."""
        size = (min(max(size[0], 1), LARGEST), min(max(size[1], 1), LARGEST))
        if self._framebuffer is None or self.size != size:
            # Moderngl comes back to what is bound after it has made a framebuffer: not to this one.
            self._gl.detect_framebuffer(0).use()
            self.release()
            self._color = self._gl.texture(size, 4)
            self._color.filter = (moderngl.LINEAR, moderngl.LINEAR)
            self._depth = self._gl.depth_renderbuffer(size)
            self._framebuffer = self._gl.framebuffer([self._color], self._depth)
        self._framebuffer.use()
        self._framebuffer.viewport = (0, 0, *size)
        self._gl.scissor = None
        return self._framebuffer

    def begin_drawing(self) -> None:
        """Let the driver draw what it has been given, while widgets are still being made."""
        gl.glFlush()

    def image(self) -> imgui.ImTextureRef:
        """What imgui shows; upside down: see `view.UPRIGHT`."""
        assert self._color is not None, "nothing has been drawn into it"
        return imgui.ImTextureRef(self._color.glo)

    def copy_to(self, box: tuple[int, int, int, int]) -> None:
        """Into the window's framebuffer: left, bottom, right, top in its pixels."""
        if self._framebuffer is None:
            return
        gl.glBindFramebuffer(gl.GL_READ_FRAMEBUFFER, self._framebuffer.glo)
        gl.glBindFramebuffer(gl.GL_DRAW_FRAMEBUFFER, 0)
        whole = (box[2] - box[0], box[3] - box[1]) == self.size
        filtered = gl.GL_NEAREST if whole else gl.GL_LINEAR
        gl.glBlitFramebuffer(0, 0, *self.size, *box, gl.GL_COLOR_BUFFER_BIT, filtered)
        gl.glBindFramebuffer(gl.GL_FRAMEBUFFER, 0)

    def read(self) -> bytes:
        """RGB bytes, the lowest row first."""
        assert self._framebuffer is not None, "nothing has been drawn into it"
        return bytes(self._framebuffer.read(components=3))

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for part in (self._framebuffer, self._depth, self._color):
            if part is not None:
                part.release()
        self._framebuffer = self._depth = self._color = None
