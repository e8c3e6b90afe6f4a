"""A texture coarser than the picture, into which veils are drawn before they are laid over it."""

from __future__ import annotations

import moderngl


class VeilSheet:
    """Made for a size when it is first needed there; `dtype` is moderngl's."""

    def __init__(self, ctx: moderngl.Context, dtype: str) -> None:
        self._ctx, self._dtype = ctx, dtype
        self._size = (0, 0)
        self._texture: moderngl.Texture | None = None
        self._target: moderngl.Framebuffer | None = None

    def begin(self, size: tuple[int, int]) -> None:
        """Bind it, cleared."""
        if size != self._size or self._target is None:
            self.release()
            self._size = size
            self._texture = self._ctx.texture(size, 4, dtype=self._dtype)
            self._texture.filter = moderngl.LINEAR, moderngl.LINEAR
            self._texture.repeat_x = self._texture.repeat_y = False
            self._target = self._ctx.framebuffer([self._texture])
        self._target.use()
        self._target.clear()

    def use(self, unit: int) -> None:
        """As a texture to read."""
        if self._texture is not None:
            self._texture.use(unit)

    def release(self) -> None:
        """Give texture and framebuffer back; twice does no harm."""
        if self._target is not None and self._texture is not None:
            self._target.release()
            self._texture.release()
            self._target = self._texture = None
