"""What stands in the menus of the window."""

from __future__ import annotations

from functools import partial
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from weather_ecs.editor import edits
from weather_ecs.editor.menus import LINE, Item, Menus
from weather_ecs.editor.panels.cloud import another_number

if TYPE_CHECKING:
    from weather_ecs.editor.app import EditorWindow

WORKSPACES = [("cloud", "Cloud"), ("sky", "Sky and weather")]
_MODES = (
    ("Billboards", "billboards"),
    ("Seed boxes", "boxes"),
    ("CFA rays", "rays"),
    ("Roots", "roots"),
    ("Plain light of the dissertation", "plain"),
    ("Grid on the ground", "grid"),
)


def menus_of(window: EditorWindow) -> Menus:
    """All menus, as they are now."""
    return [
        ("File", _file(window)),
        ("Edit", _edit(window)),
        ("View", _view(window)),
        ("Help", [Item("Keys and mouse", "F1", window.toggle_help)]),
    ]


def _file(window: EditorWindow) -> list[Item]:
    session = window.session
    known = bool(session.files.recent.paths)
    return [
        Item("New", "Ctrl+N", session.new),
        Item("Open...", "Ctrl+O", session.open),
        Item(
            "Open recent", draw=partial(_recent, window), enabled=bool(session.files.recent.paths)
        ),
        LINE,
        Item("Save", "Ctrl+S", session.save),
        Item("Save as...", "Ctrl+Shift+S", session.save_as),
        LINE,
        Item("Quit", "Ctrl+Q", session.quit),
    ]


def _recent(window: EditorWindow) -> None:
    for path in window.session.files.recent.paths:
        if imgui.menu_item(f"{path.name}##{path}", "", False)[0]:
            window.session.open_path(path)
        if imgui.begin_item_tooltip():
            imgui.text_unformatted(str(path))
            imgui.end_tooltip()


def _edit(window: EditorWindow) -> list[Item]:
    document, shared = window.document, window.shared
    undo, redo = document.undo_label, document.redo_label
    what = edits.name_of_focus(document, shared)
    has = what is not None
    return [
        Item(_with("Undo", undo), "Ctrl+Z", document.undo, document.can_undo),
        Item(_with("Redo", redo), "Ctrl+Y, Ctrl+Shift+Z", document.redo, document.can_redo),
        LINE,
        Item(_with("Copy", what), "Ctrl+C", partial(edits.copy, document, shared), has),
        Item("Paste", "Ctrl+V", partial(edits.paste, document, shared)),
        Item(_with("Duplicate", what), "Ctrl+D", partial(edits.duplicate, document, shared), has),
        Item(_with("Delete", what), "Del", partial(edits.delete, document, shared), has),
    ]


def _view(window: EditorWindow) -> list[Item]:
    shared = window.shared
    modes = shared.modes

    def flip(field: str) -> None:
        setattr(modes, field, not getattr(modes, field))

    shown = [
        Item(label, f"{key}", partial(flip, field), ticked=getattr(modes, field))
        for key, (label, field) in enumerate(_MODES, 1)
    ]
    return [
        *shown,
        LINE,
        Item("Move seed", "G", partial(_gizmo, window, "move"), ticked=shared.gizmo == "move"),
        Item("Size seed", "T", partial(_gizmo, window, "size"), ticked=shared.gizmo == "size"),
        Item("Whole cloud", "F, Home", partial(setattr, shared, "frame_wanted", True)),
        LINE,
        Item("Generate again", "Ctrl+G", partial(another_number, shared)),
        Item("Next cloud", "PgDn", partial(_next, window, 1)),
        Item("Cloud before", "PgUp", partial(_next, window, -1)),
        LINE,
        Item("Cloud workspace", "Ctrl+1", partial(setattr, shared, "workspace", "cloud")),
        Item("Sky and weather", "Ctrl+2", partial(setattr, shared, "workspace", "sky")),
        Item("Full screen", "F11", window.toggle_fullscreen, ticked=window.fullscreen),
    ]


def _gizmo(window: EditorWindow, kind: str) -> None:
    window.shared.gizmo = "none" if window.shared.gizmo == kind else kind


def _next(window: EditorWindow, step: int) -> None:
    window.shared.number = max(window.shared.number + step, 0)


def _with(word: str, what: str | None) -> str:
    """A label that says what it would do it to; the part after ### stays the same."""
    return f"{word} {what[0].lower()}{what[1:]}###{word}" if what else word
