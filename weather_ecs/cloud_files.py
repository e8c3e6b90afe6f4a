"""Files of clouds and weather: models, layers of skies, rain areas, wind, fog and more, as TOML.

docs/cloud-files.md describes the format. Nothing in a file is trusted: it is either good from end
to end, or refused with its line and key.
"""

from __future__ import annotations

import os
import tomllib
from collections.abc import Mapping
from typing import Any

from weather_ecs import file_text, toml_text
from weather_ecs.components import CloudModel
from weather_ecs.errors import InvalidValueError, WeatherFileError
from weather_ecs.file_content import CLOUD_MODELS as CLOUD_MODELS
from weather_ecs.file_content import CloudFile as CloudFile
from weather_ecs.file_content import PlacedError
from weather_ecs.file_content import check_content as check_content
from weather_ecs.file_tables import VERSION as VERSION
from weather_ecs.file_tables import content_of, document_of
from weather_ecs.file_text import LARGEST as LARGEST
from weather_ecs.toml_scan import line_of


def load_clouds(path: str | os.PathLike[str]) -> CloudFile:
    """Read a file. Raises WeatherFileError with file, line, key, value and what is allowed."""
    name = os.fspath(path)
    return read_content(name, file_text.read_text(name))


def read_content(name: str, text: str) -> CloudFile:
    """What the text of a file says; `name` is for errors. Raises WeatherFileError."""
    document = file_text.parse(name, text)
    try:
        return content_of(document)
    except PlacedError as bad:
        line = line_of(text, bad.path)
        raise WeatherFileError.of(name, line, bad.field, bad.value, bad.allowed) from None


def text_of(name: str, content: CloudFile) -> str:
    """The text of a file that holds this. Raises WeatherFileError for what cannot be read back."""
    try:
        check_content(content)
        document = document_of(content)
        if content.extra:
            _check_extra(name, content.extra)
        return toml_text.dumps(document)
    except InvalidValueError as bad:
        raise WeatherFileError.of(name, None, bad.field, bad.value, bad.allowed) from None


def _check_extra(name: str, extra: Mapping[str, Any]) -> None:
    """What is anybody's may be anything: it is tried whether it can be read back."""
    if file_text.depth(extra) > file_text.DEEPEST - 2:
        raise InvalidValueError("extra", "deeper tables", f"{file_text.DEEPEST - 2} levels")
    try:
        text = toml_text.dumps({"extra": extra})
        text.encode("utf-8")
        tomllib.loads(text)
    except (ValueError, TypeError, RecursionError) as error:
        raise WeatherFileError(name, f"extra: a TOML file cannot hold it: {error}") from None


def save_clouds(path: str | os.PathLike[str], content: CloudFile) -> None:
    """Write a file that `load_clouds` reads back to the same values; all of it or nothing.

    Models that layers and clouds hold are written with the file's own, and named where they are
    used. Raises WeatherFileError, also if another model has the name, and OSError.
    """
    name = os.fspath(path)
    file_text.write_text(name, text_of(name, content))


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
