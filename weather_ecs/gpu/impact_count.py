"""How many drops have hit something in a frame: counted on the GPU, read when it is done."""

from __future__ import annotations

from collections import deque
from struct import Struct

import moderngl

from weather_ecs.frame import ViewData
from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.impact_list import COUNT_BYTES
from weather_ecs.gpu.impact_source import ImpactReader
from weather_ecs.gpu.rain_pass import RainPass
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.gpu.timer import RING, PrimitiveCounter, QueryRing

COUNT = ProgramKey(vertex="impact_count.vert", geometry="impact_count.geom")
# With feedback every drop has to be looked at, so only one frame in so many is counted.
_EVERY = 8
COUNTS = Struct("<4I")  # COUNT_BYTES of them


class ImpactCount:
    """Impacts of a frame, `latest` of one a few frames back; make it before the first update.

    With compute a copy of the list's own counter, with feedback a count of primitives.
    """

    def __init__(
        self, ctx: moderngl.Context, gl: GL, shaders: ShaderLoader, rain: RainPass
    ) -> None:
        self._ctx, self._gl, self._rain = ctx, gl, rain
        self._latest = 0
        self._frames = 0
        self._copies: list[moderngl.Buffer] = []
        self._reader: ImpactReader | None = None
        self._counter: PrimitiveCounter | None = None
        self._done: QueryRing | None = None
        if rain.has_lists:
            # A time stamp after a copy tells when the copy may be read without a wait.
            self._done = QueryRing(gl, 1)
            self._copies = [ctx.buffer(reserve=COUNT_BYTES) for _ in range(RING)]
            self._free = list(self._copies)
            self._waiting: deque[moderngl.Buffer] = deque()
        else:
            self._reader = ImpactReader(ctx, shaders, rain, "impact count", COUNT)
            self._counter = PrimitiveCounter(gl)

    @property
    def latest(self) -> int:
        """Of the latest frame whose count the GPU has done; asked before a frame is drawn."""
        if self._counter is not None:
            self._latest = self._counter.latest or 0
        elif self._done is not None:
            for _ in self._done.finished():
                copy = self._waiting.popleft()
                written, dropped, *before = COUNTS.unpack(copy.read())
                self._latest = (written + dropped - sum(before)) & 0xFFFFFFFF
                self._free.append(copy)
        return self._latest

    def count(self, view: ViewData) -> None:
        """Ask for the count of the frame whose drops have just been moved."""
        self._frames += 1
        if self._done is not None:
            self._copy(view)
        elif self._reader is not None and self._counter is not None and view.dt > 0.0:
            if self._frames % _EVERY:
                return
            self._ctx.enable_only(moderngl.RASTERIZER_DISCARD)
            with self._counter:
                self._reader.run(view)
            self._ctx.enable_only(moderngl.NOTHING)

    def _copy(self, view: ViewData) -> None:
        impacts = self._rain.impacts(view.key)
        group = self._done.take() if self._done is not None and impacts is not None else None
        if group is None or impacts is None or self._done is None:
            return
        copy = self._free.pop()
        self._ctx.memory_barrier(moderngl.BUFFER_UPDATE_BARRIER_BIT)
        self._ctx.copy_buffer(copy, impacts.counts, COUNT_BYTES)
        self._gl.glQueryCounter(group[0], e.TIMESTAMP)
        self._done.put(group)
        self._waiting.append(copy)

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for thing in (self._counter, self._reader, self._done, *self._copies):
            if thing is not None:
                thing.release()
        self._copies.clear()
        self._done = self._counter = None
