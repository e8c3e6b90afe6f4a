"""Everything OpenGL lets one read of its state, through pyglet.gl: moderngl cannot read it all."""

from __future__ import annotations

import ctypes
from ctypes import byref

from pyglet import gl

State = dict[str, tuple[float, ...]]

SWITCHES = """BLEND DEPTH_TEST CULL_FACE SCISSOR_TEST STENCIL_TEST PROGRAM_POINT_SIZE MULTISAMPLE
SAMPLE_ALPHA_TO_COVERAGE SAMPLE_ALPHA_TO_ONE SAMPLE_COVERAGE SAMPLE_MASK POLYGON_OFFSET_FILL
POLYGON_OFFSET_LINE POLYGON_OFFSET_POINT DITHER FRAMEBUFFER_SRGB RASTERIZER_DISCARD
PRIMITIVE_RESTART DEPTH_CLAMP COLOR_LOGIC_OP TEXTURE_CUBE_MAP_SEAMLESS LINE_SMOOTH POLYGON_SMOOTH
CLIP_DISTANCE0 CLIP_DISTANCE1 CLIP_DISTANCE2 CLIP_DISTANCE3""".split()

INTEGERS = """CURRENT_PROGRAM VERTEX_ARRAY_BINDING ARRAY_BUFFER_BINDING
ELEMENT_ARRAY_BUFFER_BINDING UNIFORM_BUFFER_BINDING TRANSFORM_FEEDBACK_BUFFER_BINDING
PIXEL_PACK_BUFFER_BINDING PIXEL_UNPACK_BUFFER_BINDING COPY_READ_BUFFER_BINDING
COPY_WRITE_BUFFER_BINDING TEXTURE_BUFFER_BINDING DRAW_FRAMEBUFFER_BINDING READ_FRAMEBUFFER_BINDING
RENDERBUFFER_BINDING ACTIVE_TEXTURE BLEND_SRC_RGB BLEND_DST_RGB BLEND_SRC_ALPHA BLEND_DST_ALPHA
BLEND_EQUATION_RGB BLEND_EQUATION_ALPHA DEPTH_FUNC DEPTH_WRITEMASK STENCIL_FUNC STENCIL_REF
STENCIL_VALUE_MASK STENCIL_WRITEMASK STENCIL_FAIL STENCIL_PASS_DEPTH_FAIL STENCIL_PASS_DEPTH_PASS
STENCIL_BACK_FUNC STENCIL_BACK_REF STENCIL_BACK_WRITEMASK CULL_FACE_MODE FRONT_FACE
LOGIC_OP_MODE PROVOKING_VERTEX PRIMITIVE_RESTART_INDEX UNPACK_ALIGNMENT
UNPACK_ROW_LENGTH UNPACK_SKIP_ROWS UNPACK_SKIP_PIXELS PACK_ALIGNMENT PACK_ROW_LENGTH
DRAW_BUFFER READ_BUFFER STENCIL_CLEAR_VALUE""".split()

INTEGERS_43 = """DRAW_INDIRECT_BUFFER_BINDING DISPATCH_INDIRECT_BUFFER_BINDING
SHADER_STORAGE_BUFFER_BINDING ATOMIC_COUNTER_BUFFER_BINDING TRANSFORM_FEEDBACK_BINDING
PROGRAM_PIPELINE_BINDING""".split()

FLOATS = {
    "VIEWPORT": 4,
    "SCISSOR_BOX": 4,
    "DEPTH_RANGE": 2,
    "BLEND_COLOR": 4,
    "COLOR_CLEAR_VALUE": 4,
    "DEPTH_CLEAR_VALUE": 1,
    "COLOR_WRITEMASK": 4,
    "LINE_WIDTH": 1,
    "POINT_SIZE": 1,
    "POLYGON_OFFSET_FACTOR": 1,
    "POLYGON_OFFSET_UNITS": 1,
    "SAMPLE_COVERAGE_VALUE": 1,
}

TEXTURES = """TEXTURE_BINDING_1D TEXTURE_BINDING_2D TEXTURE_BINDING_3D TEXTURE_BINDING_CUBE_MAP
TEXTURE_BINDING_1D_ARRAY TEXTURE_BINDING_2D_ARRAY TEXTURE_BINDING_BUFFER
TEXTURE_BINDING_RECTANGLE TEXTURE_BINDING_2D_MULTISAMPLE SAMPLER_BINDING""".split()

