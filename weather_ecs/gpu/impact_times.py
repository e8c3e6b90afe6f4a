"""Times of impacts in 32 bits, however long the weather has run.

A float of 32 bits tells 0.1 ms apart for a quarter of an hour, 8 ms after a day and 62 ms after a
week, in which a splash is half over. So shaders count from the last full EPOCH of the clock, and
when that is another one, what has been listed is counted from it too.
"""

from __future__ import annotations

import math
from typing import Any

import moderngl

from weather_ecs.gpu.compute_order import ComputeOrder
from weather_ecs.gpu.impact_list import ImpactList
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader

EPOCH = 1024.0  # s
GROUP = 64  # records that a work group of impact_shift.comp goes over

SHIFT = ProgramKey(compute="impact_shift.comp")
_SHIFTED = moderngl.SHADER_STORAGE_BARRIER_BIT | moderngl.VERTEX_ATTRIB_ARRAY_BARRIER_BIT


def in_epoch(time: float) -> float:
    """s since the last full epoch of the weather's clock: what shaders get of it."""
    return time % EPOCH


class ImpactTimes:
    """Brings lists of impacts to the epoch of the clock; makes nothing before it must."""

    def __init__(self, shaders: ShaderLoader, order: ComputeOrder) -> None:
        self._shaders, self._order = shaders, order

    def follow(self, impacts: ImpactList, time: float) -> None:
        """The weather's clock is at `time`, s. Where it was set back, nothing has been hit yet."""
        before, impacts.time = impacts.time, time
        if before is None:
            return
        if time < before:
            impacts.clear()
            return
        shift = EPOCH * (math.floor(time / EPOCH) - math.floor(before / EPOCH))
        if shift:
            program: Any = self._shaders.program(SHIFT)
            program["impact_shift"] = shift
            impacts.records.bind_to_storage_buffer(3)
            program.run(-(-impacts.capacity // GROUP))
            self._order.after(_SHIFTED)
