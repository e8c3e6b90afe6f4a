"""Rows of vec4 that a vertex shader fetches: written anew every draw, grown where they must."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray


class RowTexture:
    """A float texture `texels` wide with a row for each thing."""

    def __init__(self, ctx: moderngl.Context, texels: int, rows: int = 64) -> None:
        self._ctx, self._texels, self._rows = ctx, texels, rows
        self.texture = self._make()

    def _make(self) -> moderngl.Texture:
        texture = self._ctx.texture((self._texels, self._rows), 4, dtype="f4")
        texture.filter = (moderngl.NEAREST, moderngl.NEAREST)
        return texture

    def write(self, rows: NDArray[np.float32]) -> None:
        """Put (n, texels, 4) in, from the first row on."""
        if len(rows) > self._rows:
            while self._rows < len(rows):
                self._rows *= 2
            self.texture.release()
            self.texture = self._make()
        if len(rows):
            self.texture.write(rows.tobytes(), viewport=(0, 0, self._texels, len(rows)))

    def release(self) -> None:
        self.texture.release()