INDEXED = {"UNIFORM_BUFFER": "MAX_UNIFORM_BUFFER_BINDINGS"}
INDEXED_43 = {
    "SHADER_STORAGE_BUFFER": "MAX_SHADER_STORAGE_BUFFER_BINDINGS",
    "ATOMIC_COUNTER_BUFFER": "MAX_ATOMIC_COUNTER_BUFFER_BINDINGS",
}

KINDS = "Buffer Texture Program Shader VertexArray Framebuffer Renderbuffer Query Sampler".split()


def enum(name: str) -> int:
    return getattr(gl, "GL_" + name)


def integer(name: str) -> int:
    value = ctypes.c_int()
    gl.glGetIntegerv(enum(name), byref(value))
    return value.value


def version() -> int:
    return 10 * integer("MAJOR_VERSION") + integer("MINOR_VERSION")


def read_state() -> State:
    """The current context's state: a name for every value."""
    state: State = {name: (gl.glIsEnabled(enum(name)),) for name in SWITCHES}
    current = version() >= 43
    for name in INTEGERS + (INTEGERS_43 if current else []):
        state[name] = (integer(name),)
    for name, count in FLOATS.items():
        values = (ctypes.c_float * count)()
        gl.glGetFloatv(enum(name), values)
        state[name] = tuple(values)
    polygon = (ctypes.c_int * 2)()
    gl.glGetIntegerv(enum("POLYGON_MODE"), polygon)
    state["POLYGON_MODE"] = (polygon[0],)
    _read_textures(state)
    _read_indexed(state, current)
    _read_attributes(state)
    return state


def _read_textures(state: State) -> None:
    active = integer("ACTIVE_TEXTURE")
    for unit in range(min(80, integer("MAX_COMBINED_TEXTURE_IMAGE_UNITS"))):
        gl.glActiveTexture(gl.GL_TEXTURE0 + unit)
        for name in TEXTURES:
            state[f"{name} {unit}"] = (integer(name),)
    gl.glActiveTexture(active)


def _read_indexed(state: State, current: bool) -> None:
    for target, limit in {**INDEXED, **(INDEXED_43 if current else {})}.items():
        for index in range(integer(limit)):
            values = []
            for part in ("BINDING", "START", "SIZE"):
                value = ctypes.c_int64()
                gl.glGetInteger64i_v(enum(f"{target}_{part}"), index, byref(value))
                values.append(value.value)
            state[f"{target} {index}"] = tuple(values)
    # Transform feedback's own points; only their buffers can be read everywhere.
    for index in range(4):
        value = ctypes.c_int64()
        gl.glGetInteger64i_v(enum("TRANSFORM_FEEDBACK_BUFFER_BINDING"), index, byref(value))
        state[f"TRANSFORM_FEEDBACK_BUFFER {index}"] = (value.value,)


def _read_attributes(state: State) -> None:
    """What the bound vertex array holds: a guest must not have edited the host's."""
    if not integer("VERTEX_ARRAY_BINDING"):
        return
    for index in range(16):
        values = []
        for part in ("ENABLED", "SIZE", "STRIDE", "TYPE", "BUFFER_BINDING", "DIVISOR"):
            value = ctypes.c_int()
            gl.glGetVertexAttribiv(index, enum(f"VERTEX_ATTRIB_ARRAY_{part}"), byref(value))
            values.append(value.value)
        state[f"attribute {index}"] = tuple(values)


def differences(before: State, after: State) -> list[str]:
    """Lines that say what changed; empty when nothing did."""
    names = sorted(before.keys() | after.keys())
    return [
        f"{name}: {before.get(name)} -> {after.get(name)}"
        for name in names
        if before.get(name) != after.get(name)
    ]


def live_objects(highest: int = 4096) -> set[str]:
    """Names of every object the current context and those it shares with hold."""
    alive = set()
    for kind in KINDS:
        asks = getattr(gl, "glIs" + kind)
        alive |= {f"{kind} {name}" for name in range(1, highest) if asks(name)}
    return {name for name in alive if not _deleted(name)}


def _deleted(name: str) -> bool:
    """Whether it was given back: Mesa keeps the last programs a while after their deletion."""
    kind, number = name.split()
    status = ctypes.c_int()
    if kind == "Program":
        gl.glGetProgramiv(int(number), gl.GL_DELETE_STATUS, byref(status))
    elif kind == "Shader":
        gl.glGetShaderiv(int(number), gl.GL_DELETE_STATUS, byref(status))
    return bool(status.value)


def error() -> int:
    """glGetError, asked directly: pyglet's debug check would have eaten it."""
    return gl.glGetError()
