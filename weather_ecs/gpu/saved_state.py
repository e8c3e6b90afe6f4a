"""Reads the OpenGL state a guest has to put back, sets a known baseline, puts the state back."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from typing import Any, TypeAlias

from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.saved_bindings import IndexedBuffers, TextureUnits
from weather_ecs.gpu.saved_targets import BLENDING, DrawTargets
from weather_ecs.gpu.state_tables import (
    DOUBLES,
    FLOATS,
    FOREIGN,
    INTEGERS,
    SWITCHES,
    UNCHANGED,
    Row,
)

_Call: TypeAlias = tuple[Callable[..., None], tuple[Any, ...]]


class Values:
    """State values of one C type, read and set by the rows of a table."""

    def __init__(self, gl: GL, getter: str, c_type: Any, rows: Sequence[Row]) -> None:
        self._get = gl.reader(getter)
        size = ctypes.sizeof(c_type)
        self.start: dict[int, int] = {}  # place of a state value, by its name
        self._reads: list[tuple[int, Any]] = []
        # How to set them, their places, and their baseline, which may be none.
        self._sets: list[
            tuple[Callable[..., None], tuple[int, ...], int, int, tuple[float, ...]]
        ] = []
        # Place and baseline of what only the host changes, and how to set it.
        self._unchanged: list[tuple[int, int, Callable[..., None], tuple[int, ...]]] = []
        self._forth: list[_Call] = []  # to the baseline
        self._back: list[_Call] = []
        # Two to spare: the polygon mode is one value or two.
        self._buffer = (c_type * (sum(n for row in rows for _, n in row[2]) + 2))()
        self.values: list[Any] = []
        filled = 0
        for name, prefix, parts, baseline in rows:
            function = getattr(gl, name)
            if function is None or not known(gl, parts[0][0]):
                continue
            first = filled
            for part, count in parts:
                self.start[part] = filled
                self._reads.append((part, ctypes.byref(self._buffer, filled * size)))
                filled += count
            if parts[0][0] in UNCHANGED and baseline is not None:
                self._unchanged.append((first, int(baseline[0]), function, prefix))
                continue
            self._sets.append((function, prefix, first, filled, baseline or ()))

    def save(self) -> None:
        get = self._get
        for name, place in self._reads:
            get(name, place)
        values = self._buffer[:]
        if values != self.values:
            self.values = values
            self._plan()

    def _plan(self) -> None:
        """How to come to the baseline from the values, and back; they are seldom others."""
        values = self.values
        self._back = [
            (function, (*prefix, *values[first:last]))
            for function, prefix, first, last, _ in self._sets
        ]
        self._forth = [
            (function, (*prefix, *wanted))
            for function, prefix, first, _, wanted in self._sets
            if wanted and tuple(values[first : first + len(wanted)]) != wanted
        ]
        for place, wanted, setter, prefix in self._unchanged:
            if values[place] != wanted:
                self._forth.append((setter, (*prefix, wanted)))
                self._back.append((setter, (*prefix, values[place])))

    def replace(self, name: int, value: Any) -> None:
        """Put back another value than the one that was saved."""
        self.values[self.start[name]] = value
        self._plan()

    def baseline(self) -> None:
        for function, arguments in self._forth:
            function(*arguments)

    def reset(self) -> None:
        """The baseline whatever the values are now."""
        for function, prefix, _, _, wanted in self._sets:
            if wanted:
                function(*prefix, *wanted)
        for _, level, setter, prefix in self._unchanged:
            setter(*prefix, level)

    def restore(self) -> None:
        for function, arguments in self._back:
            function(*arguments)


def known(gl: GL, name: int) -> bool:
    """Whether the driver knows a state value; leaves no error behind."""
    while gl.error():
        pass
    gl.get_ints(name, 16)
    return gl.error() == e.NO_ERROR


class Switches:
    """The capabilities of glEnable."""

    def __init__(self, gl: GL) -> None:
        self._gl = gl
        self._ours = [pair for pair in SWITCHES if known(gl, pair[0])]
        self._place = {pair[0]: k for k, pair in enumerate(self._ours)}
        self._foreign = [capability for capability in FOREIGN if known(gl, capability)]
        self._on: list[int] = []
        self._foreign_on: list[int] = []

    def save(self) -> None:
        is_enabled = self._gl.glIsEnabled
        self._on = [is_enabled(capability) for capability, _ in self._ours]
        self._foreign_on = [capability for capability in self._foreign if is_enabled(capability)]

    def is_on(self, capability: int) -> int:
        """Whether the host has one on that passes may switch."""
        return self._on[self._place[capability]]

    def baseline(self) -> None:
        gl = self._gl
        for (capability, wanted), on in zip(self._ours, self._on, strict=True):
            if wanted is not None and wanted != on:
                (gl.glEnable if wanted else gl.glDisable)(capability)
        for capability in self._foreign_on:
            gl.glDisable(capability)

    def reset(self) -> None:
        gl = self._gl
        for capability, wanted in self._ours:
            if wanted is not None:
                (gl.glEnable if wanted else gl.glDisable)(capability)
        for capability in self._foreign:
            gl.glDisable(capability)

    def restore(self) -> None:
        enable, disable = self._gl.glEnable, self._gl.glDisable
        for (capability, _), on in zip(self._ours, self._on, strict=True):
            (enable if on else disable)(capability)
        for capability in self._foreign_on:
            enable(capability)


class SavedState:
    """All of it: `save`, then `baseline`, then `restore`. The framebuffer stays bound throughout.

    Must be made, and used, with the context of `gl` current.
    """

    def __init__(
        self, gl: GL, *, texture_units: int, own_unit: int, uniform_slots: int, storage_slots: int
    ) -> None:
        self._gl = gl
        self._integers = Values(gl, "glGetIntegerv", ctypes.c_int, INTEGERS)
        self._floats = Values(gl, "glGetFloatv", ctypes.c_float, FLOATS)
        self._doubles = Values(gl, "glGetDoublev", ctypes.c_double, DOUBLES)
        self._switches = Switches(gl)
        self._textures = TextureUnits(gl, texture_units, own_unit)
        self._buffers = IndexedBuffers(gl, uniform_slots, storage_slots)
        self._targets = DrawTargets(gl)
        self._parts = (self._integers, self._floats, self._doubles, self._switches)
        start = self._integers.start
        # Of the first draw buffer, what `DrawTargets` reads of the others.
        self._first = [start[e.COLOR_WRITEMASK] + k for k in range(4)]
        if gl.glBlendFuncSeparatei is not None:
            self._first += [start[name] for name in BLENDING]

    def save(self) -> None:
        for part in self._parts:
            part.save()
        self._textures.save()
        self._buffers.save()
        values = self._integers.values
        first = self._switches.is_on(e.BLEND), *[values[place] for place in self._first]
        self._targets.save(self.draw_framebuffer, first)

    def baseline(self) -> None:
        for part in self._parts:
            part.baseline()
        if self._targets.differ:
            self._integers.reset()  # what the first target has says nothing of the others
        self._textures.baseline()

    def reset(self) -> None:
        """The baseline whatever was done since, as after foreign code."""
        for part in self._parts:
            part.reset()
        self._textures.baseline()

    def restore(self) -> None:
        # Binding an indexed buffer also binds the plain one, so those come first.
        self._buffers.restore()
        self._textures.restore()
        integers, gl = self._integers, self._gl
        # A program that was deleted while in use is gone once another one was used; and the host
        # may have bound a block of ours that was given back in the meantime.
        for name, there in (
            (e.CURRENT_PROGRAM, gl.glIsProgram),
            (e.UNIFORM_BUFFER_BINDING, gl.glIsBuffer),
        ):
            value = integers.values[integers.start[name]]
            if value and not there(value):
                integers.replace(name, 0)
        for part in self._parts:
            part.restore()
        self._targets.restore()

    @property
    def draw_framebuffer(self) -> int:
        """Name of the framebuffer the host draws to; 0 is the window's."""
        return int(self._integers.values[self._integers.start[e.DRAW_FRAMEBUFFER_BINDING]])

    @property
    def viewport(self) -> tuple[int, int, int, int]:
        """The host's viewport: x, y, width, height in pixels."""
        first = self._integers.start[e.VIEWPORT]
        x, y, width, height = self._integers.values[first : first + 4]
        return x, y, width, height
