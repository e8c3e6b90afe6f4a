"""The drops of a set that are in view, listed on the GPU, so that only these are drawn."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import moderngl

from weather_ecs.gpu.compute_order import ComputeOrder
from weather_ecs.gpu.drop_set import DropSet
from weather_ecs.gpu.shader_loader import ProgramKey

CULL = ProgramKey(compute="streak_cull.comp")
CHUNK = 128 * 32  # drops of one work group and one draw command; also in streak_cull.comp
COMMAND_BYTES = 20


class StreakList:
    """Four bytes a drop, and a draw command a chunk; the order is that of the drops.

    `draw` are the programs without lamps and with them. With `far`, those for what is a few pixels
    large, there are twice as many commands.
    """

    def __init__(
        self,
        ctx: moderngl.Context,
        drops: DropSet,
        draw: Mapping[bool, moderngl.Program],
        far: Mapping[bool, moderngl.Program] | None,
        order: ComputeOrder,
    ) -> None:
        self.drops = drops
        self._order = order
        self._ids = ctx.buffer(reserve=4 * drops.capacity)
        chunks = -(-drops.capacity // CHUNK)
        self._commands = ctx.buffer(reserve=COMMAND_BYTES * chunks * (2 if far else 1))
        self._arrays = self._made(draw)
        self._far = self._made(far or {})

    def _made(self, programs: Mapping[bool, moderngl.Program]) -> dict[bool, moderngl.VertexArray]:
        arrays = {}
        for lit, each in programs.items():
            (arrays[lit],) = self.drops.arrays_for(each, self._ids)
        return arrays

    @property
    def bytes_per_drop(self) -> int:
        return 4

    def draw(self, cull: Any, count: int, lit: bool) -> None:
        """List those of the first `count` drops that are in view, by the program CULL, and draw.

        lit: by the programs that know lamps.
        """
        chunks = -(-count // CHUNK)
        cull["streak_count"] = count
        self.drops.births.bind_to_storage_buffer(0)
        self.drops.states[0].bind_to_storage_buffer(1)
        self._ids.bind_to_storage_buffer(2)
        self._commands.bind_to_storage_buffer(3)
        cull.run(chunks)
        self._order.after(moderngl.ELEMENT_ARRAY_BARRIER_BIT | moderngl.COMMAND_BARRIER_BIT)
        if self._far:
            far = self._far[lit]
            far.render_indirect(self._commands, moderngl.POINTS, count=chunks, first=chunks)
        self._arrays[lit].render_indirect(self._commands, moderngl.POINTS, count=chunks)

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for array in (*self._far.values(), *self._arrays.values()):
            array.release()
        self._commands.release()
        self._ids.release()
