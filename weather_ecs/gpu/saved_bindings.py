"""Bindings with an index: textures and samplers by unit, uniform, storage and feedback buffers."""

from __future__ import annotations

import ctypes
from typing import Any

from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.state_tables import MADE, TEXTURES

FEEDBACK_SLOTS = 4


class TextureUnits:
    """Textures and samplers of units below `count`, and of `own`, where moderngl makes textures."""

    def __init__(self, gl: GL, count: int, own: int) -> None:
        self._gl = gl
        self._count = min(count, gl.get_int(e.MAX_TEXTURE_IMAGE_UNITS))
        units = [unit for unit in range(self._count) if unit != own]
        bindings = [(unit, pair) for unit in units for pair in TEXTURES]
        bindings += [(own, pair) for pair in (*TEXTURES, *MADE)]
        samplers = [(unit, (0, e.SAMPLER_BINDING)) for unit in range(self._count)]
        self._values = (ctypes.c_int * (len(bindings) + len(samplers)))()
        self._get = gl.reader("glGetIntegerv")
        self._units = [e.TEXTURE0 + unit for unit in sorted({*range(self._count), own})]
        self._reads: dict[int, list[tuple[int, Any]]] = {unit: [] for unit in self._units}
        self._binds: dict[int, list[tuple[int, int]]] = {unit: [] for unit in self._units}
        for place, (unit, (target, name)) in enumerate(bindings + samplers):
            reference = ctypes.byref(self._values, 4 * place)
            self._reads[e.TEXTURE0 + unit].append((name, reference))
            if target:
                self._binds[e.TEXTURE0 + unit].append((target, place))
        self._first_sampler = len(bindings)
        self._samplers = ctypes.addressof(self._values) + 4 * self._first_sampler
        self._active = e.TEXTURE0

    def save(self) -> None:
        gl = self._gl
        get, activate = self._get, gl.glActiveTexture
        self._active = gl.get_int(e.ACTIVE_TEXTURE)
        for unit, reads in self._reads.items():
            activate(unit)
            for name, place in reads:
                get(name, place)

    def baseline(self) -> None:
        """A host's sampler object would override the filters of our textures."""
        if self._gl.glBindSamplers is not None:
            self._gl.glBindSamplers(0, self._count, None)
            return
        for unit in range(self._count):
            self._gl.glBindSampler(unit, 0)

    def restore(self) -> None:
        gl = self._gl
        bind, activate, values = gl.glBindTexture, gl.glActiveTexture, self._values[:]
        there = gl.glIsTexture
        for unit, binds in self._binds.items():
            activate(unit)
            for target, place in binds:
                name = values[place]
                # The host may have bound a map of ours that was given back in the meantime.
                bind(target, name if name == 0 or there(name) else 0)
        activate(self._active)
        if gl.glBindSamplers is not None:
            gl.glBindSamplers(0, self._count, self._samplers)
            return
        for unit, sampler in enumerate(values[self._first_sampler :]):
            gl.glBindSampler(unit, sampler)


class Slots:
    """Indexed bindings `first`, `first` + 1, ... of one buffer target, ranges included."""

    def __init__(
        self, gl: GL, target: int, names: tuple[int, int, int], first: int, count: int
    ) -> None:
        self._gl = gl
        self._target = target
        self._name, self._start, self._size = names
        self._buffer = (ctypes.c_int * max(count, 1))()
        self._get = gl.reader("glGetIntegeri_v")
        self._reads = [(first + i, ctypes.byref(self._buffer, 4 * i)) for i in range(count)]
        # To see at once whether there is any: a host's bindings seldom reach up here.
        self._bytes, self._nothing = memoryview(self._buffer).cast("B"), bytes(self._buffer)
        self._range = (ctypes.c_int64 * 2)()
        self._ranges: dict[int, tuple[int, int]] = {}

    def save(self) -> None:
        get, name = self._get, self._name
        for index, place in self._reads:
            get(name, index, place)
        self._ranges = {}
        if self._bytes != self._nothing:
            address = ctypes.addressof(self._range)
            for (index, _), buffer in zip(self._reads, self._buffer, strict=False):
                if buffer:
                    self._gl.glGetInteger64i_v(self._start, index, address)
                    self._gl.glGetInteger64i_v(self._size, index, address + 8)
                    self._ranges[index] = (self._range[0], self._range[1])

    def restore(self) -> None:
        target, bind = self._target, self._gl.glBindBufferBase
        if not self._ranges and self._reads and self._gl.glBindBuffersBase is not None:
            self._gl.glBindBuffersBase(target, self._reads[0][0], len(self._reads), None)
            return
        there = self._gl.glIsBuffer
        for (index, _), buffer in zip(self._reads, self._buffer, strict=False):
            start, size = self._ranges.get(index, (0, 0))
            if buffer and not there(buffer):
                bind(target, index, 0)
            elif size:
                self._gl.glBindBufferRange(target, index, buffer, start, size)
            else:
                bind(target, index, buffer)


class IndexedBuffers:
    """The indexed buffer bindings a guest uses, and the transform feedback object."""

    def __init__(self, gl: GL, uniform_slots: int, storage_slots: int) -> None:
        self._gl = gl
        limit = gl.get_int(e.MAX_UNIFORM_BUFFER_BINDINGS)
        uniform_slots = min(uniform_slots, limit)
        self._slots = [
            Slots(
                gl,
                e.UNIFORM_BUFFER,
                (e.UNIFORM_BUFFER_BINDING, e.UNIFORM_BUFFER_START, e.UNIFORM_BUFFER_SIZE),
                limit - uniform_slots,
                uniform_slots,
            ),
            Slots(
                gl,
                e.TRANSFORM_FEEDBACK_BUFFER,
                (
                    e.TRANSFORM_FEEDBACK_BUFFER_BINDING,
                    e.TRANSFORM_FEEDBACK_BUFFER_START,
                    e.TRANSFORM_FEEDBACK_BUFFER_SIZE,
                ),
                0,
                FEEDBACK_SLOTS,
            ),
        ]
        if gl.version >= 430:
            self._slots.append(
                Slots(
                    gl,
                    e.SHADER_STORAGE_BUFFER,
                    (
                        e.SHADER_STORAGE_BUFFER_BINDING,
                        e.SHADER_STORAGE_BUFFER_START,
                        e.SHADER_STORAGE_BUFFER_SIZE,
                    ),
                    0,
                    min(storage_slots, gl.get_int(e.MAX_SHADER_STORAGE_BUFFER_BINDINGS)),
                )
            )
        self._feedback = 0

    def save(self) -> None:
        gl = self._gl
        if gl.glBindTransformFeedback is not None:
            self._feedback = gl.get_int(e.TRANSFORM_FEEDBACK_BINDING)
            if self._feedback:
                # Its bindings are its own; ours go into the default object.
                gl.glBindTransformFeedback(e.TRANSFORM_FEEDBACK, 0)
        for slots in self._slots:
            slots.save()

    def restore(self) -> None:
        for slots in self._slots:
            slots.restore()
        if self._feedback and self._gl.glBindTransformFeedback is not None:
            self._gl.glBindTransformFeedback(e.TRANSFORM_FEEDBACK, self._feedback)
