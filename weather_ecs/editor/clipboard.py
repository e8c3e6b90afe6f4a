"""Copy and paste: parts of a document as TOML text, which any editor of text can hold.

    clip.set(copied(model.seeds[1:3]))
    for part in pasted(clip.get()): ...

What was cut out of a file by hand can be pasted too, and a whole file: its parts.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from weather_ecs import toml_text
from weather_ecs.components import CloudModel, CloudRoot, CloudSeed, Sky
from weather_ecs.components._base import Component
from weather_ecs.errors import WeatherFileError
from weather_ecs.file_content import MANY, ONE, PlacedError
from weather_ecs.file_tables import many, one, table_of
from weather_ecs.file_text import LARGEST, parse
from weather_ecs.toml_scan import line_of

CLIPBOARD = "the clipboard"  # in place of a file's name
_KINDS: dict[str, type[Component]] = {
    **MANY,
    "skies": Sky,
    "seeds": CloudSeed,
    "roots": CloudRoot,
}
_KEYS = {kind: key for key, kind in (*_KINDS.items(), *ONE.items())}


def copied(parts: Sequence[Component]) -> str:
    """The text for some parts. Raises TypeError for a component that no file holds."""
    document: dict[str, Any] = {}
    for part in parts:
        key = _KEYS.get(type(part))
        if key is None:
            raise TypeError(f"a file holds no {type(part).__name__}")
        if key in ONE:
            document[key] = table_of(part)
        else:
            document.setdefault(key, []).append(table_of(part))
    return toml_text.dumps(document, "weather_ecs")


def pasted(text: str) -> tuple[Component, ...]:
    """The parts in a text, in the order of the format. Raises WeatherFileError for any other."""
    if not isinstance(text, str) or not text.strip():
        raise WeatherFileError(CLIPBOARD, "is empty")
    if len(text) > LARGEST:
        raise WeatherFileError(CLIPBOARD, f"longer than {LARGEST} characters")
    document = parse(CLIPBOARD, text)
    found: list[Component] = []
    try:
        for keys, value in _groups(document):
            if keys[-1] in ONE:
                found.append(one(ONE[keys[-1]], value, keys))
            else:
                found += many(_KINDS[keys[-1]], value, keys)
    except PlacedError as bad:
        line = line_of(text, bad.path)
        raise WeatherFileError.of(CLIPBOARD, line, bad.field, bad.value, bad.allowed) from None
    if not found:
        known = ", ".join([*_KINDS, *ONE])
        raise WeatherFileError(CLIPBOARD, f"holds nothing of a weather, allowed: {known}")
    return tuple(found)


def _groups(document: Mapping[str, Any]) -> list[tuple[tuple[str, ...], Any]]:
    """Places and values of what can be read; of tables without their owner these alone."""
    found: list[tuple[tuple[str, ...], Any]] = []
    for key, value in document.items():
        place: tuple[str, ...] = (key,)
        while isinstance(value, Mapping) and key not in ONE and len(value) == 1:
            # [[models.seeds]] as it stands in a file, without its [[models]]
            [(inner, value)] = value.items()
            place = (*place, inner)
            key = inner
        if key in _KINDS or key in ONE:
            if key == "layers":
                value = [_without_climate(layer) for layer in value] if _is_list(value) else value
            found.append((place, value))
    return found


def _without_climate(layer: Any) -> Any:
    if not isinstance(layer, Mapping):
        return layer
    return {key: value for key, value in layer.items() if key != "climate"}


def _is_list(value: Any) -> bool:
    return isinstance(value, list)


def kind_name(parts: Sequence[Component]) -> str:
    """What some parts are called in a menu: seed, 3 roots, cloud model."""
    names = {CloudModel: "cloud model", CloudSeed: "seed", CloudRoot: "root", Sky: "sky"}
    kinds = {type(part) for part in parts}
    if len(kinds) != 1:
        return f"{len(parts)} things"
    [kind] = kinds
    name = names.get(kind) or _KEYS[kind].replace("_", " ").removesuffix("s")
    return name if len(parts) == 1 else f"{len(parts)} {name}s".replace("skys", "skies")
