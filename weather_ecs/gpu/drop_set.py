"""The drops of one container on the GPU: records made once, moved there ever after."""

from __future__ import annotations

import moderngl
import numpy as np
from numpy.typing import NDArray

# Position and velocity, float32.
STATE_BYTES = 24
BIRTH_BYTES = 16
STATE_NAMES = ("in_position", "in_velocity")


class DropSet:
    """Buffers and vertex arrays of `capacity` drops; 64 bytes a drop with feedback, 40 without."""

    def __init__(
        self,
        ctx: moderngl.Context,
        births: NDArray[np.float32],
        draw_programs: tuple[moderngl.Program, moderngl.Program],
        feedback_program: moderngl.Program | None,
    ) -> None:
        self.capacity = len(births)
        self.births = ctx.buffer(np.ascontiguousarray(births, np.float32))
        sides = 2 if feedback_program is not None else 1
        self.states = [ctx.buffer(reserve=self.capacity * STATE_BYTES) for _ in range(sides)]
        self.current = 0
        self.last_used = 0
        # What the drops were placed by at their last step; None: not placed yet.
        self.placed: tuple[tuple[float, ...], tuple[float, ...]] | None = None
        self.steps = 0
        self.alive = 0  # drops that the last step moved
        # One for each of the programs (in the open, with shelter) and each side.
        self.draw_arrays = [
            self._array(ctx, program, state) for program in draw_programs for state in self.states
        ]
        self.step_arrays = (
            [self._array(ctx, feedback_program, state) for state in self.states]
            if feedback_program is not None
            else []
        )

    def _array(
        self, ctx: moderngl.Context, program: moderngl.Program, state: moderngl.Buffer
    ) -> moderngl.VertexArray:
        # A shader may leave an attribute unused; the compiler then drops it.
        names = [name if name in program else "" for name in STATE_NAMES]
        layout = " ".join(
            part if name else "12x" for part, name in zip(("3f", "3f"), names, strict=True)
        )
        return ctx.vertex_array(
            program,
            [
                (state, layout, *[name for name in names if name]),
                (self.births, "4f", "in_birth"),
            ],
        )

    def draw_array(self, sheltered: bool) -> moderngl.VertexArray:
        return self.draw_arrays[len(self.states) * sheltered + self.current]

    @property
    def bytes_per_drop(self) -> int:
        return BIRTH_BYTES + STATE_BYTES * len(self.states)

    def release(self) -> None:
        """Give every buffer back, in reverse order; twice does no harm."""
        for array in (*self.step_arrays, *self.draw_arrays):
            array.release()
        for buffer in (*self.states, self.births):
            buffer.release()
        self.step_arrays, self.draw_arrays, self.states = [], [], []


def fill_step(
    record: NDArray,
    drops: DropSet,
    axis: tuple[float, ...],
    shape: tuple[float, ...],
    wind: tuple[float, float, float],
    dt: float,
    law: tuple[float, ...],
    count: int,
    seed: int,
) -> None:
    """Write one step of `drops` into a record of the block RainStep."""
    before = drops.placed
    record["from_axis"], record["from_shape"] = before if before is not None else (axis, shape)
    record["to_axis"], record["to_shape"] = axis, shape
    record["rain_wind"] = (*wind, dt)
    record["rain_law"] = law
    record["rain_seed"] = seed & 0xFFFFFFFF
    record["rain_count"] = count
    record["rain_fresh"] = 0 if before is None else drops.alive

