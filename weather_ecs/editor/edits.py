"""Copy, paste, duplicate and delete of whatever was chosen last."""

from __future__ import annotations

from typing import Any

from imgui_bundle import imgui

from weather_ecs.components import CloudModel, CloudSeed
from weather_ecs.editor import clipboard, pasting
from weather_ecs.editor.document import Document
from weather_ecs.editor.panels.cloud import add_model
from weather_ecs.editor.panels.seed import add_seed, beside
from weather_ecs.editor.shared import Shared
from weather_ecs.errors import WeatherFileError

OF_CLOUD = ("model", "seed", "root", "cloud")
OF_SKY = ("layer", "sky", "area", "wind", "cloud")


def focused(document: Document, shared: Shared) -> Any:
    """The component that copy would copy; None where nothing is chosen."""
    seen = OF_SKY if shared.workspace == "sky" else OF_CLOUD
    if shared.focus not in pasting.WHAT or shared.focus not in seen:
        return None  # what is not to be seen is not to be taken away
    return pasting.chosen(document.content, shared.focus, shared.selection)


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
    if focused(document, shared) is not None:
        text = pasting.cut(document, shared.focus, shared.selection)
        if text is not None:
            imgui.set_clipboard_text(text)
        shared.selection.clamp(document)


def paste(document: Document, shared: Shared) -> None:
    """Add what is on the clipboard: seeds to the chosen model, roots to the chosen seed."""
    where = shared.selection
    model = where.model
    try:
        parts = clipboard.pasted(imgui.get_clipboard_text() or "")
    except WeatherFileError as error:
        shared.say(f"Nothing to paste: {error}", bad=True)
        return
    name = clipboard.kind_name(parts)
    if pasting.insert(document, parts, where, f"Paste {name}"):
        shared.say(f"Pasted {name}")
        if where.model != model:
            shared.choose_model(where.model)
        where.clamp(document)


def duplicate(document: Document, shared: Shared) -> None:
    """Another one beside it."""
    thing = focused(document, shared)
    if isinstance(thing, CloudModel):
        add_model(document, shared, thing, f"Copy {thing.name}")
    elif isinstance(thing, CloudSeed):
        add_seed(document, shared, beside(thing), "Copy seed")
    elif thing is not None:
        pasting.duplicate(document, shared.focus, shared.selection)


def delete(document: Document, shared: Shared) -> None:
    """Take it away."""
    if focused(document, shared) is not None:
        pasting.delete(document, shared.focus, shared.selection)
        shared.selection.clamp(document)
