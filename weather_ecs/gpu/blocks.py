"""Uniform blocks, declared once in Python: std140 layout for numpy and the GLSL text from one list.

    RAIN_VIEW = UniformBlock("RainView", ("view_projection", "mat4"), ("areas", "vec4", 8))

Shaders take the text with `#include <block:RainView>`; members are global names there. Bindings go
from the top of GL_MAX_UNIFORM_BUFFER_BINDINGS downwards, because hosts count theirs from 0 up.
"""

from __future__ import annotations

import re
from dataclasses import dataclass
from struct import Struct
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.errors import ContextError, InvalidValueError

# GLSL type: numpy scalar, components, std140 alignment in bytes
TYPES: dict[str, tuple[str, int, int]] = {
    "float": ("<f4", 1, 4),
    "int": ("<i4", 1, 4),
    "uint": ("<u4", 1, 4),
    **{
        f"{p}vec{n}": (s, n, 8 if n == 2 else 16)
        for p, s in (("", "<f4"), ("i", "<i4"), ("u", "<u4"))
        for n in (2, 3, 4)
    },
    "mat4": ("<f4", 16, 16),
}
NAME = re.compile(r"[A-Za-z][A-Za-z0-9_]*\Z")
BLOCKS: dict[str, UniformBlock] = {}


@dataclass(frozen=True, slots=True)
class Field:
    """One member with its place in the block."""

    name: str
    type: str
    count: int  # 0: not an array
    offset: int  # bytes
    stride: int  # bytes between elements of an array

    @property
    def glsl(self) -> str:
        return f"{self.type} {self.name}" + (f"[{self.count}]" if self.count else "")


@dataclass(frozen=True, slots=True)
class Run:
    """Fields of a block that are written together, as one flat row of numbers."""

    layout: Struct
    offset: int  # bytes


class UniformBlock:
    """Layout of a uniform block.

    fields: (name, type) or (name, type, length of the array).
    dtype: numpy structure with std140 offsets. In it a mat4 is (4, 4), one row per GLSL column, and
    arrays of what is narrower than a vec4 are (count, 4); `BlockBuffer` gives plain views of both.
    """

    def __init__(self, name: str, *fields: tuple[Any, ...], register: bool = True) -> None:
        if not NAME.match(name):
            raise InvalidValueError("block name", name, "letters, digits, underscores")
        self.name = name
        self.fields, self.size = lay_out(name, fields)
        self.dtype = np.dtype(
            {
                "names": [field.name for field in self.fields],
                "formats": [numpy_format(field) for field in self.fields],
                "offsets": [field.offset for field in self.fields],
                "itemsize": self.size,
            }
        )
        self.slot = -1
        if register:
            known = BLOCKS.get(name)
            if known is not None and known.fields != self.fields:
                raise InvalidValueError("block name", name, "a name not yet declared otherwise")
            self.slot = known.slot if known is not None else len(BLOCKS)
            BLOCKS[name] = self

    @property
    def glsl(self) -> str:
        members = "".join(f"    {field.glsl};\n" for field in self.fields)
        return f"layout(std140) uniform {self.name}\n{{\n{members}}};\n"

    def run(self, *names: str) -> Run:
        """Some fields in their order, for `BlockBuffer.put`: a mat4 column by column.

        Raises InvalidValueError for a name out of order and for arrays of less than a vec4.
        """
        places = {field.name: k for k, field in enumerate(self.fields)}
        numbers = [places.get(name, -1) for name in names]
        if not names or min(numbers) < 0 or sorted(set(numbers)) != numbers:
            raise InvalidValueError(f"fields of block {self.name}", names, "names in their order")
        fields = [self.fields[number] for number in numbers]
        layout, end = "<", fields[0].offset
        for field in fields:
            scalar, components, _ = TYPES[field.type]
            if field.stride not in (0, 4 * components):
                raise InvalidValueError(f"field of {self.name}", field.name, "an array of vec4")
            count = components * max(field.count, 1)
            letter = {"<f4": "f", "<i4": "i", "<u4": "I"}[scalar]
            layout += f"{field.offset - end}x{count}{letter}"
            end = field.offset + 4 * count
        return Run(Struct(layout), fields[0].offset)

    def binding(self, ctx: moderngl.Context) -> int:
        """The block's uniform-buffer binding in `ctx`."""
        if self.slot < 0:
            raise InvalidValueError("block", self.name, "a registered block")
        index = top_binding(ctx) - self.slot
        if index < 0:
            raise ContextError(f"no uniform-buffer binding is left for block {self.name}")
        return index


