"""The text of a content, as its author wrote it wherever the content is as it was.

Comments, the order and the layout of what has not changed stay, and so do keys that begin with
`x_`. What cannot be kept so (it never has been seen) is written anew as a whole.

Why not tomlkit: of a file of 50 models with 100 seeds each (1.1 MB) it takes 4.7 s to read and
0.2 s to write, and 1.2 s to read 50 models with 12 seeds, where opening is to take less than one;
the tree here takes 0.45 s and 0.02 s, and 0.06 s of the smaller one. Besides, a table's comments
are to follow it where it is moved, and to stay where it is taken away, which is this module's.
"""

from __future__ import annotations

import tomllib
from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import Any

from weather_ecs import CloudFile
from weather_ecs.cloud_files import VERSION, check_content, read_content, text_of
from weather_ecs.components import SkyLayer
from weather_ecs.components._base import Component
from weather_ecs.editor.toml_tree import Node, Tree, far_comments, made_node
from weather_ecs.errors import WeatherFileError
from weather_ecs.file_content import MANY, ONE
from weather_ecs.file_tables import CLIMATE, INSIDE, document_of
from weather_ecs.toml_scan import Path

Table = Mapping[str, Any]

_KINDS: dict[str, type[Component]] = {**MANY, **ONE}
_NAMES = ("name", "state")  # fields by which an author knows a thing
_MOST_PAIRS = 100_000  # compared field by field; of more, the order alone counts


def kept_text(name: str, text: str, before: CloudFile, content: CloudFile) -> str:
    """What to write for `content` where the file said `text`, which was `before`.

    Raises InvalidValueError or WeatherFileError for a content that no file can hold.
    """
    if not text.strip():
        return text_of(name, content)
    check_content(content)
    wanted = document_of(content)
    tree = Tree(text, _known)
    _Merge(tree, text).run(document_of(before), wanted)
    kept = tree.text()
    try:
        if repr(document_of(read_content(name, kept))) == repr(wanted):
            return kept
    except WeatherFileError:
        pass
    return _opening(text) + text_of(name, content)


class _Merge:
    def __init__(self, tree: Tree, text: str) -> None:
        self._tree, self._text, self._end = tree, text, tree.newline

    @cached_property
    def _raw(self) -> Table:
        """The text as Python reads it: only wanted for tables that are written in a line."""
        return tomllib.loads(self._text)

    def run(self, before: Table, after: Table) -> None:
        root = self._tree.root
        version = root.entry("version")
        if version is None or version.value != str(VERSION):
            root.set("version", VERSION, self._end)
        if before.get("quality") != after.get("quality"):
            root.set("quality", after.get("quality"), self._end)
        if repr(before.get("extra")) != repr(after.get("extra")):
            self._extra(root, after.get("extra"))
        for key in (*MANY, *ONE):
            self._part(root, (), key, before.get(key), after.get(key), key in MANY)

    def _extra(self, root: Node, table: Table | None) -> None:
        """Another table of the game's own: nothing is known of it, so it is written anew."""
        root.entries = [entry for entry in root.entries if entry.keys[0] != "extra"]
        root.nodes = [node for node in root.nodes if node.path[0] != "extra"]
        if table:
            self._add(root, made_node(("extra",), table, self._end, _no, repeated=False))

    def _part(self, node: Node, path: Path, key: str, before: Any, after: Any, many: bool) -> None:
        """One field of a table that is tables itself: one of them, or a list."""
        if repr(before) == repr(after):
            return
        inline = node.inline(key)
        if inline:
            node.entries = [entry for entry in node.entries if entry not in inline]
            value = self._value((*path, key))
            items = value if many else [value]
            for index, item in enumerate(items):
                place = (*path, key, index) if many else (*path, key)
                node.nodes.append(
                    made_node(place, item, self._end, _known, repeated=many, lead=self._end)
                )
        old = before or [] if many else [before] * (before is not None)
        new = after or [] if many else [after] * (after is not None)
        place = (*path, key)
        known = {each.path: each for each in node.nodes}
        places = [(*place, index) if many else place for index in range(len(old))]
        made: list[Node] = []
        pairs = match(old, new)
        for item, at in zip(new, pairs, strict=True):
            if at is None:
                there = (*place, len(old) + len(made)) if many else place
                fresh = made_node(there, item, self._end, _known, repeated=many, lead=self._end)
                made.append(fresh)
            else:
                own = known[places[at]]
                self._table(own, places[at], old[at], item)
                made.append(own)
        self._put(node, [known[at] for at in places if at in known], made)

    def _value(self, path: Path) -> Any:
        value: Any = self._raw
        for part in path:
            value = value[part]
        return value

    def _table(self, node: Node, path: Path, before: Table, after: Table) -> None:
        """Bring a table up to what it is to say."""
        kind = _kind(path)
        inside = _inside(kind)
        for key in dict.fromkeys((*before, *after)):
            if key in inside:
                self._part(node, path, key, before.get(key), after.get(key), key != CLIMATE)
            elif repr(before.get(key)) != repr(after.get(key)):
                node.set(key, after.get(key), self._end)

    def _put(self, parent: Node, old: Sequence[Node], new: Sequence[Node]) -> None:
        """Let the new nodes stand where the old ones stood, and the rest after the last."""
        ids = {id(node) for node in old}
        slots = [at for at, node in enumerate(parent.nodes) if id(node) in ids]
        kept = {id(node) for node in new}
        result: list[Node] = []
        waiting, apart = list(new), ""
        last = slots[-1] if slots else -1
        for at, node in enumerate(parent.nodes):
            if id(node) not in ids:
                node.lead, apart = apart + node.lead, ""
                result.append(node)
                continue
            if id(node) not in kept:
                apart += far_comments(node.lead)
            if waiting:
                result.append(waiting.pop(0))
            if at == last:
                result.extend(waiting)
                waiting = []
        parent.nodes = result
        self._tree.end = apart + self._tree.end
        for node in waiting:
            self._add(parent, node)

    def _add(self, parent: Node, node: Node) -> None:
        """A table at the end of another; the text before it has to end its line."""
        node.lead = node.lead or self._end
        parent.nodes.append(node)


