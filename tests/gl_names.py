"""Which OpenGL objects are alive, asked name by name.

Some drivers give a freed name out again, the lowest first; Mesa counts on. So what is looked
through are the names from where a test begins to the one that the driver would give out next.
"""

from __future__ import annotations

import ctypes
from collections.abc import Callable
from functools import partial

from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.gl import GL

GENERATED = {
    "buffer": "Buffers",
    "texture": "Textures",
    "vertex array": "VertexArrays",
    "framebuffer": "Framebuffers",
    "renderbuffer": "Renderbuffers",
    "sampler": "Samplers",
    "query": "Queries",
}
BEFORE, BEYOND = 64, 1024  # names that are looked through around those of a test

_from: dict[int, dict[str, int]] = {}  # names a test begins with, by the context's handle


def begin(gl: GL) -> None:
    """A test begins: what is there already is looked for no more."""
    _from[gl.handle or 0] = _next_names(gl)


def living(gl: GL) -> dict[str, set[int]]:
    """Names of the objects there are, by kind.

    A deleted program does not count: Mesa keeps one for as long as any shader stage remembers it.
    """
    status = ctypes.c_int()

    def kept(is_one: Callable[[int], int], get: Callable[[int, int, int], None], name: int) -> bool:
        if not is_one(name):
            return False
        get(name, e.DELETE_STATUS, ctypes.addressof(status))
        return status.value == 0

    kinds: dict[str, Callable[[int], int]] = {
        "buffer": gl.glIsBuffer,
        "texture": gl.glIsTexture,
        "program": partial(kept, gl.glIsProgram, gl.glGetProgramiv),
        "shader": partial(kept, gl.glIsShader, gl.glGetShaderiv),
        "vertex array": gl.glIsVertexArray,
        "framebuffer": gl.glIsFramebuffer,
        "renderbuffer": gl.glIsRenderbuffer,
        "sampler": gl.glIsSampler,
        "query": gl.glIsQuery,
    }
    first, last = _from.get(gl.handle or 0, {}), _next_names(gl)
    found = {}
    for kind, there in kinds.items():
        start = max(first.get(kind, 1) - BEFORE, 1)
        names = range(start, max(last[kind], start + BEYOND))
        found[kind] = {name for name in names if there(name)}
    return found


def _next_names(gl: GL) -> dict[str, int]:
    """By kind, the name that the driver would give out next."""
    found, name = {}, ctypes.c_uint()
    for kind, plural in GENERATED.items():
        for verb in ("Gen", "Delete"):
            gl.reader(f"gl{verb}{plural}")(1, ctypes.byref(name))
        found[kind] = name.value
    address = gl._lookup(b"glCreateProgram")
    assert address
    program = ctypes.CFUNCTYPE(ctypes.c_uint)(address)()
    gl.glDeleteProgram(program)
    return {**found, "program": program, "shader": program}