def lay_out(block: str, fields: tuple[tuple[Any, ...], ...]) -> tuple[tuple[Field, ...], int]:
    """Fields with their std140 offsets, and the block's size in bytes (OpenGL 3.3, 2.11.4)."""
    if not fields:
        raise InvalidValueError(f"block {block}", fields, "at least one field")
    placed: list[Field] = []
    end = 0
    for name, kind, *length in fields:
        count = length[0] if length else 0
        if not NAME.match(name) or any(name == field.name for field in placed):
            raise InvalidValueError(f"field of block {block}", name, "a name used once")
        if kind not in TYPES:
            raise InvalidValueError(f"type of {block}.{name}", kind, ", ".join(TYPES))
        if length and count < 1:
            raise InvalidValueError(f"length of {block}.{name}", count, "1 or more")
        _, components, align = TYPES[kind]
        size = components * 4
        if count:
            align = 16
            stride = -(-size // 16) * 16
            size = stride * count
        else:
            stride = 0
        offset = -(-end // align) * align
        placed.append(Field(name, kind, count, offset, stride))
        end = offset + size
    return tuple(placed), -(-end // 16) * 16


def numpy_format(field: Field) -> Any:
    scalar, components, _ = TYPES[field.type]
    shape: tuple[int, ...] = (4, 4) if components == 16 else (components,)
    if field.count:
        shape = (field.count, 4, 4) if components == 16 else (field.count, 4)
    return scalar if shape == (1,) else (scalar, shape)


def top_binding(ctx: moderngl.Context) -> int:
    """The highest uniform-buffer binding of `ctx`."""
    return int(ctx.info["GL_MAX_UNIFORM_BUFFER_BINDINGS"]) - 1


def slot_count() -> int:
    """How many bindings from the top the declared blocks take."""
    return len(BLOCKS)


def assign_bindings(ctx: moderngl.Context, program: moderngl.Program) -> None:
    """Point the uniform blocks of `program` that are declared here at their bindings."""
    for name in program:
        member = program[name]
        if isinstance(member, moderngl.UniformBlock) and name in BLOCKS:
            member.binding = BLOCKS[name].binding(ctx)


class BlockBuffer:
    """A uniform buffer and the record it is filled from.

    `data`: the whole record (a 0-d structured array), to assign to by field name.
    `buffer["name"] = value`: the same through plain views: arrays in their own shape, a mat4 as the
    matrix M that is used as M @ column vector.
    `buffer.put(run, *numbers)`: several fields at once, at a fifth of what they cost one by one.
    Nothing reaches the GPU before `upload`.
    """

    def __init__(
        self, ctx: moderngl.Context, block: UniformBlock, binding: int | None = None
    ) -> None:
        self.ctx = ctx
        self.block = block
        self.binding = block.binding(ctx) if binding is None else binding
        self._bytes = bytearray(block.size)
        self._there = b""  # what the GPU has
        self.data: NDArray[Any] = np.frombuffer(self._bytes, block.dtype).reshape(())
        self.views = {field.name: self._view(field) for field in block.fields}
        self._buffer: moderngl.Buffer | None = ctx.buffer(reserve=block.size, dynamic=True)
        self.holds: object = None  # what it was filled from, for whoever fills it to compare with

    def _view(self, field: Field) -> NDArray[Any]:
        _, components, _ = TYPES[field.type]
        view: NDArray[Any] = self.data[field.name]
        if components == 16:
            return view.swapaxes(-1, -2)
        if field.count:
            view = view[:, :components]
            return view[:, 0] if components == 1 else view
        return view

    def __setitem__(self, name: str, value: Any) -> None:
        self.views[name][...] = value

    def __getitem__(self, name: str) -> NDArray[Any]:
        return self.views[name]

    def put(self, run: Run, *numbers: float) -> None:
        """Write the numbers of a run of the block's fields."""
        run.layout.pack_into(self._bytes, run.offset, *numbers)

    def upload(self) -> None:
        """Replace the buffer's contents; what is still being drawn keeps the old ones.

        Does nothing where they are the same: much of the weather stays for many frames.
        """
        if self._buffer is not None and self._there != self._bytes:
            self._there = bytes(self._bytes)
            self._buffer.orphan()
            self._buffer.write(self._there)

    def bind(self) -> None:
        if self._buffer is not None:
            self._buffer.bind_to_uniform_block(self.binding)

    def release(self) -> None:
        """Give the buffer back; twice does no harm."""
        if self._buffer is not None:
            self._buffer.release()
            self._buffer = None
