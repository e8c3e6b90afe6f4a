"""Copy, cut, paste and duplicate in a document, where something is chosen."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace
from typing import Protocol, TypeVar

from weather_ecs import CloudFile
from weather_ecs.components import CloudModel, CloudRoot, CloudSeed, Sky
from weather_ecs.components._base import Component
from weather_ecs.editor.clipboard import copied, kind_name, pasted
from weather_ecs.editor.content import (
    free_name,
    put,
    swapped,
    with_item,
    with_new,
    with_seed,
    without,
)
from weather_ecs.editor.document import Document
from weather_ecs.errors import InvalidValueError
from weather_ecs.file_content import MANY, ONE

T = TypeVar("T")

# What can be chosen, and the list of the content that it is in.
TOP = {
    "model": "models",
    "cloud": "clouds",
    "layer": "layers",
    "area": "rain_areas",
    "wind": "winds",
}
WHAT = (*TOP, "seed", "root", "sky")


class Selection(Protocol):
    """Indices of what is chosen, each within its list."""

    model: int
    seed: int
    root: int
    cloud: int
    layer: int
    sky: int
    area: int
    wind: int


def chosen(content: CloudFile, what: str, where: Selection) -> Component | None:
    """The part that is chosen of a kind in WHAT; None where there is none."""
    if what in TOP:
        return _at(getattr(content, TOP[what]), getattr(where, what))
    if what == "sky":
        layer = _at(content.layers, where.layer)
        return None if layer is None else _at(layer.skies, where.sky)
    model = _at(content.models, where.model)
    seed = None if model is None else _at(model.seeds, where.seed)
    if what == "seed" or seed is None:
        return seed
    return _at(seed.roots, where.root)


def copy(document: Document, what: str, where: Selection) -> str | None:
    """The text to put on the clipboard; None where nothing is chosen."""
    part = chosen(document.content, what, where)
    return None if part is None else copied([part])


def cut(document: Document, what: str, where: Selection) -> str | None:
    """The same, and take it out of the document; None where that cannot be."""
    text = copy(document, what, where)
    return text if text is not None and delete(document, what, where, "Cut") else None


def delete(document: Document, what: str, where: Selection, label: str = "Delete") -> bool:
    """Take away what is chosen; whether that could be."""
    part = chosen(document.content, what, where)
    if part is None:
        return False
    name = f"{label} {kind_name([part])}"
    if not document.try_apply(name, lambda: _less(document.content, what, where)):
        return False
    setattr(where, what, max(getattr(where, what) - 1, 0))
    return True


def duplicate(document: Document, what: str, where: Selection) -> bool:
    """One more like what is chosen, behind it, and chosen then; whether that could be."""
    part = chosen(document.content, what, where)
    return part is not None and insert(document, [part], where, f"Copy {kind_name([part])}")


def paste(document: Document, text: str, where: Selection) -> bool:
    """Put in what the clipboard holds; whether the document took it.

    Raises WeatherFileError for a text that holds nothing of a weather.
    """
    parts = pasted(text)
    return insert(document, parts, where, f"Paste {kind_name(parts)}")


def insert(document: Document, parts: Sequence[Component], where: Selection, label: str) -> bool:
    """Put parts in behind what is chosen of their kind, and choose them; one step of undo.

    A model whose name is taken gets another one; what there can be only one of takes its place.
    """
    at = {what: getattr(where, what) for what in WHAT}

    def made() -> CloudFile:
        content = document.content
        for part in parts:
            content = _more(content, part, at)
        return content

    if not document.try_apply(label, made):
        return False
    for what, index in at.items():
        setattr(where, what, index)
    return True


def _more(content: CloudFile, part: Component, at: dict[str, int]) -> CloudFile:
    if isinstance(part, CloudRoot | CloudSeed | Sky):
        return _inside(content, part, at)
    for key, kind in ONE.items():
        if isinstance(part, kind):
            return put(content, **{key: part})
    if isinstance(part, CloudModel):
        part = replace(part, name=free_name(content, part.name))
    key = next(key for key, kind in MANY.items() if isinstance(part, kind))
    what = next((what for what in TOP if TOP[what] == key), "")
    index = min(at[what] + 1, len(getattr(content, key))) if what else None
    if what and index is not None:
        at[what] = index
    return with_new(content, key, part, index)


def _inside(content: CloudFile, part: CloudRoot | CloudSeed | Sky, at: dict[str, int]) -> CloudFile:
    """A part of a model or of a layer, behind the chosen one."""
    if isinstance(part, Sky):
        layer = _at(content.layers, at["layer"])
        if layer is None:
            raise InvalidValueError("skies", part, "a layer to paste them into")
        state, taken = part.state, {sky.state for sky in layer.skies}
        while state in taken:  # no two of the same
            state = state + 0.01 if state <= 0.99 and part.state < 1.0 else state - 0.01
        at["sky"] = len(layer.skies)
        changed = replace(layer, skies=(*layer.skies, replace(part, state=state)))
        return with_item(content, "layers", at["layer"], changed)
    model = _at(content.models, at["model"])
    if model is None:
        raise InvalidValueError("seeds", part, "a model to paste them into")
    if isinstance(part, CloudSeed):
        index = at["seed"] = min(at["seed"] + 1, len(model.seeds))
        seeds = (*model.seeds[:index], part, *model.seeds[index:])
        return with_item(content, "models", at["model"], replace(model, seeds=seeds))
    seed = model.seeds[min(at["seed"], len(model.seeds) - 1)]
    index = at["root"] = min(at["root"] + 1, len(seed.roots))
    roots = (*seed.roots[:index], part, *seed.roots[index:])
    return with_seed(content, at["model"], at["seed"], replace(seed, roots=roots))


def _less(content: CloudFile, what: str, where: Selection) -> CloudFile:
    if what in TOP:
        return without(content, TOP[what], getattr(where, what))
    if what == "sky":
        layer = content.layers[where.layer]
        skies = _dropped(layer.skies, where.sky)
        return with_item(content, "layers", where.layer, replace(layer, skies=skies))
    model = content.models[where.model]
    if what == "seed":
        changed = replace(model, seeds=_dropped(model.seeds, where.seed))
        return with_item(content, "models", where.model, changed)
    seed = model.seeds[where.seed]
    fewer = replace(seed, roots=_dropped(seed.roots, where.root))
    seeds = swapped(model.seeds, where.seed, fewer)
    return with_item(content, "models", where.model, replace(model, seeds=seeds))


def _dropped(items: tuple[T, ...], index: int) -> tuple[T, ...]:
    return items[:index] + items[index + 1 :]


def _at(items: tuple[T, ...], index: int) -> T | None:
    return items[index] if 0 <= index < len(items) else None
