"""The impacts of a list whose splashes are to be seen, found on the GPU: only these are drawn."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import moderngl

from weather_ecs.gpu.compute_order import ComputeOrder
from weather_ecs.gpu.impact_list import ImpactList
from weather_ecs.gpu.impact_source import impact_array
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.gpu.streak_list import CHUNK, COMMAND_BYTES

CULL = ProgramKey(compute="splash_cull.comp")
_READ = moderngl.ELEMENT_ARRAY_BARRIER_BIT | moderngl.COMMAND_BARRIER_BIT


@dataclass(slots=True)
class _Shown:
    """What is to be seen of one list of impacts: four bytes a record, two commands a chunk."""

    impacts: ImpactList
    ids: moderngl.Buffer
    commands: moderngl.Buffer
    arrays: list[moderngl.VertexArray]  # one a program

    def release(self) -> None:
        for array in self.arrays:
            array.release()
        self.commands.release()
        self.ids.release()


class SplashList:
    """Lists of what is to be seen, by observer; `small` and `large` programs read the impacts."""

    def __init__(
        self, ctx: moderngl.Context, shaders: ShaderLoader, *programs: moderngl.Program
    ) -> None:
        self._ctx = ctx
        self._cull: Any = shaders.program(CULL)
        self._order = ComputeOrder(ctx)
        self._programs = programs
        self._shown: dict[int, _Shown] = {}

    def find(self, key: int, impacts: ImpactList) -> None:
        """List what is to be seen, as the blocks RainView and Splash are bound."""
        shown = self._shown.get(key)
        if shown is None or shown.impacts is not impacts:
            if shown is not None:
                shown.release()
            shown = self._shown[key] = self._make(impacts)
        impacts.records.bind_to_storage_buffer(3)
        shown.ids.bind_to_storage_buffer(4)
        shown.commands.bind_to_storage_buffer(5)
        self._cull.run(chunks_of(impacts))
        self._order.after(_READ)

    def draw(self, key: int, program: int, large: bool) -> None:
        """Draw the small or the large ones with one of the programs."""
        shown = self._shown[key]
        chunks = chunks_of(shown.impacts)
        shown.arrays[program].render_indirect(
            shown.commands, moderngl.POINTS, count=chunks, first=chunks if large else 0
        )

    def buffers(self, key: int) -> tuple[moderngl.Buffer, moderngl.Buffer]:
        """Numbers of records, and draw commands; for tests."""
        return self._shown[key].ids, self._shown[key].commands

    def _make(self, impacts: ImpactList) -> _Shown:
        ids = self._ctx.buffer(reserve=4 * CHUNK * chunks_of(impacts))
        commands = self._ctx.buffer(reserve=2 * COMMAND_BYTES * chunks_of(impacts))
        arrays = [
            impact_array(self._ctx, program, impacts.records, ids) for program in self._programs
        ]
        return _Shown(impacts, ids, commands, arrays)

    def forget(self, key: int) -> None:
        """Give back what belongs to an observer who is gone."""
        shown = self._shown.pop(key, None)
        if shown is not None:
            shown.release()

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for key in list(self._shown):
            self.forget(key)


def chunks_of(impacts: ImpactList) -> int:
    """Work groups, and draw commands of either kind."""
    return -(-impacts.capacity // CHUNK)
