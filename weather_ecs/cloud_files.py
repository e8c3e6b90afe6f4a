"""Files of clouds: models, layers of skies, single clouds and a climate, as TOML.

docs/cloud-files.md describes the format. Nothing in a file is trusted: it is either good from end
to end, or refused with its line and key.
"""

from __future__ import annotations

import os
import shutil
import tomllib
from collections.abc import Mapping, Sequence
from contextlib import suppress
from dataclasses import MISSING, fields
from pathlib import Path
from typing import Any, TypeVar

from weather_ecs import toml_text
from weather_ecs.components import (
    Climate,
    Cloud,
    CloudModel,
    CloudRoot,
    CloudSeed,
    Sky,
    SkyLayer,
)
from weather_ecs.components._base import Component
from weather_ecs.errors import InvalidValueError, WeatherFileError
from weather_ecs.file_content import CLOUD_MODELS as CLOUD_MODELS
from weather_ecs.file_content import CloudFile as CloudFile
from weather_ecs.file_content import check_content as check_content
from weather_ecs.physics.reproduction import image_indices

VERSION = 1
LARGEST = 2 * 1024 * 1024  # bytes of a file
LONGEST_LINE = 2000  # characters; bounds what reading takes, however a file is made

C = TypeVar("C", bound=Component)

_SECTIONS = ("version", "models", "clouds", "layers", "climate")
# Fields that have defaults, but that a file has to have.
_REQUIRED = {(CloudModel, "name"), (CloudModel, "seeds")}
# Fields that are tables themselves.
_INSIDE: dict[tuple[type[Component], str], type[Component]] = {
    (CloudModel, "seeds"): CloudSeed,
    (CloudSeed, "roots"): CloudRoot,
    (SkyLayer, "skies"): Sky,
}


class _BadError(Exception):
    """Something that is wrong with a document, and where."""

    def __init__(self, path: toml_text.Path, value: object, allowed: str) -> None:
        self.path, self.value, self.allowed = path, value, allowed


def load_clouds(path: str | os.PathLike[str]) -> CloudFile:
    """Read a file. Raises WeatherFileError with file, line, key, value and what is allowed."""
    name = os.fspath(path)
    text = _read(name)
    try:
        document = tomllib.loads(text)
    except RecursionError:
        raise WeatherFileError(name, "values are nested too deeply") from None
    except ValueError as error:  # also of a number with thousands of digits
        raise WeatherFileError(name, f"not valid TOML: {error}") from None
    try:
        return _file(document)
    except _BadError as bad:
        line = toml_text.line_of(text, bad.path)
        raise WeatherFileError.of(name, line, _shown(bad.path), bad.value, bad.allowed) from None


def save_clouds(path: str | os.PathLike[str], content: CloudFile) -> None:
    """Write a file that `load_clouds` reads back to the same values; all of it or nothing.

    Models that layers and clouds hold are written with the file's own, and named where they are
    used. Raises WeatherFileError, also if another model has the name, and OSError.
    """
    name = os.fspath(path)
    text = toml_text.dumps(_document(name, content))
    if len(text.encode()) > LARGEST or max(map(len, text.split("\n"))) > LONGEST_LINE:
        raise WeatherFileError(name, f"more than {LARGEST} bytes, or {LONGEST_LINE} in a line")
    target = Path(name).resolve()  # a link stays a link to what is written
    temporary = target.with_name(f".{target.name}.{os.getpid()}.tmp")
    try:
        with open(temporary, "x", encoding="utf-8", newline="\n") as stream:
            stream.write(text)
            stream.flush()
            os.fsync(stream.fileno())
        with suppress(FileNotFoundError):
            shutil.copymode(target, temporary)
        os.replace(temporary, target)
    except BaseException:
        temporary.unlink(missing_ok=True)
        raise


def load_cloud_model(path: str | os.PathLike[str]) -> CloudModel:
    """The only model of a file. Raises WeatherFileError, also if the file has none or several."""
    models = load_clouds(path).models
    if len(models) != 1:
        count = f"{len(models)} models"
        raise WeatherFileError.of(os.fspath(path), None, "models", count, "one model")
    return models[0]


def save_cloud_model(path: str | os.PathLike[str], model: CloudModel) -> None:
    """Write a file with one model; see `save_clouds`."""
    save_clouds(path, CloudFile(models=(model,)))


def _read(name: str) -> str:
    try:
        if not os.path.isfile(name):
            raise WeatherFileError(name, "there is no such file")
        with open(name, "rb") as stream:
            data = stream.read(LARGEST + 1)
    except OSError as error:
        raise WeatherFileError(name, f"cannot be read: {error.strerror}") from None
    if len(data) > LARGEST:
        raise WeatherFileError(name, f"longer than {LARGEST} bytes")
    try:
        text = data.decode("utf-8")
    except UnicodeDecodeError as error:
        raise WeatherFileError(name, f"not UTF-8 text: {error}") from None
    for number, line in enumerate(text.split("\n"), 1):
        if len(line) > LONGEST_LINE:
            long = f"line {number} has {len(line)} characters, allowed: at most {LONGEST_LINE}"
            raise WeatherFileError(name, long)
    return text


