"""The drops of one container on the GPU: records made once, moved there ever after."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import moderngl
import numpy as np
from numpy.typing import NDArray

if TYPE_CHECKING:
    from weather_ecs.gpu.feedback_list import FeedbackList
    from weather_ecs.gpu.streak_list import StreakList

# Position and velocity, float32.
STATE_BYTES = 24
BIRTH_BYTES = 16
TOGETHER = 4  # drops that streak_cull.geom takes at a time; buffers with two sides are filled up


class DropSet:
    """Buffers and vertex arrays of `capacity` drops.

    With the lists of those in view 64 bytes a drop with feedback, 44 without.

    `programs` are those that read the drops as vertices, by name; each gets its vertex arrays.
    With `two_sided`, the state is double, for transform feedback from one side to the other.
    """

    def __init__(
        self,
        ctx: moderngl.Context,
        births: NDArray[np.float32],
        programs: Mapping[str, moderngl.Program],
        two_sided: bool,
    ) -> None:
        self.capacity = len(births)
        self.rows = rows = self.capacity
        if two_sided:
            self.rows = rows = -(-rows // TOGETHER) * TOGETHER
            births = np.pad(births, ((0, rows - self.capacity), (0, 0)))
        self.births = ctx.buffer(np.ascontiguousarray(births, np.float32))
        self.states = [ctx.buffer(reserve=rows * STATE_BYTES) for _ in range(2 if two_sided else 1)]
        self.current = 0
        self.last_used = 0
        # What the drops were placed by at their last step; None: not placed yet.
        self.placed: tuple[tuple[float, ...], tuple[float, ...]] | None = None
        self.steps = 0
        self.alive = 0  # drops that the last step moved
        self.streaks: StreakList | FeedbackList | None = None  # those in view
        self._ctx = ctx
        self._arrays: dict[str, list[moderngl.VertexArray]] = {}
        for name, program in programs.items():
            self.add_reader(name, program)

    def add_reader(self, name: str, program: moderngl.Program) -> None:
        """A program that is run over the drops: `array(name)` is for it from here on."""
        self._arrays[name] = [self._array(program, state, None) for state in self.states]

    def arrays_for(
        self, program: moderngl.Program, ids: moderngl.Buffer | None = None
    ) -> list[moderngl.VertexArray]:
        """Vertex arrays over the drops that `ids` lists, by `current`; the caller's to release.

        None: that the other side lists, the one that is idle.
        """
        sides = zip(self.states, reversed(self.states), strict=True)
        return [self._array(program, state, idle if ids is None else ids) for state, idle in sides]

    def _array(
        self, program: moderngl.Program, state: moderngl.Buffer, ids: moderngl.Buffer | None
    ) -> moderngl.VertexArray:
        # A shader may leave an attribute unused; the compiler then drops it.
        names = [name if name in program else "" for name in ("in_position", "in_velocity")]
        layout = " ".join("3f" if name else "12x" for name in names)
        content = [(state, layout, *[name for name in names if name])]
        if "in_birth" in program:
            content.append((self.births, "4f", "in_birth"))
        return self._ctx.vertex_array(program, content, index_buffer=ids)

    def array(self, name: str) -> moderngl.VertexArray:
        """The vertex array of a program over the drops as they are now."""
        return self._arrays[name][self.current]

    @property
    def bytes_per_drop(self) -> int:
        listed = self.streaks.bytes_per_drop if self.streaks is not None else 0
        return BIRTH_BYTES + STATE_BYTES * len(self.states) + listed

    def release(self) -> None:
        """Give every buffer back, in reverse order; twice does no harm."""
        if self.streaks is not None:
            self.streaks.release()
            self.streaks = None
        for arrays in reversed(self._arrays.values()):
            for array in arrays:
                array.release()
        for buffer in (*self.states, self.births):
            buffer.release()
        self._arrays = {}
        self.states = []
