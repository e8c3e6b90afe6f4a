"""A texture coarser than the picture, into which veils are drawn before they are laid over it."""

from __future__ import annotations

import moderngl

from weather_ecs.gpu.by_size import BySize


class _Sheet:
    """One of a size."""

    def __init__(self, ctx: moderngl.Context, size: tuple[int, int], dtype: str) -> None:
        self.texture = ctx.texture(size, 4, dtype=dtype)
        self.texture.filter = moderngl.LINEAR, moderngl.LINEAR
        self.texture.repeat_x = self.texture.repeat_y = False
        self.target = ctx.framebuffer([self.texture])

    def release(self) -> None:
        self.target.release()
        self.texture.release()


class VeilSheet:
    """Made for a size when it is first needed there; `dtype` is moderngl's."""

    def __init__(self, ctx: moderngl.Context, dtype: str) -> None:
        self._ctx, self._dtype = ctx, dtype
        self._sheets: BySize[_Sheet] = BySize()
        self._current: _Sheet | None = None

    def begin(self, size: tuple[int, int]) -> None:
        """Bind it, cleared."""
        found = self._sheets.get(size, lambda: _Sheet(self._ctx, size, self._dtype))
        self._current = found
        found.target.use()
        found.target.clear()

    def use(self, unit: int) -> None:
        """As a texture to read, what was drawn since `begin`."""
        if self._current is not None:
            self._current.texture.use(unit)

    def release(self) -> None:
        """Give textures and framebuffers back; twice does no harm."""
        self._sheets.release()
        self._current = None
