"""The bar of menus, and the keys that do the same."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from typing import NamedTuple

from imgui_bundle import imgui

from weather_ecs.editor import theme

Act = Callable[[], object]
_KEYS = {
    "Ctrl": imgui.Key.mod_ctrl,
    "Shift": imgui.Key.mod_shift,
    "Alt": imgui.Key.mod_alt,
    "PageDown": imgui.Key.page_down,
    "PageUp": imgui.Key.page_up,
    "Left": imgui.Key.left_arrow,
    "Right": imgui.Key.right_arrow,
    ".": imgui.Key.period,
}


class Item(NamedTuple):
    """One line of a menu."""

    label: str  # empty: a line between groups
    keys: str = ""  # as it is shown, such as Ctrl+Shift+S; several with a comma
    act: Act | None = None
    enabled: bool = True
    ticked: bool = False
    draw: Act | None = None  # draws a menu of its own in place of an act
    help: str = ""


LINE = Item("")
Menus = list[tuple[str, list[Item]]]


def draw_bar(menus: Menus, workspaces: list[tuple[str, str]], current: str) -> str:
    """The bar at the top, with the workspaces in its middle; the workspace that is chosen now."""
    imgui.push_style_var(imgui.StyleVar_.frame_padding, imgui.ImVec2(8.0, 7.0))
    opened = imgui.begin_main_menu_bar()
    imgui.pop_style_var()
    if not opened:
        return current
    for title, lines in menus:
        if imgui.begin_menu(title):
            for item in lines:
                _draw_item(item)
            imgui.end_menu()
    imgui.dummy(imgui.ImVec2(18.0, 0.0))
    for name, title in workspaces:
        on = name == current
        color = theme.ACCENT_LOW if on else theme.BACK
        imgui.push_style_color(imgui.Col_.button, theme.vec4(color))
        imgui.set_cursor_pos_y(4.0)
        if imgui.button(f"{title}##workspace", imgui.ImVec2(0.0, 22.0)):
            current = name
        imgui.pop_style_color()
    imgui.end_main_menu_bar()
    return current


def _draw_item(item: Item) -> None:
    if not item.label:
        imgui.separator()
    elif item.draw is not None:
        if imgui.begin_menu(item.label, item.enabled):
            item.draw()
            imgui.end_menu()
    elif imgui.menu_item(item.label, item.keys.partition(",")[0], item.ticked, item.enabled)[0]:
        assert item.act is not None
        item.act()
    if item.help and imgui.begin_item_tooltip():
        imgui.text_unformatted(item.help)
        imgui.end_tooltip()


def press_keys(menus: Menus) -> None:
    """Do what a key stands for that was pressed.

    Keys of a text that is typed are that text's, and those of a flight are the camera's.
    """
    if imgui.is_mouse_down(1):
        return
    for item in all_items(menus):
        if item.keys and item.act is not None and item.enabled:
            for keys in item.keys.split(","):
                if imgui.shortcut(chord(keys.strip()), imgui.InputFlags_.route_global):
                    item.act()
                    return


def all_items(menus: Menus) -> Iterator[Item]:
    """The items of all menus that do something."""
    for _, lines in menus:
        yield from (item for item in lines if item.label)


def chord(keys: str) -> int:
    """What imgui calls keys that are written as Ctrl+Shift+S."""
    found = 0
    for part in keys.split("+"):
        if part in _KEYS:
            found |= int(_KEYS[part])
        elif len(part) == 1 and part.isdigit():
            found |= int(getattr(imgui.Key, f"_{part}"))
        else:
            found |= int(getattr(imgui.Key, part.lower()))
    return found
