"""What belongs to single draw buffers of the host's framebuffer."""

from __future__ import annotations

import ctypes

from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.gl import GL

BLENDING = (
    e.BLEND_SRC_RGB,
    e.BLEND_DST_RGB,
    e.BLEND_SRC_ALPHA,
    e.BLEND_DST_ALPHA,
    e.BLEND_EQUATION_RGB,
    e.BLEND_EQUATION_ALPHA,
)


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
        # Of those that are drawn to, and the second, which a host that sets all of them changes.
        asked = [index for index in self._indices if index == 1 or self._draws_to(index)]
        if any(self._read(index) != first for index in asked):
            self._different = [(index, self._read(index)) for index in self._indices]

    def _draws_to(self, index: int) -> bool:
        return self._named and self._buffers[index] != e.NONE

    @property
    def differ(self) -> bool:
        """Whether the host has them blend or mask differently."""
        return bool(self._different)

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
