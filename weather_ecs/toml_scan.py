"""Where in a TOML text its statements are: headers, keys and their values, comments.

For texts that `tomllib` reads, the statements are exact; of others they are a guess that costs no
more time than the text is long.
"""

from __future__ import annotations

import re
from collections.abc import Iterator
from dataclasses import dataclass
from typing import NamedTuple

Path = tuple[str | int, ...]  # ("models", 0, "seeds", 2, "width")

# Groups repeat without "*+": Python 3.11 before .5 loses its place in them. Their alternatives
# exclude each other, so that nothing matches in two ways and no time is lost either.
_KEY = r"[A-Za-z0-9_-]+|\"(?:[^\"\\\n]|\\[^\n])*\"|'[^'\n]*+'"
_KEYS = re.compile(rf"[ \t]*(?:{_KEY})(?:[ \t]*\.[ \t]*(?:{_KEY}))*[ \t]*")
_ONE_KEY = re.compile(_KEY)
_TOKEN = re.compile(
    r'"""(?:[^"\\]|\\.|"{1,2}(?!"))*"{3,5}'
    r"|'''(?:[^']|'{1,2}(?!'))*'{3,5}"
    r'|"(?:[^"\\\n]|\\[^\n])*"'
    r"|'[^'\n]*+'"
    r"|\#[^\n]*|[\[\]{}\n]|[^\[\]{}\n\#\"' \t\r]+|[\"']",
    re.DOTALL,
)


class TooDeepError(Exception):
    """Values or names are nested deeper than allowed; carries the line."""

    def __init__(self, line: int) -> None:
        super().__init__(line)
        self.line = line


@dataclass(slots=True)
class Statement:
    """A piece of the text, its end of line included; what has no key is blank or a comment."""

    start: int
    end: int
    keys: tuple[str, ...] = ()  # of a header, or of a value relative to its table
    header: str = ""  # "[", "[[" or nothing
    value_start: int = 0  # of a value; its comment comes after it
    value_end: int = 0


class Placed(NamedTuple):
    """A statement with the table that it is in, or that it opens."""

    statement: Statement
    table: Path  # with the indices of the arrays of tables


def statements(text: str, deepest: int = 0) -> Iterator[Statement]:
    """The statements one after the other, all of the text together.

    Raises TooDeepError for more names in a key, or brackets in a value, than `deepest`; 0 is no
    limit.
    """
    position, size = 0, len(text)
    while position < size:
        start = position
        while position < size and text[position] in " \t\r":
            position += 1
        first = text[position] if position < size else "\n"
        if first in "\n#":
            position = _line_end(text, position)
            yield Statement(start, position)
        elif first == "[":
            mark = "[[" if text.startswith("[[", position) else "["
            found = _KEYS.match(text, position + len(mark))
            keys = _names(found[0]) if found else ()
            position = _line_end(text, found.end() if found else position)
            if deepest and len(keys) > deepest:
                raise TooDeepError(_line(text, start))
            yield Statement(start, position, keys, mark if keys else "")
        else:
            found = _KEYS.match(text, position)
            if not found or not text.startswith("=", found.end()):
                position = _line_end(text, position)
                yield Statement(start, position)
                continue
            keys = _names(found[0])
            if deepest and len(keys) > deepest:
                raise TooDeepError(_line(text, start))
            made = Statement(start, 0, keys)
            position = made.end = _value(text, found.end() + 1, made, deepest)
            yield made


def placed(text: str) -> Iterator[Placed]:
    """The statements with the tables that they are in."""
    here = Path()
    counts: dict[Path, int] = {}
    for statement in statements(text):
        if statement.header:
            here = _opened(statement, counts)
        yield Placed(statement, here)


def line_of(text: str, path: Path) -> int | None:
    """Line (from 1) of a value, or of the nearest table round it; None where it cannot be told."""
    best, depth = None, 0
    for statement, table in placed(text):
        if not statement.keys:
            continue
        at = table if statement.header else (*table, *statement.keys)
        if statement.header == "[[" and path[: len(at)] == at[:-1]:
            at = at[:-1]  # what is to be one table is written as one of many
        if len(at) > depth and path[: len(at)] == at:
            best, depth = statement.start, len(at)
    return None if best is None else _line(text, best)


def _value(text: str, position: int, made: Statement, deepest: int) -> int:
    """Find a value's beginning and end; returns the end of its last line."""
    depth = 0
    made.value_start = made.value_end = -1
    for token in _TOKEN.finditer(text, position):
        first = text[token.start()]
        if first == "\n":
            if not depth:
                position = token.end()
                break
            continue
        if first == "#":
            continue
        if first in "[{":
            depth += 1
            if deepest and depth > deepest:
                raise TooDeepError(_line(text, token.start()))
        elif first in "]}":
            depth = max(depth - 1, 0)
        if made.value_start < 0:
            made.value_start = token.start()
        made.value_end = token.end()
    else:
        position = len(text)
    if made.value_start < 0:
        made.value_start = made.value_end = position
    return position


def _opened(statement: Statement, counts: dict[Path, int]) -> Path:
    """The place of a table whose header was read, with the indices of the arrays it stands in."""
    here = Path()
    last = len(statement.keys) - 1
    for index, part in enumerate(statement.keys):
        here = (*here, part)
        if statement.header == "[[" and index == last:
            counts[here] = counts.get(here, -1) + 1
        if here in counts:
            here = (*here, counts[here])
    return here


def _names(text: str) -> tuple[str, ...]:
    return tuple([_plain(key) for key in _ONE_KEY.findall(text)])


def _plain(key: str) -> str:
    if key[0] == "'":
        return key[1:-1]
    if key[0] != '"':
        return key
    if "\\" not in key:
        return key[1:-1]
    import tomllib

    try:
        return str(tomllib.loads(f"k = {key}")["k"])
    except ValueError:
        return key[1:-1]


def _line_end(text: str, position: int) -> int:
    end = text.find("\n", position)
    return len(text) if end < 0 else end + 1


def _line(text: str, position: int) -> int:
    return text.count("\n", 0, position) + 1
