"""What the commands do in the window, and the bar that shows them."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import TYPE_CHECKING

from imgui_bundle import imgui

from weather_ecs.editor import edits
from weather_ecs.editor.commands import COMMANDS, Command, Commands
from weather_ecs.editor.menus import LINE, Item, Menus
from weather_ecs.editor.panels.cloud import another_number
from weather_ecs.editor.sky_menus import export_items, simulation_items

if TYPE_CHECKING:
    from weather_ecs.editor.app import EditorWindow
    from weather_ecs.editor.shared import Shared

WORKSPACES = [("cloud", "Cloud"), ("sky", "Sky and weather")]
_MODES = ("billboards", "boxes", "rays", "roots", "plain", "grid")
_MORE = (
    Command("plain", "Cloud", "Plain light", "5", "The dissertation's own light", 1),
    Command("grid", "Cloud", "Grid on the ground", "6", "Its squares are 1 km wide", 1),
    Command("next", "Cloud", "Next cloud", "PageDown", "The next random seed", 0),
    Command("before", "Cloud", "Cloud before", "PageUp", "The random seed before", 0),
    Command("whole_screen", "View", "Full screen", "F11", "The window as large as the screen", 1),
)


def commands_of(window: EditorWindow) -> Commands:
    """All commands, bound to what this window does."""
    session, shared, document = window.session, window.shared, window.document
    commands = Commands(COMMANDS + _MORE)
    bind = commands.bind
    bind("new", session.new)
    bind("open", session.open)
    bind("reload", session.reload, enabled=lambda: document.path is not None)
    bind("save", session.save)
    bind("save_as", session.save_as)
    bind("quit", session.quit)
    _bind_edits(window, bind)
    _bind_cloud(shared, bind)
    bind("cloud_view", partial(setattr, shared, "workspace", "cloud"))
    bind("sky_view", partial(setattr, shared, "workspace", "sky"))
    bind("whole_screen", window.toggle_fullscreen)
    bind("help", window.toggle_help)
    return commands


def _bind_cloud(shared: Shared, bind: Callable[..., None]) -> None:
    """What only means something where a cloud is seen: over the world the same keys walk."""

    def here() -> bool:
        return shared.workspace == "cloud"

    bind("generate", partial(another_number, shared), enabled=here)
    bind("next", partial(_next, shared, 1), enabled=here)
    bind("before", partial(_next, shared, -1), enabled=lambda: here() and shared.number > 0)
    for field in _MODES:
        bind(field, partial(_flip, shared, field), enabled=here)
    bind("move", partial(_gizmo, shared, "move"), enabled=here)
    bind("size", partial(_gizmo, shared, "size"), enabled=here)
    bind("frame", partial(setattr, shared, "frame_wanted", True), enabled=here)


def _bind_edits(window: EditorWindow, bind: Callable[..., None]) -> None:
    document, shared = window.document, window.shared

    def labelled(word: str, what: Callable[[], str | None]) -> Callable[[], str]:
        return lambda: _with(word, what())

    bind(
        "undo",
        document.undo,
        enabled=lambda: document.can_undo,
        label=labelled("Undo", lambda: document.undo_label),
    )
    bind(
        "redo",
        document.redo,
        enabled=lambda: document.can_redo,
        label=labelled("Redo", lambda: document.redo_label),
    )
    bind("paste", partial(edits.paste, document, shared))
    for name, act in (
        ("cut", edits.cut),
        ("copy", edits.copy),
        ("duplicate", edits.duplicate),
        ("delete", edits.delete),
    ):
        bind(
            name,
            partial(act, document, shared),
            enabled=lambda: edits.focused(document, shared) is not None,
            label=labelled(name.capitalize(), lambda: edits.name_of_focus(document, shared)),
        )


def is_ticked(shared: Shared, name: str) -> bool:
    """Whether a command stands for something that is on."""
    if name in _MODES:
        return bool(getattr(shared.modes, name))
    if name in ("move", "size"):
        return shared.gizmo == name
    return (name, shared.workspace) in (("cloud_view", "cloud"), ("sky_view", "sky"))


def menus_of(window: EditorWindow) -> Menus:
    """All menus, as they are now."""
    commands = window.commands
    menus = []
    for title, found in commands.menus():
        lines = [LINE if each is None else _item(window, each) for each in found]
        if title == "File":
            known = bool(window.session.files.recent.paths)
            recent = Item("Open recent", draw=partial(recent_menu, window), enabled=known)
            quits = lines[-1]
            lines = [*lines[:2], recent, *lines[2:-1], *export_items(window), LINE, quits]
        if title == "View":
            menus.append(("Time", simulation_items(window)))
        menus.append((title, lines))
    return menus


def _item(window: EditorWindow, command: Command) -> Item:
    commands, name = window.commands, command.name
    return Item(
        commands.label(name),
        ", ".join((command.keys, *command.other_keys)),
        partial(commands.run, name),
        commands.is_enabled(name),
        is_ticked(window.shared, name),
        help=command.help,
    )


def recent_menu(window: EditorWindow) -> None:
    """The files that were opened last."""
    for path in window.session.files.recent.paths:
        if imgui.menu_item(f"{path.name}##{path}", "", False)[0]:
            window.session.open_path(path)
        if imgui.begin_item_tooltip():
            imgui.text_unformatted(str(path))
            imgui.end_tooltip()


def _flip(shared: Shared, field: str) -> None:
    setattr(shared.modes, field, not getattr(shared.modes, field))


def _gizmo(shared: Shared, kind: str) -> None:
    shared.gizmo = "none" if shared.gizmo == kind else kind


def _next(shared: Shared, step: int) -> None:
    shared.number = max(shared.number + step, 0)


def _with(word: str, what: str | None) -> str:
    """A label that says what it would do it to; the part after ### stays the same."""
    return f"{word} {what[0].lower()}{what[1:]}###{word}" if what else f"{word}###{word}"
