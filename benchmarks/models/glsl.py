"""The benchmarks' own shaders, read from files."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import moderngl

FOLDER = Path(__file__).resolve().parent.parent / "shaders"


def source(name: str, defines: Sequence[str] = ()) -> str:
    """Text of a shader file, with its version and `defines` in front."""
    lines = ["#version 330 core", *(f"#define {define}" for define in defines), "#line 1"]
    return "\n".join([*lines, (FOLDER / name).read_text(encoding="utf-8")])


def program(
    ctx: moderngl.Context,
    vertex: str,
    geometry: str | None = None,
    fragment: str | None = None,
    *,
    varyings: Sequence[str] = (),
    defines: Sequence[str] = (),
) -> moderngl.Program:
    """A program of shader files; with `varyings` and no fragment stage, for transform feedback."""
    return ctx.program(
        vertex_shader=source(vertex, defines),
        geometry_shader=source(geometry, defines) if geometry else None,
        fragment_shader=source(fragment, defines) if fragment else None,
        varyings=tuple(varyings),
    )


def put(owner: moderngl.Program, **values: object) -> None:
    """Set uniforms; one that the compiler has dropped is passed over."""
    for name, value in values.items():
        if name in owner:
            owner[name] = value
