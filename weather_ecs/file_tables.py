"""Between the tables of a file and its content: what each may hold, and older versions."""

from __future__ import annotations

from collections.abc import Callable, Mapping, Sequence
from dataclasses import MISSING, fields
from datetime import UTC, datetime, timedelta
from typing import Any, TypeVar

from weather_ecs.components import (
    Atmosphere,
    Climate,
    CloudModel,
    CloudRoot,
    CloudSeed,
    Sky,
    SkyLayer,
)
from weather_ecs.components._base import Component
from weather_ecs.errors import InvalidValueError
from weather_ecs.file_content import MANY, ONE, CloudFile, PlacedError, check_content
from weather_ecs.toml_scan import Path

VERSION = 2
FREE = "x_"  # a key that begins so is anybody's: it is kept, and means nothing here
EPOCH = datetime(1970, 1, 1, tzinfo=UTC)
CLIMATE = "climate"  # of a layer, which has no such field

C = TypeVar("C", bound=Component)
Table = dict[str, Any]

# Fields that have defaults, but that a file has to have.
REQUIRED = {(CloudModel, "name"), (CloudModel, "seeds")}
# Fields that are tables themselves.
INSIDE: dict[tuple[type[Component], str], type[Component]] = {
    (CloudModel, "seeds"): CloudSeed,
    (CloudSeed, "roots"): CloudRoot,
    (SkyLayer, "skies"): Sky,
}


def content_of(document: Mapping[str, Any]) -> CloudFile:
    """What a document says. Raises PlacedError."""
    document = migrated(document)
    _known(document, ["version", *MANY, *ONE, "quality", "extra"], ())
    values: Table = {}
    own: list[Climate | None] = []
    for key, kind in MANY.items():
        tables = document.get(key, [])
        if kind is SkyLayer:
            tables, own = _own_climates(tables)
        values[key] = tuple(many(kind, tables, (key,)))
    for key, kind in ONE.items():
        table = document.get(key)
        values[key] = None if table is None else one(kind, table, (key,))
    values["quality"] = document.get("quality")
    values["extra"] = document.get("extra", {})
    content = CloudFile(**values, layer_climates=tuple(own) if any(own) else ())
    check_content(content)
    return content


def document_of(content: CloudFile) -> Table:
    """The tables of a content; models that layers and clouds hold come with the file's own.

    Raises PlacedError for what cannot be loaded back.
    """
    models: dict[str, CloudModel] = {}

    def use(model: CloudModel) -> None:
        if models.setdefault(model.name, model) is not model:
            raise PlacedError(("models",), model.name, "names that all differ")

    for model in content.models:
        use(model)
    found: Table = {"version": VERSION, "quality": content.quality, "models": []}
    for key in MANY:
        if key != "models":
            found[key] = [table_of(item, use) for item in getattr(content, key)]
    for layer, climate in zip(found["layers"], content.layer_climates, strict=False):
        if climate is not None:
            layer[CLIMATE] = table_of(climate)
    for key in ONE:
        single = getattr(content, key)
        found[key] = None if single is None else table_of(single)
    found["models"] = [table_of(model) for model in models.values()]
    found["extra"] = content.extra or None
    return {key: value for key, value in found.items() if value is not None and value != []}


def table_of(part: Component, use: Callable[[CloudModel], None] | None = None) -> Table:
    """A component's fields as plain values; models that it holds become names, and `use` is told
    of them.
    """

    def plain(value: Any) -> Any:
        if isinstance(value, CloudModel):
            if use is not None:
                use(value)
            return value.name
        if isinstance(value, Component):
            return table_of(value, use)
        return [plain(item) for item in value] if isinstance(value, tuple) else value

    found = {entry.name: getattr(part, entry.name) for entry in fields(part)}  # type: ignore[arg-type]
    if isinstance(part, Atmosphere):
        found["time"] = as_text(part.time)
    return {key: plain(item) for key, item in found.items() if item is not None}


def as_text(time: float | str) -> float | str:
    """A moment as ISO 8601 text, where that is exact."""
    if isinstance(time, str):
        return time
    text = (EPOCH + timedelta(seconds=time)).isoformat().replace("+00:00", "Z")
    return text if datetime.fromisoformat(text).timestamp() == time else time


