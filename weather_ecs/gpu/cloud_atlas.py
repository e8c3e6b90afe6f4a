"""The atlas of impostors: a texture cut into tiles twice as wide as high, by halving."""

from __future__ import annotations

import moderngl

Tile = tuple[int, int, int]  # column, row, height: it begins at (2 column, row) texels


class TileSpace:
    """Which parts of a square of `size` are free; squares whose sides are powers of two."""

    def __init__(self, size: int, smallest: int) -> None:
        self.size = size
        self._free: dict[int, set[tuple[int, int]]] = {}
        side = size
        while side >= smallest:
            self._free[side] = set()
            side //= 2
        self._free[size].add((0, 0))

    def take(self, side: int) -> Tile | None:
        """A free square, or None; the smallest free one that holds it is cut."""
        whole = side
        while whole <= self.size and not self._free[whole]:
            whole *= 2
        if whole > self.size:
            return None
        x, y = self._free[whole].pop()
        while whole > side:
            whole //= 2
            self._free[whole] |= {(x + whole, y), (x, y + whole), (x + whole, y + whole)}
        return x, y, side

    def give(self, tile: Tile) -> None:
        """Free a square again; four that were cut from one become one."""
        x, y, side = tile
        while side < self.size:
            left, low = x - x % (2 * side), y - y % (2 * side)
            four = {(left + i * side, low + j * side) for i in (0, 1) for j in (0, 1)}
            four.discard((x, y))
            if not four <= self._free[side]:
                break
            self._free[side] -= four
            x, y, side = left, low, 2 * side
        self._free[side].add((x, y))


class Atlas:
    """The texture with its framebuffer, and the space on it."""

    SMALLEST = 16  # texels, height of a tile

    def __init__(self, ctx: moderngl.Context, height: int) -> None:
        self.height = height
        self.space = TileSpace(height, self.SMALLEST)
        self.texture = ctx.texture((2 * height, height), 4)
        self.texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
        self.texture.repeat_x = self.texture.repeat_y = False
        self.framebuffer = ctx.framebuffer([self.texture])

    def frame(self, tile: Tile) -> tuple[float, float, float]:
        """u, v and the size, one for both, of a tile, half a texel in from its rim."""
        x, y, side = tile
        inset = 0.5
        scale = 1.0 / self.height
        return (x + 0.5 * inset) * scale, (y + inset) * scale, (side - 2.0 * inset) * scale

    def begin(self, tile: Tile) -> None:
        """Clear a tile and draw to it."""
        x, y, side = tile
        box = (2 * x, y, 2 * side, side)
        self.framebuffer.use()
        self.framebuffer.clear(0.0, 0.0, 0.0, 0.0, viewport=box)
        self.framebuffer.viewport = box

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self.framebuffer.release()
        self.texture.release()
