"""GPU time and primitive counts, read some frames later so that nothing ever waits for them."""

from __future__ import annotations

import ctypes
from collections import deque
from types import TracebackType
from typing import Self

from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.gl import GL

RING = 6  # measurements under way at most; further ones are skipped


class QueryRing:
    """Groups of `size` query objects: some free, some waiting for the GPU, oldest first."""

    def __init__(self, gl: GL, size: int) -> None:
        self._gl = gl
        self._names = (ctypes.c_uint * (RING * size))()
        gl.glGenQueries(len(self._names), ctypes.addressof(self._names))
        names = list(self._names)
        self._free = [tuple(names[i : i + size]) for i in range(0, len(names), size)]
        self._waiting: deque[tuple[int, ...]] = deque()
        self._value = ctypes.c_uint64()
        self._place = ctypes.byref(self._value)
        self._ready = ctypes.c_int()
        self._ready_place = ctypes.byref(self._ready)
        self._ask = gl.reader("glGetQueryObjectiv")
        self._read = gl.reader("glGetQueryObjectui64v")

    def take(self) -> tuple[int, ...] | None:
        """A free group, None where all are under way."""
        return self._free.pop() if self._free else None

    def put(self, group: tuple[int, ...]) -> None:
        self._waiting.append(group)

    def finished(self) -> list[tuple[int, ...]]:
        """Results of every group that has them all, oldest first; does not wait."""
        results = []
        waiting, ready, value = self._waiting, self._ready, self._value
        while waiting:
            group = waiting[0]
            # The last query of a group is the last to be done.
            self._ask(group[-1], e.QUERY_RESULT_AVAILABLE, self._ready_place)
            if not ready.value:
                break
            found = []
            for name in group:
                self._read(name, e.QUERY_RESULT, self._place)
                found.append(int(value.value))
            results.append(tuple(found))
            self._free.append(waiting.popleft())
        return results

    def release(self) -> None:
        """Give the query objects back; twice does no harm."""
        if self._names:
            self._gl.glDeleteQueries(len(self._names), ctypes.addressof(self._names))
            self._names = (ctypes.c_uint * 0)()
        self._free.clear()
        self._waiting.clear()


class Measure:
    """What measures from `begin` to `end`, or in a `with`."""

    _ring: QueryRing | None

    def _take(self) -> tuple[int, ...] | None:
        """Queries to measure with; None where all are under way."""
        if self._ring is None:
            return None
        group = self._ring.take()
        if group is None:  # nobody has asked for results of late
            self._poll()
            group = self._ring.take()
        return group

    def _poll(self) -> None:
        """Take what the GPU has done."""

    def begin(self) -> None:
        """Measure from here on."""

    def end(self) -> None:
        """Measure up to here."""

    def __enter__(self) -> Self:
        self.begin()
        return self

    def __exit__(
        self,
        kind: type[BaseException] | None,
        error: BaseException | None,
        trace: TracebackType | None,
    ) -> None:
        self.end()


class GpuTimer(Measure):
    """Time the GPU takes between `begin` and `end`, or in a `with`.

    Two time stamps rather than an elapsed-time query, of which only one may run: the host's.
    Where there are none, `latest_ms` stays None.
    """

    def __init__(self, gl: GL) -> None:
        self._gl = gl
        supported = gl.get_query(e.TIMESTAMP, e.QUERY_COUNTER_BITS) > 0
        self._ring = QueryRing(gl, 2) if supported else None
        self._open: tuple[int, ...] | None = None
        self._latest: float | None = None

    def begin(self) -> None:
        if self._ring is None or self._open is not None:
            return
        self._open = self._take()
        if self._open is not None:
            self._gl.glQueryCounter(self._open[0], e.TIMESTAMP)

    def end(self) -> None:
        if self._ring is None or self._open is None:
            return
        self._gl.glQueryCounter(self._open[1], e.TIMESTAMP)
        self._ring.put(self._open)
        self._open = None

    def _poll(self) -> None:
        if self._ring is not None:
            for start, stop in self._ring.finished():
                self._latest = (stop - start) * 1e-6

    @property
    def latest_ms(self) -> float | None:
        """Milliseconds of the latest measurement the GPU has done; None before the first."""
        self._poll()
        return self._latest

    def release(self) -> None:
        """Give the query objects back; twice does no harm."""
        if self._ring is not None:
            self._ring.release()
            self._ring = None


class PrimitiveCounter(Measure):
    """Primitives that leave the vertex or geometry shader between `begin` and `end`.

    Skips a measurement while the host counts primitives itself.
    """

    def __init__(self, gl: GL) -> None:
        self._gl = gl
        supported = gl.get_query(e.PRIMITIVES_GENERATED, e.QUERY_COUNTER_BITS) > 0
        self._ring = QueryRing(gl, 1) if supported else None
        self._open: tuple[int, ...] | None = None
        self._latest: int | None = None

    def begin(self) -> None:
        if self._ring is None or self._open is not None:
            return
        if self._gl.get_query(e.PRIMITIVES_GENERATED, e.CURRENT_QUERY):
            return
        self._open = self._take()
        if self._open is not None:
            self._gl.glBeginQuery(e.PRIMITIVES_GENERATED, self._open[0])

    def end(self) -> None:
        if self._ring is None or self._open is None:
            return
        self._gl.glEndQuery(e.PRIMITIVES_GENERATED)
        self._ring.put(self._open)
        self._open = None

    def _poll(self) -> None:
        if self._ring is not None:
            for (count,) in self._ring.finished():
                self._latest = count

    @property
    def latest(self) -> int | None:
        """The latest count the GPU has done; None before the first."""
        self._poll()
        return self._latest

    def release(self) -> None:
        """Give the query objects back; twice does no harm."""
        if self._open is not None:
            self.end()
        if self._ring is not None:
            self._ring.release()
            self._ring = None