def migrated(document: Mapping[str, Any]) -> Mapping[str, Any]:
    """The document as the present version has it. Raises PlacedError for a version unheard of."""
    version = document.get("version")
    if type(version) is not int or not 1 <= version <= VERSION:
        raise PlacedError(("version",), version, f"a whole number from 1 to {VERSION}")
    while version != VERSION:
        document = _MIGRATIONS[version](document)
        version += 1
    return document


def _from_1(document: Mapping[str, Any]) -> Mapping[str, Any]:
    """Version 1 knew clouds alone; what it had is called and means the same."""
    _known(document, ["version", "models", "clouds", "layers", "climate"], ())
    layers = document.get("layers", [])
    for index, layer in enumerate(layers if isinstance(layers, list) else []):
        if isinstance(layer, dict) and CLIMATE in layer:
            place = ("layers", index, CLIMATE)
            raise PlacedError(place, layer[CLIMATE], "nothing of that name in version 1")
    return {**document, "version": 2}


_MIGRATIONS: dict[int, Callable[[Mapping[str, Any]], Mapping[str, Any]]] = {1: _from_1}


def _own_climates(layers: Any) -> tuple[Any, list[Climate | None]]:
    """The tables of layers without their own climates, and these."""
    if not isinstance(layers, list):
        return layers, []
    own: list[Climate | None] = []
    rest: list[Any] = []
    for index, layer in enumerate(layers):
        table = layer.get(CLIMATE) if isinstance(layer, dict) else None
        place = ("layers", index, CLIMATE)
        own.append(None if table is None else one(Climate, table, place))
        if isinstance(layer, dict):
            layer = {key: value for key, value in layer.items() if key != CLIMATE}
        rest.append(layer)
    return rest, own


def many(kind: type[C], value: Any, path: Path) -> list[C]:
    """Components out of an array of tables. Raises PlacedError."""
    if not isinstance(value, list):
        plain = ".".join(str(part) for part in path if not isinstance(part, int))
        raise PlacedError(path, value, f"an array of tables, [[{plain}]]")
    return [one(kind, item, (*path, index)) for index, item in enumerate(value)]


def one(kind: type[C], table: Any, path: Path) -> C:
    """A component out of a table that has its fields. Raises PlacedError."""
    if not isinstance(table, dict):
        raise PlacedError(path, table, f"a table with the fields of {kind.__name__}")
    entries = fields(kind)  # type: ignore[arg-type]
    names = [entry.name for entry in entries]
    _known(table, [*names, CLIMATE] if kind is SkyLayer else names, path)
    values = {key: value for key, value in table.items() if not key.startswith(FREE)}
    for entry in entries:
        required = entry.default is MISSING or (kind, entry.name) in REQUIRED
        if required and entry.name not in table:
            raise PlacedError((*path, entry.name), None, f"every {kind.__name__} has one")
    for key in {"model", "models"} & table.keys():  # which components take as mappings too
        _names(table[key], (*path, key))
    for key in table:
        inside = INSIDE.get((kind, key))
        if inside is not None:
            values[key] = tuple(many(inside, table[key], (*path, key)))
    if kind is Atmosphere and isinstance(values.get("time"), datetime):
        values["time"] = values["time"].isoformat()
    try:
        return kind(**values)
    except InvalidValueError as error:
        last = error.field.rpartition(".")[2]
        where = (*path, last) if last in kind.checks else path
        raise PlacedError(where, error.value, error.allowed) from None


def _names(value: Any, path: Path) -> None:
    if any(isinstance(item, dict) for item in (value if isinstance(value, list) else [value])):
        raise PlacedError(path, value, "names of models, which have tables of their own")


def _known(table: Mapping[str, Any], names: Sequence[str], path: Path) -> None:
    for key in table:
        if key not in names and not key.startswith(FREE):
            allowed = f"the keys {', '.join(names)}, and such as begin with {FREE}"
            raise PlacedError((*path, key), table[key], allowed)
