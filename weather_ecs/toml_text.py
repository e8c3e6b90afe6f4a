"""TOML text: a writer for plain values. Python reads TOML (`tomllib`) but does not write it."""

from __future__ import annotations

import json
import re
from collections.abc import Iterable, Mapping, Sequence
from datetime import date, datetime, time
from typing import Any

WIDTH = 100  # characters; a list that is longer has a line for each item

_BARE = re.compile(r"[A-Za-z0-9_-]+")


def dumps(document: Mapping[str, Any], comment: str = "") -> str:
    """Text that `tomllib` reads back as the document, floats to the bit.

    Values are numbers, bools, strings, dates and times, lists of them, mappings (tables) and lists
    of mappings (arrays of tables). Raises TypeError for others.
    """
    lines = [f"# {line}" for line in comment.splitlines()]
    lines += table_lines(document, ())
    return "\n".join(lines).strip("\n") + "\n"


def table_lines(table: Mapping[str, Any], path: tuple[str, ...]) -> Iterable[str]:
    """Lines of a table's entries and of the tables in it; `path` are the names of its own."""
    inner = {key: value for key, value in table.items() if is_table(value)}
    for key, value in table.items():
        if key not in inner:
            yield entry(key, value)
    for key, value in inner.items():
        below = (*path, key)
        if isinstance(value, Mapping):
            yield from ("", header(below), *table_lines(value, below))
        else:
            for item in value:
                yield from ("", header(below, repeated=True), *table_lines(item, below))


def header(path: Sequence[str], *, repeated: bool = False) -> str:
    """The line above a table, or above one of an array of tables."""
    name = ".".join(map(key_text, path))
    return f"[[{name}]]" if repeated else f"[{name}]"


def entry(key: str, value: Any) -> str:
    """A key and its value; a long list takes several lines."""
    return f"{key_text(key)} = {value_text(value, len(key) + 3)}"


def is_table(value: Any) -> bool:
    """Whether a value is written under a header of its own."""
    if isinstance(value, (list, tuple)):
        return bool(value) and all(isinstance(item, Mapping) for item in value)
    return isinstance(value, Mapping)


def key_text(key: str) -> str:
    """A key, in quotes where it needs them."""
    return key if _BARE.fullmatch(key) else _string(key)


def value_text(value: Any, column: int = 0) -> str:
    """A value that begins at a column. Raises TypeError for what TOML cannot hold."""
    if isinstance(value, bool):
        return "true" if value else "false"
    if isinstance(value, int):
        return repr(int(value))
    if isinstance(value, float):
        return repr(float(value))  # the shortest digits that give it back; also inf
    if isinstance(value, str):
        return _string(value)
    if isinstance(value, (datetime, date, time)):
        return value.isoformat()
    if isinstance(value, Mapping):
        inside = ", ".join(f"{key_text(key)} = {value_text(item)}" for key, item in value.items())
        return f"{{ {inside} }}" if inside else "{}"
    if isinstance(value, Sequence) and not isinstance(value, (bytes, bytearray)):
        items = [value_text(item, 4) for item in value]
        text = f"[{', '.join(items)}]"
        if column + len(text) <= WIDTH:
            return text
        return "\n".join(["[", *[f"    {item}," for item in items], "]"])
    raise TypeError(f"a TOML file cannot hold {type(value).__name__}")


def _string(text: str) -> str:
    return json.dumps(text, ensure_ascii=False).replace("\x7f", "\\u007f")
