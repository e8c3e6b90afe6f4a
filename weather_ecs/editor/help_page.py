"""The page of F1: mouse, keys, and how a cloud comes about."""

from __future__ import annotations

from collections.abc import Sequence

from imgui_bundle import imgui

from weather_ecs.editor import theme
from weather_ecs.editor.menus import Menus, all_items

_MOUSE = (
    ("Drag", "turn round the cloud"),
    ("Shift + drag, middle button", "move along the picture"),
    ("Wheel", "nearer, farther"),
    ("Right button", "look round; with W A S D Q E fly, Shift faster"),
    ("Double click", "the whole cloud in the picture"),
    ("Arrows and dots", "move and size the chosen seed; Ctrl: steps of 10 m"),
    ("Value: drag, or click and type", "change it; Esc while typing keeps it as it was"),
    ("A file dropped on the window", "opens it"),
)
_HIGH = 500.0  # pixels
_CLOUD = (
    "A cloud model has seeds: boxes in which billboards are placed at random.",
    "Roots grow from a seed: level by level they add seeds like it, in their direction and within"
    " their opening.",
    "One model gives any number of clouds: the random seed says which. The gallery shows some.",
    "A sky says how many clouds of which models stand in it; a layer holds skies from clear to"
    " storm; a climate runs from one state to another.",
    "What is saved is the file that games load: weather.load(path).",
)


def draw_help(menus: Menus, opened: bool) -> bool:
    """The page while it is open; whether it stays so."""
    name = "Keys and mouse###help"
    if not opened:
        return False
    if not imgui.is_popup_open(name):
        imgui.open_popup(name)
    size = imgui.get_io().display_size
    imgui.set_next_window_size(imgui.ImVec2(min(1140.0, 0.97 * size.x), min(_HIGH, 0.95 * size.y)))
    middle = imgui.ImVec2(0.5 * size.x, 0.5 * size.y)
    imgui.set_next_window_pos(middle, imgui.Cond_.always, imgui.ImVec2(0.5, 0.5))
    flags = imgui.WindowFlags_.no_resize | imgui.WindowFlags_.no_move
    shown, stays = imgui.begin_popup_modal(name, True, flags)
    if not shown:
        return False
    listed = [
        (item.keys, item.label.rpartition("###")[2]) for item in all_items(menus) if item.keys
    ]
    half = (len(listed) + 1) // 2
    imgui.push_style_var(imgui.StyleVar_.cell_padding, imgui.ImVec2(12.0, 2.0))
    shown = imgui.begin_table("page", 3, imgui.TableFlags_.sizing_stretch_prop)
    imgui.pop_style_var()
    if shown:
        for name, weight in (("mouse", 1.3), ("keys", 1.0), ("more", 1.0)):
            imgui.table_setup_column(name, imgui.TableColumnFlags_.width_stretch, weight)
        imgui.table_next_column()
        _pairs("Mouse", _MOUSE, 0.44)
        imgui.dummy(imgui.ImVec2(0.0, 4.0))
        imgui.separator_text("How a cloud comes about")
        for line in _CLOUD:
            imgui.push_style_color(imgui.Col_.text, theme.vec4(theme.LABEL))
            imgui.text_wrapped(line)
            imgui.pop_style_color()
        imgui.table_next_column()
        _pairs("Keys", listed[:half], 0.44)
        imgui.table_next_column()
        _pairs("More keys", listed[half:], 0.44)
        imgui.end_table()
    closes = any(imgui.is_key_pressed(key) for key in (imgui.Key.escape, imgui.Key.f1))
    if closes and not imgui.is_window_appearing():
        stays = False
    if not stays:
        imgui.close_current_popup()
    imgui.end_popup()
    return bool(stays)


def _pairs(title: str, pairs: Sequence[tuple[str, str]], share: float) -> None:
    """Two columns, the left one this share of the width."""
    imgui.separator_text(title)
    width = imgui.get_content_region_avail().x
    start = imgui.get_cursor_pos_x()
    for left, right in pairs:
        imgui.push_text_wrap_pos(start + share * width - 6.0)
        top = imgui.get_cursor_pos_y()
        imgui.text_unformatted(left)
        imgui.pop_text_wrap_pos()
        bottom = imgui.get_cursor_pos_y()
        imgui.set_cursor_pos(imgui.ImVec2(start + share * width, top))
        imgui.push_text_wrap_pos(start + width)
        imgui.push_style_color(imgui.Col_.text, theme.vec4(theme.LABEL))
        imgui.text_unformatted(right)
        imgui.pop_style_color()
        imgui.pop_text_wrap_pos()
        imgui.set_cursor_pos_y(max(bottom, imgui.get_cursor_pos_y()))
    imgui.dummy(imgui.ImVec2(0.0, 0.0))