def _file(document: Mapping[str, Any]) -> CloudFile:
    _known(document, _SECTIONS, ())
    version = document.get("version")
    if type(version) is not int or version != VERSION:
        raise _BadError(("version",), version, f"{VERSION}, the only version there is")
    models = _many(CloudModel, document.get("models", []), ("models",))
    clouds = _many(Cloud, document.get("clouds", []), ("clouds",))
    layers = _many(SkyLayer, document.get("layers", []), ("layers",))
    names = [model.name for model in models]
    for index, model in enumerate(models):
        if model.name in names[:index]:
            raise _BadError(("models", index, "name"), model.name, "names that all differ")
        _images(model, ("models", index))
    usable = {*names, *CLOUD_MODELS}
    for index, cloud in enumerate(clouds):
        _named([cloud.model], usable, ("clouds", index, "model"))
    for index, layer in enumerate(layers):
        for inner, sky in enumerate(layer.skies):
            _named(sky.models, usable, ("layers", index, "skies", inner, "models"))
    climate = document.get("climate")
    return CloudFile(
        tuple(models),
        tuple(clouds),
        tuple(layers),
        None if climate is None else _one(Climate, climate, ("climate",)),
    )


def _images(model: CloudModel, path: toml_text.Path) -> None:
    where = [(path, model.images)]
    where += [((*path, "seeds", i), seed.images) for i, seed in enumerate(model.seeds)]
    for place, images in where:
        try:
            image_indices(images)
        except InvalidValueError as error:
            raise _BadError((*place, "images"), error.value, error.allowed) from None


def _names(value: Any, path: toml_text.Path) -> None:
    if any(isinstance(item, dict) for item in (value if isinstance(value, list) else [value])):
        raise _BadError(path, value, "names of models, which have tables of their own")


def _named(models: Sequence[Any], usable: set[str], path: toml_text.Path) -> None:
    for model in models:
        if model not in usable:
            raise _BadError(path, model, "a model of this file or of the package")


def _many(kind: type[C], value: Any, path: toml_text.Path) -> list[C]:
    if not isinstance(value, list):
        raise _BadError(path, value, f"an array of tables, [[{_plain(path)}]]")
    return [_one(kind, item, (*path, index)) for index, item in enumerate(value)]


def _one(kind: type[C], table: Any, path: toml_text.Path) -> C:
    """A component out of a table that has its fields."""
    if not isinstance(table, dict):
        raise _BadError(path, table, f"a table with the fields of {kind.__name__}")
    entries = fields(kind)  # type: ignore[arg-type]
    _known(table, [entry.name for entry in entries], path)
    for entry in entries:
        required = entry.default is MISSING or (kind, entry.name) in _REQUIRED
        if required and entry.name not in table:
            raise _BadError((*path, entry.name), None, f"every {kind.__name__} has one")
    values = dict(table)
    for key in {"model", "models"} & table.keys():  # which components take as mappings too
        _names(table[key], (*path, key))
    for key in table:
        inside = _INSIDE.get((kind, key))
        if inside is not None:
            values[key] = tuple(_many(inside, table[key], (*path, key)))
    try:
        return kind(**values)
    except InvalidValueError as error:
        last = error.field.rpartition(".")[2]
        where = (*path, last) if last in kind.checks else path
        raise _BadError(where, error.value, error.allowed) from None


def _known(table: Mapping[str, Any], names: Sequence[str], path: toml_text.Path) -> None:
    for key in table:
        if key not in names:
            raise _BadError((*path, key), table[key], f"the keys {', '.join(names)}")


def _shown(path: toml_text.Path) -> str:
    text = ""
    for part in path:
        text += f"[{part}]" if isinstance(part, int) else f".{part}" if text else str(part)
    return text


def _plain(path: toml_text.Path) -> str:
    return ".".join(str(part) for part in path if not isinstance(part, int))


def _document(name: str, content: CloudFile) -> dict[str, Any]:
    models: dict[str, CloudModel] = {}

    def use(model: CloudModel | str) -> str:
        if isinstance(model, str):
            return model
        if models.setdefault(model.name, model) is not model:
            raise WeatherFileError.of(name, None, "models", model.name, "names that all differ")
        return model.name

    def plain(value: Any) -> Any:
        if isinstance(value, CloudModel):
            return use(value)
        if isinstance(value, Component):
            return _fields(value)
        return [plain(item) for item in value] if isinstance(value, tuple) else value

    def _fields(value: Component) -> dict[str, Any]:
        names = [entry.name for entry in fields(value)]  # type: ignore[arg-type]
        return {key: plain(getattr(value, key)) for key in names}

    for model in content.models:
        use(model)
    used = {key: [_fields(it) for it in getattr(content, key)] for key in ("clouds", "layers")}
    document = {"version": VERSION, "models": [_fields(it) for it in models.values()], **used}
    if content.climate is not None:
        document["climate"] = _fields(content.climate)
    return {key: value for key, value in document.items() if value != []}
