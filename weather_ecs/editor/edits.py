"""Copy, paste, duplicate and delete of whatever was chosen last."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

from imgui_bundle import imgui

from weather_ecs.components import CloudModel, CloudRoot, CloudSeed, Sky
from weather_ecs.editor import clipboard
from weather_ecs.editor.content import free_name, with_item, with_new, with_seed, without
from weather_ecs.editor.document import Content, Document
from weather_ecs.editor.panels.cloud import add_model
from weather_ecs.editor.panels.root import add_root, delete_root
from weather_ecs.editor.panels.seed import add_seed, beside, delete_seed
from weather_ecs.editor.shared import Shared
from weather_ecs.errors import InvalidValueError, WeatherFileError

# What a focus means: the list of the content it is in, and the field of the selection.
_LISTS = {
    "model": ("models", "model"),
    "cloud": ("clouds", "cloud"),
    "layer": ("layers", "layer"),
    "area": ("rain_areas", "area"),
}
_TABLES = {"clouds", "layers", "rain_areas", "winds"}


def focused(document: Document, shared: Shared) -> Any:
    """The component that copy would copy; None where nothing is chosen."""
    content, where = document.content, shared.selection
    if shared.focus in _LISTS:
        field, index = _LISTS[shared.focus]
        things = getattr(content, field)
        return things[getattr(where, index)] if things else None
    if shared.focus in ("seed", "root") and content.models:
        seed = content.models[where.model].seeds[where.seed]
        if shared.focus == "seed":
            return seed
        return seed.roots[where.root] if seed.roots else None
    if shared.focus == "sky" and content.layers and content.layers[where.layer].skies:
        return content.layers[where.layer].skies[where.sky]
    return None


def name_of_focus(document: Document, shared: Shared) -> str | None:
    """What menus call it."""
    thing = focused(document, shared)
    return None if thing is None else clipboard.kind_name((thing,))


def copy(document: Document, shared: Shared) -> None:
    """Put it on the system's clipboard, as the text that a file has for it."""
    thing = focused(document, shared)
    if thing is not None:
        imgui.set_clipboard_text(clipboard.copied((thing,)))
        shared.say(f"Copied a {clipboard.kind_name((thing,))}")


def cut(document: Document, shared: Shared) -> None:
    """Copy it, and take it away."""
    copy(document, shared)
    delete(document, shared)


def paste(document: Document, shared: Shared) -> None:
    """Add what is on the clipboard: seeds to the chosen model, roots to the chosen seed."""
    try:
        parts = clipboard.pasted(imgui.get_clipboard_text() or "")
    except WeatherFileError as error:
        shared.say(f"Nothing to paste: {error}", bad=True)
        return
    label = f"Paste {clipboard.kind_name(parts)}"
    if document.try_apply(label, lambda: _with(document.content, shared, parts)):
        shared.say(f"Pasted {clipboard.kind_name(parts)}")
        _choose_last(document, shared, parts[-1])


def duplicate(document: Document, shared: Shared) -> None:
    """Another one beside it."""
    thing = focused(document, shared)
    if isinstance(thing, CloudModel):
        add_model(document, shared, thing, f"Copy {thing.name}")
    elif isinstance(thing, CloudSeed):
        add_seed(document, shared, beside(thing), "Copy seed")
    elif isinstance(thing, CloudRoot):
        add_root(document, shared, replace(thing), "Copy root")
    elif thing is not None and shared.focus in _LISTS:
        field, index = _LISTS[shared.focus]
        at = getattr(shared.selection, index) + 1
        label = f"Copy {clipboard.kind_name((thing,))}"
        content = document.content
        if document.try_apply(label, lambda: with_new(content, field, replace(thing), at)):
            setattr(shared.selection, index, at)


def delete(document: Document, shared: Shared) -> None:
    """Take it away."""
    thing = focused(document, shared)
    if thing is None:
        return
    content, where = document.content, shared.selection
    if shared.focus == "seed":
        delete_seed(document, shared)
    elif shared.focus == "root":
        delete_root(document, shared)
    elif shared.focus == "sky":
        layer = content.layers[where.layer]
        skies = layer.skies[: where.sky] + layer.skies[where.sky + 1 :]
        changed = replace(layer, skies=skies)
        document.try_apply("Delete sky", lambda: with_item(content, "layers", where.layer, changed))
    else:
        field, index = _LISTS[shared.focus]
        label = f"Delete {clipboard.kind_name((thing,))}"
        document.try_apply(label, lambda: without(content, field, getattr(where, index)))
    where.clamp(document)


def _with(content: Content, shared: Shared, parts: tuple[Any, ...]) -> Content:
    where = shared.selection
    for part in parts:
        if isinstance(part, CloudModel):
            named = replace(part, name=free_name(content, part.name))
            content = with_new(content, "models", named)
        elif isinstance(part, (CloudSeed, CloudRoot)):
            content = _into_model(content, where.model, where.seed, part)
        elif isinstance(part, Sky):
            if not content.layers:
                raise InvalidValueError("paste", "a sky", "a layer to put it into")
            layer = content.layers[where.layer]
            layer = replace(layer, skies=(*layer.skies, part))
            content = with_item(content, "layers", where.layer, layer)
        else:
            key = next((k for k, kind in clipboard.MANY.items() if kind is type(part)), None)
            if key in _TABLES:
                content = with_new(content, key, part)
            else:
                single = next(k for k, kind in clipboard.ONE.items() if kind is type(part))
                content = replace(content, **{single: part})
    return content


def _into_model(content: Content, at: int, of: int, part: CloudSeed | CloudRoot) -> Content:
    if not content.models:
        raise InvalidValueError("paste", type(part).__name__, "a model to put it into")
    model = content.models[at]
    if isinstance(part, CloudSeed):
        return with_item(content, "models", at, replace(model, seeds=(*model.seeds, part)))
    seed = model.seeds[of]
    return with_seed(content, at, of, replace(seed, roots=(*seed.roots, part)))


def _choose_last(document: Document, shared: Shared, part: Any) -> None:
    models, where = document.content.models, shared.selection
    if isinstance(part, CloudModel):
        shared.choose_model(len(models) - 1)
    elif isinstance(part, CloudSeed):
        where.seed, where.root = len(models[where.model].seeds) - 1, 0
    elif isinstance(part, CloudRoot):
        where.root = len(models[where.model].seeds[where.seed].roots) - 1
