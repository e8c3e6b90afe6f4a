"""Uniform blocks: offsets against the driver's, values against what a shader reads."""

from __future__ import annotations

import ctypes
import struct
from collections.abc import Callable
from typing import Any

import moderngl
import numpy as np
import pytest
from hypothesis import HealthCheck, given, settings
from hypothesis import strategies as st

from weather_ecs.errors import InvalidValueError
from weather_ecs.gpu import blocks
from weather_ecs.gpu.blocks import BLOCKS, TYPES, BlockBuffer, UniformBlock, assign_bindings
from weather_ecs.gpu.gl import GL

UNIFORM_OFFSET = 0x8A3B
UNIFORM_ARRAY_STRIDE = 0x8A3C
UNIFORM_MATRIX_STRIDE = 0x8A3D
UNIFORM_BLOCK_DATA_SIZE = 0x8A40

EVERY_TYPE = [(f"single_{kind}", kind) for kind in TYPES]
EVERY_ARRAY = [(f"array_{kind}", kind, 3) for kind in TYPES]


def driver_layout(ctx: moderngl.Context, gl: GL, block: UniformBlock) -> dict[str, tuple[int, int]]:
    """Offset and array stride by field, and the size as field "", as the driver has them."""
    source = f"#version 330 core\n{block.glsl}void main() {{ gl_Position = vec4(0.0); }}\n"
    program = ctx.program(vertex_shader=source)
    try:
        size = ctypes.c_int()
        index = gl.glGetUniformBlockIndex(program.glo, block.name.encode())
        gl.glGetActiveUniformBlockiv(
            program.glo, index, UNIFORM_BLOCK_DATA_SIZE, ctypes.addressof(size)
        )
        layout = {"": (size.value, 0)}
        for field in block.fields:
            name = (ctypes.c_char_p * 1)(field.name.encode() + (b"[0]" if field.count else b""))
            at = ctypes.c_uint()
            gl.glGetUniformIndices(program.glo, 1, ctypes.addressof(name), ctypes.addressof(at))
            values = []
            for what in (UNIFORM_OFFSET, UNIFORM_ARRAY_STRIDE):
                value = ctypes.c_int()
                gl.glGetActiveUniformsiv(
                    program.glo, 1, ctypes.addressof(at), what, ctypes.addressof(value)
                )
                values.append(value.value)
            layout[field.name] = (values[0], values[1])
        return layout
    finally:
        program.release()


def our_layout(block: UniformBlock) -> dict[str, tuple[int, int]]:
    fields = {field.name: (field.offset, field.stride) for field in block.fields}
    return {"": (block.size, 0), **fields}


@pytest.mark.parametrize("fields", [EVERY_TYPE, EVERY_ARRAY, EVERY_TYPE[::-1] + EVERY_ARRAY[::-1]])
def test_offsets_are_the_drivers(
    ctx: moderngl.Context, gl: GL, fields: list[tuple[Any, ...]]
) -> None:
    block = UniformBlock("Layout", *fields, register=False)
    assert driver_layout(ctx, gl, block) == our_layout(block)
    for name in block.dtype.names or ():
        assert block.dtype.fields is not None
        assert block.dtype.fields[name][1] == our_layout(block)[name][0]


@settings(
    max_examples=40,
    deadline=None,
    suppress_health_check=[HealthCheck.function_scoped_fixture],
)
@given(st.lists(st.tuples(st.sampled_from(sorted(TYPES)), st.integers(0, 3)), min_size=1))
def test_any_block_is_laid_out_as_the_driver_does(
    ctx: moderngl.Context, gl: GL, kinds: list[tuple[str, int]]
) -> None:
    fields = [
        (f"field_{i}", kind, count) if count else (f"field_{i}", kind)
        for i, (kind, count) in enumerate(kinds)
    ]
    block = UniformBlock("Layout", *fields, register=False)
    assert driver_layout(ctx, gl, block) == our_layout(block)


