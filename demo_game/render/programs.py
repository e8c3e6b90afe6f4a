"""Shaders of the game: read from the package, includes resolved, compiled."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterable
from functools import cache
from importlib import resources
from typing import Protocol

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs import glsl

_INCLUDE = re.compile(r'^#include "([\w.]+)"$')


@cache
def source(name: str) -> str:
    """Text of a shader file with its includes, the game's or the weather's; each once."""
    return "\n".join(_lines(name, set()))


def _lines(name: str, seen: set[str]) -> list[str]:
    if name in seen:
        return []
    seen.add(name)
    file = resources.files("demo_game").joinpath("shaders", name)
    text = file.read_text(encoding="utf-8") if file.is_file() else glsl(name)
    found: list[str] = []
    for line in text.splitlines():
        match = _INCLUDE.match(line)
        found += _lines(match.group(1), seen) if match else [line]
    return found


def compile_program(
    ctx: moderngl.Context, vertex: str, fragment: str, *defines: str
) -> moderngl.Program:
    """A program of two shader files under some defines."""
    head = "#version 330 core\n" + "".join(f"#define {name}\n" for name in defines)
    return ctx.program(vertex_shader=head + source(vertex), fragment_shader=head + source(fragment))


Look = tuple[moderngl.Program, list[moderngl.VertexArray]]


class Variants:
    """A program and what is drawn with it, made for each set of defines when first asked for.

    A condition in a shader costs its whole body on a driver that draws on the CPU, met or not.
    """

    def __init__(self, make: Callable[..., Look]) -> None:
        self._make = make
        self._made: dict[tuple[str, ...], Look] = {}
        self.program: moderngl.Program  # there from the first choice on
        self.arrays: list[moderngl.VertexArray]

    def choose(self, defines: tuple[str, ...]) -> None:
        """From here on these defines."""
        if defines not in self._made:
            self._made[defines] = self._make(*defines)
        self.program, self.arrays = self._made[defines]

    def release(self) -> None:
        """Give everything back."""
        for program, arrays in self._made.values():
            release_all((*arrays, program))


def set_uniforms(program: moderngl.Program, **values: object) -> None:
    """Set those uniforms that the compiler kept."""
    for name, value in values.items():
        uniform = program.get(name, None)  # `in` goes through all of them
        if uniform is not None:
            uniform.value = value  # type: ignore[union-attr]


def set_matrix(program: moderngl.Program, name: str, *matrices: NDArray) -> None:
    """Set a matrix uniform, or an array of them, from (4, 4) arrays that act on columns."""
    raw = np.array(matrices, "f4").swapaxes(1, 2).tobytes()
    program[name].write(raw)  # type: ignore[union-attr]


class Releasable(Protocol):
    """Anything of OpenGL's that is given back."""

    def release(self) -> None:
        """Give it back."""


def release_all(items: Iterable[Releasable]) -> None:
    """Give everything back, in this order."""
    for item in items:
        item.release()


def scissor(framebuffer: moderngl.Framebuffer, box: tuple[int, int, int, int] | None) -> None:
    """Restrict drawing to (x, y, width, height), or lift the restriction."""
    framebuffer.scissor = box  # type: ignore[assignment]  # moderngl takes None as well
