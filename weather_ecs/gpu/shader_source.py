"""GLSL text of one shader stage: strict includes, uniform blocks, and lines that stay findable."""

from __future__ import annotations

import re
from dataclasses import dataclass, field
from importlib.resources.abc import Traversable
from typing import TypeAlias

from weather_ecs.errors import ShaderError
from weather_ecs.gpu.blocks import BLOCKS

Define: TypeAlias = tuple[str, str | int | float]

INCLUDE = re.compile(r"\s*#\s*include\b\s*(.*?)\s*(?://.*)?$")
TARGET = re.compile(r'"([A-Za-z0-9_.]+)"$|<block:([A-Za-z0-9_]+)>$')
VERSION = re.compile(r"\s*#\s*version\b")
# Mesa "0:12(3): error", NVIDIA "0(12) : error", AMD, Intel and Apple "ERROR: 0:12: ..."
LOCATION = re.compile(r"\b(\d+):(\d+)(?:\(\d+\))?(?=\s*:)|^(\d+)\((\d+)\)(?=\s*:)", re.MULTILINE)


@dataclass(slots=True)
class Source:
    """GLSL of one stage, and the file each `#line` number stands for."""

    text: str
    files: list[str] = field(default_factory=list)

    def located(self, log: str) -> str:
        """The driver's log with its numbers put back into our files and lines."""

        def place(match: re.Match[str]) -> str:
            number, line = match.group(1) or match.group(3), match.group(2) or match.group(4)
            known = int(number) < len(self.files)
            return f"{self.files[int(number)]}:{line}" if known else match.group(0)

        return LOCATION.sub(place, log)


def resolve(name: str, version: str, defines: tuple[Define, ...], root: Traversable) -> Source:
    """The whole text of the stage in file `name`.

    Raises ShaderError, with file and line, for an unknown name, a cycle, or a `#version`.
    """
    source = Source("")
    lines = [f"#version {version}"]
    for macro, value in defines:
        lines.append(f"#define {macro} {int(value) if isinstance(value, bool) else value}")
    _append(lines, source, name, root, (), "the program")
    source.text = "\n".join(lines) + "\n"
    return source


def _read(root: Traversable, name: str, place: str) -> str:
    try:
        return root.joinpath(name).read_text(encoding="utf-8-sig")
    except (OSError, UnicodeDecodeError) as error:
        raise ShaderError(f"{place}: cannot read shader {name!r}: {error}") from None


def _append(
    lines: list[str],
    source: Source,
    name: str,
    root: Traversable,
    parents: tuple[str, ...],
    place: str,
) -> None:
    """Append file `name`, included at `place`, and all that it includes."""
    if name in parents:
        raise ShaderError(f"{place}: include cycle: {' -> '.join((*parents, name))}")
    text = _read(root, name, place)
    if name not in source.files:
        source.files.append(name)
    number = source.files.index(name)
    lines.append(f"#line 1 {number}")
    for at, line in enumerate(text.splitlines(), 1):
        here = f"{name}:{at}"
        if VERSION.match(line):
            raise ShaderError(f"{here}: #version is the loader's to choose")
        match = INCLUDE.match(line)
        if match is None:
            lines.append(line)
            continue
        target = TARGET.match(match.group(1))
        if target is None:
            raise ShaderError(f'{here}: expected #include "name.glsl" or <block:Name>: {line!r}')
        # A guard of the preprocessor's own, not a Python one: an include may stand in an #ifdef.
        file, block = target.groups()
        guard = "INCLUDED_" + re.sub(r"[^A-Za-z0-9]+", "_", file or f"block_{block}")
        lines += [f"#ifndef {guard}", f"#define {guard}"]
        if file:
            _append(lines, source, file, root, (*parents, name), here)
        else:
            _append_block(lines, source, block, here)
        lines += ["#endif", f"#line {at + 1} {number}"]


def _append_block(lines: list[str], source: Source, block: str, place: str) -> None:
    if block not in BLOCKS:
        known = ", ".join(sorted(BLOCKS)) or "none"
        raise ShaderError(f"{place}: unknown uniform block {block!r} (declared: {known})")
    title = f"<block:{block}>"
    if title not in source.files:
        source.files.append(title)
    lines.append(f"#line 1 {source.files.index(title)}")
    lines += BLOCKS[block].glsl.splitlines()
