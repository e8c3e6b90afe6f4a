"""The drops of a set that are in view, listed by transform feedback: the feedback backend."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import moderngl

from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.drop_set import TOGETHER, DropSet
from weather_ecs.gpu.shader_loader import ProgramKey

CULL = ProgramKey(
    vertex="streak_cull.vert", geometry="streak_cull.geom", varyings=("seen",), separate=True
)
CULL_APART = ProgramKey(
    vertex="streak_cull.vert",
    geometry="streak_cull.geom",
    defines=("APART",),
    varyings=("seen", "seen_small"),
    separate=True,
)
CULL_NAME = "cull"  # of the array that is looked through

# What a geometry shader needs to write two lists of different lengths.
_STREAMS = {"GL_ARB_gpu_shader5", "GL_ARB_transform_feedback3"}


def has_streams(ctx: moderngl.Context) -> bool:
    """Whether small flakes can be listed apart; OpenGL 4.0 can."""
    return ctx.extensions >= _STREAMS


class FeedbackList:
    """Four bytes a drop and list, and four that empty them; the order is that of the drops.

    How many there are stays on the GPU: lists are drawn whole, and behind the last of those in view
    stands the index that starts primitives anew, of which nothing comes. `draw` are the programs
    without lamps and with them; with `far`, those for what is a few pixels large, there is a second
    list.
    """

    def __init__(
        self,
        ctx: moderngl.Context,
        drops: DropSet,
        draw: Mapping[bool, moderngl.Program],
        far: Mapping[bool, moderngl.Program] | None = None,
    ) -> None:
        self.drops = drops
        self._ctx = ctx
        self._empty = ctx.buffer(b"\xff" * (4 * drops.capacity))
        self.ids: list[moderngl.Buffer] = []
        # By list, then by whether there are lamps, then by the side of the set that is read.
        self._arrays: list[dict[bool, list[moderngl.VertexArray]]] = []
        for programs in (draw, far) if far else (draw,):
            ids = ctx.buffer(reserve=4 * drops.capacity)
            self.ids.append(ids)
            self._arrays.append(
                {lit: drops.arrays_for(each, ids) for lit, each in programs.items()}
            )

    @property
    def bytes_per_drop(self) -> int:
        return 4 * (len(self.ids) + 1)

    def draw(self, cull: Any, count: int, lit: bool) -> None:
        """List those of the first `count` drops that are in view, by the program `cull`, and draw.

        lit: by the programs that know lamps.
        """
        if count <= 0:
            return
        for ids in self.ids:
            self._ctx.copy_buffer(ids, self._empty, 4 * count)
        cull["streak_count"] = count
        array = self.drops.array(CULL_NAME)
        whole = -(-count // TOGETHER) * TOGETHER
        array.transform(self.ids, moderngl.LINES_ADJACENCY, vertices=whole)
        self._ctx.enable_direct(e.PRIMITIVE_RESTART)
        for arrays in reversed(self._arrays):
            arrays[lit][self.drops.current].render(moderngl.POINTS, vertices=count)
        self._ctx.disable_direct(e.PRIMITIVE_RESTART)

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for by_lamps in self._arrays:
            for arrays in by_lamps.values():
                for array in arrays:
                    array.release()
        for buffer in (*self.ids, self._empty):
            buffer.release()
