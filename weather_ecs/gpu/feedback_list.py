"""The drops of a set that are in view, listed by transform feedback: the feedback backend."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import moderngl

from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.drop_set import TOGETHER, DropSet
from weather_ecs.gpu.gl import GL
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
AT_ONCE = 65_536  # indices that are emptied at a time

# What a geometry shader needs to write two lists of different lengths.
_STREAMS = {"GL_ARB_gpu_shader5", "GL_ARB_transform_feedback3"}


def has_streams(ctx: moderngl.Context) -> bool:
    """Whether small flakes can be listed apart; OpenGL 4.0 can."""
    return ctx.extensions >= _STREAMS


class Lister:
    """What all lists need: indices that start primitives anew, and writing to ranges of a buffer.

    moderngl writes to buffers from the same place in each.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self.ctx = ctx
        self._gl = GL()
        self._anew = ctx.buffer(b"\xff" * (4 * AT_ONCE))

    def empty(self, buffer: moderngl.Buffer, first: int, count: int) -> None:
        """Let none of so many indices be a drop's."""
        for done in range(0, count, AT_ONCE):
            size = 4 * min(count - done, AT_ONCE)
            self.ctx.copy_buffer(buffer, self._anew, size, write_offset=4 * (first + done))

    def write(
        self, cull: Any, array: moderngl.VertexArray, count: int, ids: moderngl.Buffer,
        firsts: Sequence[int],
    ) -> None:  # fmt: skip
        """Run `cull` over so many drops; its outputs go to `ids`, each from a first one on."""
        gl, target = self._gl, e.TRANSFORM_FEEDBACK_BUFFER
        cull["streak_count"] = count
        gl.glUseProgram(cull.glo)
        gl.glBindVertexArray(array.glo)
        for slot, first in enumerate(firsts):
            gl.glBindBufferRange(target, slot, ids.glo, 4 * first, 4 * count)
        gl.glEnable(e.RASTERIZER_DISCARD)
        gl.glBeginTransformFeedback(e.POINTS)
        gl.glDrawArrays(e.LINES_ADJACENCY, 0, -(-count // TOGETHER) * TOGETHER)
        gl.glEndTransformFeedback()
        gl.glDisable(e.RASTERIZER_DISCARD)
        for slot in range(len(firsts)):
            gl.glBindBufferBase(target, slot, 0)

    def release(self) -> None:
        """Give the indices back; twice does no harm."""
        self._anew.release()


class FeedbackList:
    """The numbers of what is in view, in the set's idle side, which the next step writes anew.

    So they take no room of their own; the order is that of the drops. How many there are stays
    on the GPU: lists are drawn whole, and behind the last of those in view stands the index that
    starts primitives anew, of which nothing comes. `draw` are the programs without lamps and with
    them; with `far`, those for what is a few pixels large, there is a second list.
    """

    bytes_per_drop = 0

    def __init__(
        self,
        lister: Lister,
        drops: DropSet,
        draw: Mapping[bool, moderngl.Program],
        far: Mapping[bool, moderngl.Program] | None = None,
    ) -> None:
        self.drops = drops
        self._lister = lister
        # By list, then by whether there are lamps, then by the side of the set that is read.
        self._arrays = [
            {lit: drops.arrays_for(each) for lit, each in programs.items()}
            for programs in ((draw, far) if far else (draw,))
        ]
        # Index at which each list begins.
        self.firsts = tuple(k * drops.rows for k in range(len(self._arrays)))

    @property
    def ids(self) -> moderngl.Buffer:
        """Where the lists are now."""
        return self.drops.states[1 - self.drops.current]

    def look(self, cull: Any, count: int) -> None:
        """List those of the first `count` drops that are in view, by the program `cull`."""
        if count <= 0:
            return
        for first in self.firsts:
            self._lister.empty(self.ids, first, count)
        self._lister.write(cull, self.drops.array(CULL_NAME), count, self.ids, self.firsts)

    def draw(self, cull: Any, count: int, lit: bool) -> None:
        """Draw those listed of the first `count` drops. lit: by the programs that know lamps."""
        if count <= 0:
            return
        self._lister.ctx.enable_direct(e.PRIMITIVE_RESTART)
        for arrays, first in zip(reversed(self._arrays), reversed(self.firsts), strict=True):
            array = arrays[lit][self.drops.current]
            array.render(moderngl.POINTS, vertices=count, first=first)
        self._lister.ctx.disable_direct(e.PRIMITIVE_RESTART)

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for by_lamps in self._arrays:
            for arrays in by_lamps.values():
                for array in arrays:
                    array.release()
