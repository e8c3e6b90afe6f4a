"""A TOML text as a tree of tables that writes itself back, comments and all."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import dataclass, field
from typing import Any

from weather_ecs import toml_text
from weather_ecs.toml_scan import Path, Statement, placed


@dataclass(slots=True)
class Entry:
    """A key with its value, and the comments and empty lines above it."""

    keys: tuple[str, ...]
    lead: str
    before: str  # up to the value
    value: str
    after: str  # a comment, the end of the line

    def text(self) -> str:
        """As it stands in the file."""
        return f"{self.lead}{self.before}{self.value}{self.after}"


@dataclass(slots=True)
class Node:
    """A table, or one of an array of tables, with its entries and the tables in it.

    A table of which nobody but its owner knows the meaning has no tables in it: those that follow
    it in the text are its neighbours.
    """

    path: Path
    repeated: bool = False
    lead: str = ""  # comments and empty lines above the header
    header: str = ""  # the whole line; empty for a table that is only meant
    entries: list[Entry] = field(default_factory=list)
    tail: str = ""  # comments right below the last entry
    nodes: list[Node] = field(default_factory=list)

    def entry(self, key: str) -> Entry | None:
        """The entry of this name, not of a part of it."""
        return next((entry for entry in self.entries if entry.keys == (key,)), None)

    def inline(self, key: str) -> list[Entry]:
        """Entries that make a table or a list of this name where one expects headers."""
        return [entry for entry in self.entries if entry.keys[0] == key]

    def text(self) -> Iterator[str]:
        """The pieces of its text."""
        yield self.lead
        yield self.header
        for entry in self.entries:
            yield entry.text()
        yield self.tail
        for node in self.nodes:
            yield from node.text()

    def set(self, key: str, value: Any, end: str) -> None:
        """Give a key this value; its comments stay. None takes the key away."""
        known = self.entry(key)
        if value is None:
            if known is not None:
                self.entries.remove(known)
        elif known is not None:
            known.value = toml_text.value_text(value, len(known.before)).replace("\n", end)
        else:
            before = f"{toml_text.key_text(key)} = "
            text = toml_text.value_text(value, len(before)).replace("\n", end)
            if self.path and not self.header:  # so far it was only meant by a table in it
                names = [part for part in self.path if isinstance(part, str)]
                self.header = f"{toml_text.header(names)}{end}"
                self.lead = end
            self.entries.append(Entry((key,), "", before, text, end))


class Tree:
    """The whole text. `known(path)` says whether a table at a path is one of the format's own."""

    def __init__(self, text: str, known: Any) -> None:
        self.root = Node(())
        self.end = ""  # comments after all else
        self.newline = "\r\n" if "\r\n" in text else "\n"
        self._known = known
        ended = not text or text.endswith("\n")
        self._read(text if ended else text + self.newline)

    def text(self) -> str:
        """What it was made from, with what was changed since."""
        return "".join([*self.root.text(), self.end])

    def _read(self, text: str) -> None:
        here, loose = self.root, ""
        for statement, table in placed(text):
            if not statement.keys:
                loose += text[statement.start : statement.end]
            elif statement.header:
                near, loose = _split(loose) if here.entries else ("", loose)
                here.tail += near
                here = self._open(table, statement.header == "[[")
                here.lead, loose = loose, ""
                here.header = text[statement.start : statement.end]
            else:
                here.entries.append(_entry(text, statement, loose))
                loose = ""
        near, self.end = _split(loose)
        here.tail += near

    def _open(self, path: Path, repeated: bool) -> Node:
        parent, at = self.root, 0
        while at < len(path):
            # A name, with the index behind it where there is one.
            step = 2 if at + 1 < len(path) and isinstance(path[at + 1], int) else 1
            below = path[: at + step]
            if not self._known(below):
                break
            found = next((node for node in parent.nodes if node.path == below), None)
            if below == path and (found is None or not found.header):
                break
            if found is None:
                found = Node(below)
                parent.nodes.append(found)
            parent, at = found, at + step
        meant = next((node for node in parent.nodes if node.path == path), None)
        if meant is not None and not meant.header:
            return meant
        made = Node(path, repeated)
        parent.nodes.append(made)
        return made


def made_node(
    path: Path, table: Mapping[str, Any], end: str, known: Any, *, repeated: bool, lead: str = ""
) -> Node:
    """A node that says what a table holds; tables in it that are the format's own are nodes too."""
    names = tuple(part for part in path if isinstance(part, str))
    node = Node(path, repeated, lead, toml_text.header(names, repeated=repeated) + end)
    for key, value in table.items():
        below = (*path, key)
        if isinstance(value, Mapping) and known(below):
            node.nodes.append(made_node(below, value, end, known, repeated=False, lead=end))
        elif toml_text.is_table(value) and known((*below, 0)):
            for index, item in enumerate(value):
                inner = (*below, index)
                node.nodes.append(made_node(inner, item, end, known, repeated=True, lead=end))
        elif value != [] or not known((*below, 0)):
            node.set(key, value, end)
    return node


def far_comments(lead: str) -> str:
    """Of what is above a header, the part that stands apart from it, if it says anything."""
    lines = lead.splitlines(keepends=True)
    at = len(lines)
    while at and lines[at - 1].strip():
        at -= 1
    far = "".join(lines[:at])
    return far if "#" in far else ""


def _split(loose: str) -> tuple[str, str]:
    """The comments right below an entry, and the rest, which begins with an empty line."""
    lines: Sequence[str] = loose.splitlines(keepends=True)
    at = next((k for k, line in enumerate(lines) if not line.strip()), len(lines))
    return "".join(lines[:at]), "".join(lines[at:])


def _entry(text: str, statement: Statement, lead: str) -> Entry:
    return Entry(
        statement.keys,
        lead,
        text[statement.start : statement.value_start],
        text[statement.value_start : statement.value_end],
        text[statement.value_end : statement.end],
    )
