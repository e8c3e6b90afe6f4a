"""TOML text: a writer for plain values, and the lines on which keys stand.

Python reads TOML (`tomllib`) but neither writes it nor says where in the text a value was.
"""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

Path = tuple[str | int, ...]  # ("models", 0, "seeds", 2, "width")

_HEADER = re.compile(r"\s*(\[\[?)\s*([\w-]+(?:\s*\.\s*[\w-]+)*)\s*\]")
_KEY = re.compile(r"\s*([\w-]+)\s*=")


def dumps(document: Mapping[str, Any], comment: str = "") -> str:
    """Text that `tomllib` reads back as the document, floats to the bit.

    Values are numbers, bools, strings and lists of them, mappings (tables) and lists of mappings
    (arrays of tables).
    """
    lines = [f"# {line}" for line in comment.splitlines()]
    lines += _table(document, ())
    return "\n".join(lines).strip("\n") + "\n"


def _table(table: Mapping[str, Any], path: tuple[str, ...]) -> Iterable[str]:
    inner = {key: value for key, value in table.items() if _is_table(value)}
    for key, value in table.items():
        if key not in inner:
            yield f"{key} = {_value(value)}"
    for key, value in inner.items():
        name = ".".join((*path, key))
        if isinstance(value, Mapping):
            yield from ("", f"[{name}]", *_table(value, (*path, key)))
        else:
            for item in value:
                yield from ("", f"[[{name}]]", *_table(item, (*path, key)))


def _is_table(value: Any) -> bool:
    if isinstance(value, (list, tuple)):
        return bool(value) and isinstance(value[0], Mapping)
    return isinstance(value, Mapping)


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, (int, float)):
        return repr(value)  # the shortest digits that give the float back; also inf
    if isinstance(value, str):
        return json.dumps(value, ensure_ascii=False).replace("\x7f", "\\u007f")
    if isinstance(value, Sequence):
        return f"[{', '.join(_value(item) for item in value)}]"
    raise TypeError(f"a TOML file cannot hold {type(value).__name__}")


def line_of(text: str, path: Path) -> int | None:
    """Line (from 1) of a value, or of the nearest table round it; None where it cannot be told."""
    best: int | None = None
    depth, here = 0, Path()
    counts: dict[Path, int] = {}
    quoted = ""
    for number, line in enumerate(text.split("\n"), 1):
        if quoted:
            quoted = "" if line.count(quoted) % 2 else quoted
            continue
        found = _HEADER.match(line)
        if found:
            here = _opened(found[2], found[1] == "[[", counts)
            at = here
        else:
            key = _KEY.match(line)
            at = (*here, key[1]) if key else Path()
        if len(at) > depth and path[: len(at)] == at:
            best, depth = number, len(at)
        quoted = next((mark for mark in ('"""', "'''") if line.count(mark) % 2), "")
    return best


def _opened(name: str, repeated: bool, counts: dict[Path, int]) -> Path:
    """The place of a table whose header was read, with the indices of the arrays it stands in."""
    parts = [part.strip() for part in name.split(".")]
    here = Path()
    for index, part in enumerate(parts):
        here = (*here, part)
        if repeated and index == len(parts) - 1:
            counts[here] = counts.get(here, -1) + 1
        if here in counts:
            here = (*here, counts[here])
    return here