def match(old: Sequence[Table], new: Sequence[Table]) -> list[int | None]:
    """For each new thing the index of the old one that it was; None for one that is new.

    What is the same comes first, then what has the same name or state, then what is most alike.
    """
    found: list[int | None] = [None] * len(new)
    free = dict.fromkeys(range(len(old)))

    def take(key: Any) -> None:
        known: dict[Any, list[int]] = {}
        for at in reversed(free):
            known.setdefault(key(old[at]), []).append(at)
        for index, item in enumerate(new):
            if found[index] is None and (there := known.get(key(item))):
                at = found[index] = there.pop()
                del free[at]

    take(repr)
    for name in _NAMES:
        take(lambda item, name=name: item.get(name, id(item)))
    rest = [index for index, at in enumerate(found) if at is None]
    if len(rest) * len(free) > _MOST_PAIRS:
        found_rest = zip(rest, list(free), strict=False)
    else:
        found_rest = _alike(old, new, rest, free)
    for index, at in found_rest:
        found[index] = at
    return found


def _alike(
    old: Sequence[Table], new: Sequence[Table], rest: Sequence[int], free: Mapping[int, None]
) -> Any:
    """Pairs of what is left, the most alike first."""
    scores = sorted(
        (-_score(old[at], new[index]), abs(at - index), index, at) for index in rest for at in free
    )
    taken: set[int] = set()
    used: set[int] = set()
    for score, _, index, at in scores:
        if score < 0 and index not in taken and at not in used:
            taken.add(index)
            used.add(at)
            yield index, at


def _score(a: Table, b: Table) -> int:
    return sum(key in b and repr(a[key]) == repr(b[key]) for key in a)


def _known(path: Path) -> bool:
    """Whether a place is that of a component: one of the format's own tables."""
    try:
        return _kind(path) is not None and (isinstance(path[-1], int) is _is_many(path))
    except KeyError:
        return False


def _is_many(path: Path) -> bool:
    name = next(part for part in reversed(path) if isinstance(part, str))
    return name not in ONE


def _kind(path: Path) -> type[Component] | None:
    """The component whose table is at a place. Raises KeyError where none is."""
    names = [part for part in path if isinstance(part, str)]
    if not names:
        raise KeyError(path)
    kind = _KINDS[names[0]]
    for name in names[1:]:
        if name == CLIMATE and kind is SkyLayer:
            kind = ONE[CLIMATE]
        else:
            kind = INSIDE[kind, name]
    return kind


def _inside(kind: type[Component] | None) -> set[str]:
    names = {name for owner, name in INSIDE if owner is kind}
    return names | {CLIMATE} if kind is SkyLayer else names


def _no(path: Path) -> bool:
    return False


def _opening(text: str) -> str:
    """The comments at the head of a text."""
    lines = []
    for line in text.splitlines(keepends=True):
        if line.strip() and not line.lstrip().startswith("#"):
            break
        lines.append(line)
    return "".join(lines)
