"""Reads the OpenGL state a guest has to put back, sets a known baseline, puts the state back."""

from __future__ import annotations

import ctypes
from collections.abc import Callable, Sequence
from typing import Any

from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.saved_bindings import IndexedBuffers, TextureUnits
from weather_ecs.gpu.state_tables import (
    DOUBLES,
    FLOATS,
    FOREIGN,
    INTEGERS,
    SWITCHES,
    UNCHANGED,
    Row,
)


class Values:
    """State values of one C type, read and set by the rows of a table."""

    def __init__(self, gl: GL, getter: str, c_type: Any, rows: Sequence[Row]) -> None:
        self._get = gl.reader(getter)
        size = ctypes.sizeof(c_type)
        self.start: dict[int, int] = {}  # place of a state value, by its name
        self._reads: list[tuple[int, Any]] = []
        self._sets: list[tuple[Callable[..., None], tuple[int, ...], int, int]] = []
        self._baseline: list[tuple[Callable[..., None], tuple[float, ...]]] = []
        # Place and baseline of what only the host changes, and how to set it.
        self._unchanged: list[tuple[int, int, Callable[..., None], tuple[int, ...]]] = []
        self._calls: list[tuple[Callable[..., None], tuple[Any, ...]]] = []  # that restore
        self._calls_for: list[Any] = []  # the values they are for: mostly those of the last frame
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
            self._sets.append((function, prefix, first, filled))
            if baseline is not None:
                self._baseline.append((function, (*prefix, *baseline)))

    def save(self) -> None:
        get = self._get
        for name, place in self._reads:
            get(name, place)
        self.values = self._buffer[:]

    def baseline(self) -> None:
        for function, arguments in self._baseline:
            function(*arguments)
        values = self.values
        for place, wanted, setter, prefix in self._unchanged:
            if values[place] != wanted:
                setter(*prefix, wanted)

    def reset(self) -> None:
        """The baseline whatever the values are now."""
        for function, arguments in self._baseline:
            function(*arguments)
        for _, wanted, setter, prefix in self._unchanged:
            setter(*prefix, wanted)

    def restore(self) -> None:
        values = self.values
        if values != self._calls_for:
            self._calls_for = list(values)
            self._calls = [
                (function, (*prefix, *values[first:last]))
                for function, prefix, first, last in self._sets
            ]
        for function, arguments in self._calls:
            function(*arguments)
        for place, wanted, setter, prefix in self._unchanged:
            if values[place] != wanted:
                setter(*prefix, values[place])


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
            place = integers.start[name]
            if integers.values[place] and not there(integers.values[place]):
                integers.values[place] = 0
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


class DrawTargets:
    """What belongs to single draw buffers: their choice, and blending and masks set one by one."""

    def __init__(self, gl: GL) -> None:
        self._gl = gl
        count = min(gl.get_int(e.MAX_DRAW_BUFFERS), 8)
        self._indices = range(1, count)
        self._buffers = (ctypes.c_int * count)()
        self._get, self._get_indexed = gl.reader("glGetIntegerv"), gl.reader("glGetIntegeri_v")
        self._reads = [
            (e.DRAW_BUFFER0 + i, ctypes.byref(self._buffers, 4 * i)) for i in range(count)
        ]
        self._named = False
        self._scratch = (ctypes.c_int * 4)()
        self._place = ctypes.byref(self._scratch)
        self._different: list[tuple[int, tuple[int, ...]]] = []

    def save(self, framebuffer: int, first: tuple[int, ...]) -> None:
        """`first`: of the first draw buffer, what `_read` has of the others."""
        self._named = framebuffer != 0
        if self._named:
            get = self._get
            for name, place in self._reads:
                get(name, place)
        self._different = []
        # A host that blends its targets differently makes the second differ from the first.
        if self._indices and self._read(1) != first:
            self._different = [(index, self._read(index)) for index in self._indices]

    def _read(self, index: int) -> tuple[int, ...]:
        gl, get, scratch, place = self._gl, self._get_indexed, self._scratch, self._place
        get(e.COLOR_WRITEMASK, index, place)
        values = [gl.glIsEnabledi(e.BLEND, index), *scratch]
        if gl.glBlendFuncSeparatei is not None:
            for name in BLENDING:
                get(name, index, place)
                values.append(scratch[0])
        return tuple(values)

    def restore(self) -> None:
        gl = self._gl
        if self._named:
            gl.glDrawBuffers(len(self._buffers), ctypes.addressof(self._buffers))
        for index, (blend, red, green, blue, alpha, *function) in self._different:
            (gl.glEnablei if blend else gl.glDisablei)(e.BLEND, index)
            gl.glColorMaski(index, red, green, blue, alpha)
            if function and gl.glBlendFuncSeparatei and gl.glBlendEquationSeparatei:
                gl.glBlendFuncSeparatei(index, *function[:4])
                gl.glBlendEquationSeparatei(index, *function[4:])


BLENDING = (
    e.BLEND_SRC_RGB,
    e.BLEND_DST_RGB,
    e.BLEND_SRC_ALPHA,
    e.BLEND_DST_ALPHA,
    e.BLEND_EQUATION_RGB,
    e.BLEND_EQUATION_ALPHA,
)
