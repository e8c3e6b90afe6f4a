"""The amplitudes of one water surface on the GPU: three textures that take turns, and a map."""

from __future__ import annotations

import math

import moderngl

# The map holds rises from cell to cell but one; this one is as much as it can tell, in mm.
GREATEST_RISE = 14.0
_HALVES = ((True, True, False, False), (False, False, True, True))


class RippleGrid:
    """Grids of `cells` (along, across); `amplitudes` by age: now, a step before, to be written."""

    def __init__(self, ctx: moderngl.Context, cells: tuple[int, int]) -> None:
        self.cells = cells
        self.steps: int | None = None  # of its own clock that are done; None: not begun
        self.last_used = 0
        self._wet_until = -math.inf  # s, the weather's clock, when rain last fell on it
        self._level = True
        flat = b"\0" * (4 * cells[0] * cells[1])
        self.amplitudes = [ctx.texture(cells, 1, flat, dtype="f4") for _ in range(3)]
        self._targets = {texture: ctx.framebuffer([texture]) for texture in self.amplitudes}
        for texture in self.amplitudes:
            texture.filter = moderngl.NEAREST, moderngl.NEAREST
        self.map = ctx.texture(cells, 4, b"\x7f" * (4 * cells[0] * cells[1]))
        self.map.build_mipmaps()
        self.map.filter = moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR
        self._map_target = ctx.framebuffer([self.map])
        self._newest = 0  # half of the map that holds the later step

    def begin(self, due: int, time: float, rains: bool, settling: float) -> int:
        """The first step to do so that `due` steps are done; above `due` where there is none.

        Water on which it has not rained for the settling time (s) is level, and does no steps.
        Water that has not been looked at for a while goes on from where it stopped. Changes the
        framebuffer.
        """
        done, self.steps = self.steps, due
        set_back = done is not None and done > due
        if rains:
            self._wet_until = time
        if set_back or (time - self._wet_until > settling and not self._level):
            self._flatten()
        if rains:
            self._level = False
        if self._level or done is None or set_back:
            return due + 1
        return done + 1

    def use_amplitudes(self, first_unit: int) -> None:
        """Bind now and before to two units."""
        self.amplitudes[0].use(first_unit)
        self.amplitudes[1].use(first_unit + 1)

    def draw_to_now(self) -> None:
        """Bind what is now, as the framebuffer."""
        self._targets[self.amplitudes[0]].use()

    def draw_to_following(self) -> None:
        """Bind what is to be written, as the framebuffer."""
        self._targets[self.amplitudes[2]].use()

    def turn(self) -> None:
        """What was written is now, what was now is before."""
        now, before, following = self.amplitudes
        self.amplitudes = [following, now, before]

    def draw_to_map(self) -> None:
        """Bind the half of the map that holds the earlier step; it will hold the later one."""
        self._newest = 1 - self._newest
        self._map_target.color_mask = _HALVES[self._newest]
        self._map_target.use()

    def later_share(self, share: float) -> float:
        """Share of the map's second half at `share` of the way from the earlier to the later."""
        return share if self._newest else 1.0 - share

    def _flatten(self) -> None:
        """Still water."""
        self._level = True
        for target in self._targets.values():
            target.clear()
        self._map_target.color_mask = (True,) * 4
        self._map_target.clear(*(127.0 / 255.0,) * 4)
        self.map.build_mipmaps()

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for target in (self._map_target, *self._targets.values()):
            target.release()
        for texture in (self.map, *self.amplitudes):
            texture.release()
