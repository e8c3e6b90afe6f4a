"""What a game's own program reads of the weather: maps on texture units, and blocks.

The program is moderngl's, or any other by the name that OpenGL has for it.
"""

from __future__ import annotations

from typing import Any
from weakref import WeakKeyDictionary

import moderngl

from weather_ecs.errors import InvalidValueError
from weather_ecs.gpu import gl_enums as e
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.gl import GL

ALLOWED = "a moderngl.Program, a pyglet ShaderProgram, or the OpenGL name of a linked program"
Four = tuple[float, float, float, float]

# Entry points for the programs that moderngl did not make.
_entry_points: WeakKeyDictionary[moderngl.Context, GL] = WeakKeyDictionary()


def use_maps(program: Any, unit: int, **maps: moderngl.Texture) -> None:
    """Bind textures to units from `unit` on, and point the program's samplers at them by name.

    Names that the shader does not use are left out. InvalidValueError for what is no program.
    """
    for number, (name, texture) in enumerate(maps.items(), unit):
        set_uniform(program, texture.ctx, name, number)
        texture.use(number)


def set_uniform(program: Any, ctx: moderngl.Context, name: str, value: int | Four) -> None:
    """Set a sampler or a vec4 of the program, if it has one of that name."""
    if isinstance(program, moderngl.Program):
        uniform: Any = program.get(name, None)  # `in` goes through all of them
        if uniform is not None:
            uniform.value = value
        return
    gl = _loaded(ctx)
    number = _name(program, gl)
    before = gl.get_int(e.CURRENT_PROGRAM)
    if before != number:
        gl.glUseProgram(number)
    place = gl.glGetUniformLocation(number, name.encode())  # -1 sets nothing
    if isinstance(value, int):
        gl.glUniform1i(place, value)
    else:
        gl.glUniform4f(place, *value)
    if before != number:
        gl.glUseProgram(before)


def use_block(program: Any, buffer: BlockBuffer) -> None:
    """Bind a block to the binding it has, and point the program's at it, if it has one.

    Raises InvalidValueError for what is no program.
    """
    if isinstance(program, moderngl.Program):
        block: Any = program.get(buffer.block.name, None)
        if block is None:
            return
        block.binding = buffer.binding
    else:
        gl = _loaded(buffer.ctx)
        number = _name(program, gl)
        index = gl.glGetUniformBlockIndex(number, buffer.block.name.encode())
        if index == e.INVALID_INDEX:
            return
        gl.glUniformBlockBinding(number, index, buffer.binding)
    buffer.bind()


def _loaded(ctx: moderngl.Context) -> GL:
    found = _entry_points.get(ctx)
    if found is None:
        found = _entry_points[ctx] = GL()
    return found


def _name(program: Any, gl: GL) -> int:
    """OpenGL's name of a program: the number itself, pyglet's `id`, or arcade's `glo`."""
    number = program
    for attribute in ("glo", "id"):
        number = getattr(program, attribute, number)
    known = isinstance(number, int) and not isinstance(number, bool) and 0 < number < 1 << 32
    if not (known and gl.glIsProgram(number)):
        raise InvalidValueError("program", program, ALLOWED)
    return int(number)
