"""Programs from the files in `weather_ecs/shaders`, one per key, with file and line in errors.

Shader files hold no `#version`: it is 330 core, 430 core for compute. They include others with
`#include "name.glsl"` and uniform blocks declared in Python with `#include <block:Name>`, nested
as deep as needed; each text counts once per stage.
"""

from __future__ import annotations

import ctypes
from dataclasses import dataclass
from importlib import resources
from importlib.resources.abc import Traversable
from typing import Any, cast

import moderngl

from weather_ecs.errors import ContextError, InvalidValueError, ShaderError
from weather_ecs.gpu.blocks import assign_bindings
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.shader_source import Define, Source, resolve


@dataclass(frozen=True, slots=True)
class ProgramKey:
    """What makes a program: files under `weather_ecs/shaders`, defines, captured varyings.

    defines: names or (name, value); their order does not matter.
    separate: each varying into a buffer of its own.
    """

    vertex: str = ""
    fragment: str = ""
    geometry: str = ""
    compute: str = ""
    defines: tuple[str | Define, ...] = ()
    varyings: tuple[str, ...] = ()
    separate: bool = False

    def __post_init__(self) -> None:
        if bool(self.compute) == bool(self.vertex):
            raise InvalidValueError("program key", self, "either a vertex or a compute shader")
        if self.compute and (self.fragment or self.geometry or self.varyings):
            raise InvalidValueError("program key", self, "a compute shader alone")
        pairs = [(d, 1) if isinstance(d, str) else d for d in self.defines]
        object.__setattr__(self, "defines", tuple(sorted(pairs, key=lambda pair: pair[0])))
        object.__setattr__(self, "varyings", tuple(self.varyings))

    @property
    def pairs(self) -> tuple[Define, ...]:
        """Defines as (name, value), sorted by name."""
        return cast("tuple[Define, ...]", self.defines)

    @property
    def stages(self) -> dict[str, str]:
        """File by stage, in the order of the pipeline."""
        names = ("vertex", "geometry", "fragment", "compute")
        return {name: getattr(self, name) for name in names if getattr(self, name)}

    def __str__(self) -> str:
        defines = "".join(f" {name}={value}" for name, value in self.pairs)
        return " + ".join(self.stages.values()) + defines


NAMES = 64  # that are looked through for what a failed program has left


class ShaderLoader:
    """Compiles and keeps the programs of one context."""

    def __init__(
        self, ctx: moderngl.Context, root: Traversable | None = None, gl: GL | None = None
    ) -> None:
        self._ctx = ctx
        self._gl = gl if gl is not None else GL()
        self._root = root or resources.files("weather_ecs").joinpath("shaders")
        self._programs: dict[ProgramKey, Any] = {}

    def program(self, key: ProgramKey) -> Any:
        """The program of `key` (a moderngl.ComputeShader for a compute key, else a Program).

        Its uniform blocks are at their bindings. Raises ShaderError with the driver's log in terms
        of our files and lines, and ContextError for a compute key before OpenGL 4.3.
        """
        known = self._programs.get(key)
        if known is None:
            known = self._programs[key] = self._build(key)
        return known

    def _build(self, key: ProgramKey) -> Any:
        if key.compute and self._ctx.version_code < 430:
            raise ContextError(f"{key}: compute shaders need OpenGL 4.3")
        version = "430 core" if key.compute else "330 core"
        sources = {
            stage: resolve(name, version, key.pairs, self._root)
            for stage, name in key.stages.items()
        }
        texts: dict[str, Any] = {f"{stage}_shader": s.text for stage, s in sources.items()}
        before = programs(self._gl, first := next_name(self._gl))
        try:
            if key.compute:
                built: Any = self._ctx.compute_shader(sources["compute"].text)
            else:
                mode = "separate" if key.separate else "interleaved"
                built = self._ctx.program(
                    **texts, varyings=key.varyings, varyings_capture_mode=mode
                )
        except moderngl.Error as error:
            # moderngl leaves a program that does not compile alive, without a way to release it.
            for left in programs(self._gl, first) - before:
                delete(self._gl, left)
            raise ShaderError(explain(key, sources, str(error))) from None
        assign_bindings(self._ctx, built)
        return built

    def release(self) -> None:
        """Give every program back; twice does no harm."""
        for program in reversed(self._programs.values()):
            program.release()
        self._programs.clear()


def next_name(gl: GL) -> int:
    """The name that a new program gets, or the one before it where drivers count on."""
    name = gl.glCreateProgram()
    gl.glDeleteProgram(name)
    return name


def programs(gl: GL, first: int) -> set[int]:
    """Names of the programs there are, of the few that may be handed out from `first` on."""
    return {name for name in range(first, first + NAMES) if gl.glIsProgram(name)}


def delete(gl: GL, program: int) -> None:
    """A program and the shaders attached to it."""
    shaders, count = (ctypes.c_uint * 8)(), ctypes.c_int()
    gl.glGetAttachedShaders(program, 8, ctypes.addressof(count), ctypes.addressof(shaders))
    gl.glDeleteProgram(program)
    for shader in shaders[: count.value]:
        gl.glDeleteShader(shader)


def explain(key: ProgramKey, sources: dict[str, Source], log: str) -> str:
    """The driver's log for a reader: which program, which of our files and lines."""
    for stage, source in sources.items():
        if f"{stage}_shader" in log:
            return f"{source.files[0]} ({key}): {source.located(log).strip()}"
    return f"{key}: {log.strip()}"