FIELDS = (
    ("b_float", "float"),
    ("b_pair", "vec2"),
    ("b_three", "vec3"),
    ("b_int", "int"),
    ("b_matrix", "mat4"),
    ("b_scalars", "float", 3),
    ("b_threes", "vec3", 2),
    ("b_matrices", "mat4", 2),
    ("b_word", "uint"),
)
# What the shader below reads, one number each.
PROBES = (
    "b_float, b_pair.x, b_pair.y, b_three.z, float(b_int), "
    "(b_matrix * vec4(1.0, 2.0, 3.0, 4.0)).x, (b_matrix * vec4(1.0, 2.0, 3.0, 4.0)).w, "
    "b_scalars[0], b_scalars[1], b_scalars[2], b_threes[1].x, b_threes[1].y, b_threes[1].z, "
    "(b_matrices[1] * vec4(1.0, 0.0, 0.0, 0.0)).y, float(b_word), 0.0"
)


def test_a_shader_reads_what_was_written(ctx: moderngl.Context, keep: Callable[[Any], Any]) -> None:
    block = UniformBlock("Probed", *FIELDS, register=False)
    program = keep(
        ctx.program(
            vertex_shader=f"#version 330 core\n{block.glsl}out float value;\nvoid main() {{ "
            f"float values[16] = float[16]({PROBES}); value = values[gl_VertexID]; }}",
            varyings=("value",),
        )
    )
    program["Probed"].binding = 7
    buffer = keep(BlockBuffer(ctx, block, 7))
    target = keep(ctx.simple_framebuffer((4, 4)))
    keep(target.color_attachments[0])
    keep(target.depth_attachment)
    target.use()
    matrix = np.arange(16.0).reshape(4, 4) + 1.0
    matrices = np.stack([np.zeros((4, 4)), matrix])
    buffer.data["b_float"] = 1.5
    buffer.data["b_pair"] = (2.0, 3.0)
    buffer["b_three"] = (4.0, 5.0, 6.0)
    buffer["b_int"] = -7
    buffer["b_matrix"] = matrix
    buffer["b_scalars"] = (8.0, 9.0, 10.0)
    buffer["b_threes"] = [(0.0, 0.0, 0.0), (11.0, 12.0, 13.0)]
    buffer["b_matrices"] = matrices
    buffer["b_word"] = 14
    buffer.upload()
    buffer.bind()
    output = keep(ctx.buffer(reserve=64))
    keep(ctx.vertex_array(program, [])).transform(output, moderngl.POINTS, vertices=16)
    product = matrix @ (1.0, 2.0, 3.0, 4.0)
    expected = [1.5, 2, 3, 6, -7, product[0], product[3], 8, 9, 10, 11, 12, 13, matrix[1, 0], 14, 0]
    assert np.frombuffer(output.read(), np.float32).tolist() == pytest.approx(expected)


def test_nothing_reaches_the_gpu_before_upload(
    ctx: moderngl.Context, keep: Callable[[Any], Any], gl: GL
) -> None:
    block = UniformBlock("Probed", ("b_float", "float"), register=False)
    buffer = keep(BlockBuffer(ctx, block, 3))
    buffer["b_float"] = 1.0
    buffer.upload()
    buffer["b_float"] = 2.0
    assert buffer["b_float"] == 2.0
    buffer.bind()
    name = (ctypes.c_int * 1)()
    gl.glGetIntegeri_v(0x8A28, 3, ctypes.addressof(name))
    gl.glBindBuffer(0x8A11, name[0])
    read = (ctypes.c_float * 1)()
    gl.glGetBufferSubData(0x8A11, 0, 4, ctypes.addressof(read))
    assert read[0] == 1.0


def test_a_run_writes_what_single_fields_do(
    ctx: moderngl.Context, keep: Callable[[Any], Any]
) -> None:
    fields = (*FIELDS[:5], ("b_fours", "vec4", 2), ("b_more", "mat4", 2), ("b_word", "uint"))
    block = UniformBlock("Probed", *fields, register=False)
    one, other = (keep(BlockBuffer(ctx, block, 3)) for _ in range(2))
    matrix = np.arange(16.0).reshape(4, 4)
    numbers = (2.0, 3.0, 4.0, 5.0, 6.0, -7)
    one.put(block.run("b_float"), 1.5)
    one.put(block.run("b_pair", "b_three", "b_int"), *numbers)
    tail = block.run("b_matrix", "b_fours", "b_word")
    with pytest.raises(struct.error):
        one.put(tail, 1.0)
    skipped = block.run("b_matrix", "b_fours")
    one.put(skipped, *matrix.T.ravel(), *range(8))
    one.put(block.run("b_more", "b_word"), *([0.0] * 16), *matrix.T.ravel(), 9)
    other["b_float"], other["b_pair"], other["b_three"] = 1.5, numbers[:2], numbers[2:5]
    other["b_int"], other["b_matrix"], other["b_word"] = -7, matrix, 9
    other["b_fours"] = np.arange(8).reshape(2, 4)
    other["b_more"] = np.stack([np.zeros((4, 4)), matrix])
    assert one.data.tobytes() == other.data.tobytes()


