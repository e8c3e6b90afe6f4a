"""The drops of a set that are in view, listed on the GPU, so that only these are drawn."""

from __future__ import annotations

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

    With `far`, the program for what is a few pixels large, there are twice as many commands.
    """

    def __init__(
        self,
        ctx: moderngl.Context,
        drops: DropSet,
        draw: moderngl.Program,
        far: moderngl.Program | None = None,
    ) -> None:
        self.drops = drops
        self._ids = ctx.buffer(reserve=4 * drops.capacity)
        chunks = -(-drops.capacity // CHUNK)
        self._commands = ctx.buffer(reserve=COMMAND_BYTES * chunks * (2 if far else 1))
        self._array = drops.array_for(draw, self._ids)
        self._far = drops.array_for(far, self._ids) if far else None

    @property
    def size(self) -> int:
        """Bytes on the GPU."""
        return int(self._ids.size + self._commands.size)

    def draw(self, cull: Any, count: int, order: ComputeOrder) -> None:
        """List those of the first `count` drops that are in view, by the program CULL, and draw."""
        chunks = -(-count // CHUNK)
        cull["streak_count"] = count
        self.drops.births.bind_to_storage_buffer(0)
        self.drops.states[0].bind_to_storage_buffer(1)
        self._ids.bind_to_storage_buffer(2)
        self._commands.bind_to_storage_buffer(3)
        cull.run(chunks)
        order.after(moderngl.ELEMENT_ARRAY_BARRIER_BIT | moderngl.COMMAND_BARRIER_BIT)
        if self._far is not None:
            self._far.render_indirect(self._commands, moderngl.POINTS, count=chunks, first=chunks)
        self._array.render_indirect(self._commands, moderngl.POINTS, count=chunks)

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        if self._far is not None:
            self._far.release()
        self._array.release()
        self._commands.release()
        self._ids.release()