def test_a_run_leaves_out_fields_in_between(
    ctx: moderngl.Context, keep: Callable[[Any], Any]
) -> None:
    fields = ("a", "vec4"), ("b", "vec2"), ("c", "float")
    buffer = keep(BlockBuffer(ctx, UniformBlock("Probed", *fields, register=False), 3))
    buffer["b"] = 7.0, 7.0
    # What lies between is overwritten with nothing.
    buffer.put(buffer.block.run("a", "c"), 1.0, 2.0, 3.0, 4.0, 5.0)
    assert buffer["a"].tolist() == [1.0, 2.0, 3.0, 4.0]
    assert buffer["c"] == 5.0


@pytest.mark.parametrize("names", [(), ("b_nothing",), ("b_pair", "b_float"), ("b_scalars",)])
def test_bad_runs_are_refused(names: tuple[str, ...]) -> None:
    block = UniformBlock("Probed", *FIELDS, register=False)
    with pytest.raises(InvalidValueError):
        block.run(*names)


def test_what_is_there_is_not_uploaded_again(
    ctx: moderngl.Context, keep: Callable[[Any], Any]
) -> None:
    block = UniformBlock("Probed", ("b_four", "vec4"), register=False)
    buffer = keep(BlockBuffer(ctx, block, 3))
    held = buffer._buffer
    buffer.upload()
    assert held.read() == bytes(16)
    held.write(b"\xff" * 16)
    buffer.upload()
    assert held.read() == b"\xff" * 16
    buffer["b_four"] = 1.0
    buffer.upload()
    assert np.frombuffer(held.read(), np.float32).tolist() == [1.0] * 4


@pytest.fixture
def registry(monkeypatch: pytest.MonkeyPatch) -> dict[str, UniformBlock]:
    fresh: dict[str, UniformBlock] = {}
    monkeypatch.setattr(blocks, "BLOCKS", fresh)
    return fresh


def test_bindings_come_from_the_top(
    ctx: moderngl.Context, registry: dict[str, UniformBlock], keep: Callable[[Any], Any]
) -> None:
    first = UniformBlock("First", ("f_value", "float"))
    second = UniformBlock("Second", ("s_value", "float"))
    top = ctx.info["GL_MAX_UNIFORM_BUFFER_BINDINGS"] - 1
    assert (first.binding(ctx), second.binding(ctx)) == (top, top - 1)
    text = f"#version 330 core\n{first.glsl}{second.glsl}"
    program = keep(
        ctx.program(
            vertex_shader=text + "void main() { gl_Position = vec4(f_value, s_value, 0, 1); }"
        )
    )
    assign_bindings(ctx, program)
    assert program["First"].binding == top
    assert program["Second"].binding == top - 1


def test_a_block_declared_again_keeps_its_place(registry: dict[str, UniformBlock]) -> None:
    first = UniformBlock("First", ("f_value", "float"))
    UniformBlock("Second", ("s_value", "float"))
    assert UniformBlock("First", ("f_value", "float")).slot == first.slot
    with pytest.raises(InvalidValueError, match="First"):
        UniformBlock("First", ("f_value", "vec4"))


@pytest.mark.parametrize(
    "fields",
    [
        (),
        (("a", "float"), ("a", "float")),
        (("a", "dvec3"),),
        (("a b", "float"),),
        (("a", "float", 0),),
        (("a", "float", -1),),
    ],
)
def test_bad_fields_are_refused(fields: tuple[tuple[Any, ...], ...]) -> None:
    before = dict(BLOCKS)
    with pytest.raises(InvalidValueError):
        UniformBlock("Refused", *fields)
    assert before == BLOCKS


def test_release_twice(ctx: moderngl.Context) -> None:
    buffer = BlockBuffer(ctx, UniformBlock("Gone", ("g", "float"), register=False), 1)
    buffer.release()
    buffer.release()
    buffer.upload()
    buffer.bind()
