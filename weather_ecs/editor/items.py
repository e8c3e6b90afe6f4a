"""A list of things to choose from, with New, Copy and Delete below it."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

from imgui_bundle import imgui

from weather_ecs.editor import theme
from weather_ecs.editor.view_bar import tip_of_last


def choose(name: str, items: Sequence[tuple[str, str]], index: int, rows: float) -> int:
    """A list of (text, remark) of so many rows' height; the index that is chosen now.

    `-1` where nothing was there to choose. A list that grows past its height scrolls.
    """
    high = rows * imgui.get_text_line_height_with_spacing() + 8.0
    imgui.push_style_color(imgui.Col_.child_bg, theme.vec4(theme.WELL))
    opened = imgui.begin_child(name, imgui.ImVec2(0.0, high), imgui.ChildFlags_.borders)
    imgui.pop_style_color()
    if opened:
        clipper = imgui.ListClipper()
        clipper.begin(len(items))
        while clipper.step():
            for row in range(clipper.display_start, clipper.display_end):
                text, remark = items[row]
                imgui.push_id(row)
                if imgui.selectable(text, row == index)[0]:
                    index = row
                if remark:
                    imgui.same_line()
                    wide = imgui.calc_text_size(remark).x
                    left = imgui.get_content_region_avail().x - wide
                    if left > 4.0:
                        imgui.set_cursor_pos_x(imgui.get_cursor_pos_x() + left)
                        imgui.text_disabled(remark)
                    else:
                        imgui.new_line()
                imgui.pop_id()
    imgui.end_child()
    return index


@contextmanager
def well(name: str, count: int) -> Iterator[None]:
    """A frame for a list of so many lines that are drawn in it; of more than eight it scrolls."""
    high = min(max(count, 1), 8) * imgui.get_text_line_height_with_spacing() + 13.0
    imgui.push_style_color(imgui.Col_.child_bg, theme.vec4(theme.WELL))
    imgui.begin_child(name, imgui.ImVec2(0.0, high), imgui.ChildFlags_.borders)
    imgui.pop_style_color()
    yield
    imgui.end_child()


def lines_for(rows: float, least: float) -> float:
    """Lines of a list that leave room for so many rows of widgets below it."""
    room = imgui.get_content_region_avail().y - rows * imgui.get_frame_height_with_spacing() - 8.0
    return max(min(float(room // imgui.get_text_line_height_with_spacing()), 14.0), least)


def clicked_into() -> bool:
    """Whether the mouse was pressed in the window that is being drawn, or in a part of it."""
    kinds = imgui.HoveredFlags_
    over = imgui.is_window_hovered(kinds.child_windows | kinds.allow_when_blocked_by_active_item)
    return bool(over and imgui.is_mouse_clicked(0))


def buttons(of: str, *labels: tuple[str, bool, str]) -> str | None:
    """Buttons of equal width on a line: label, whether it can be pressed, tip; the one pressed.

    of: what they are about, which tells their ids from others'.
    """
    gap = 4.0
    wide = (imgui.get_content_region_avail().x - gap * (len(labels) - 1)) / len(labels)
    pressed = None
    for number, (label, enabled, tip) in enumerate(labels):
        if number:
            imgui.same_line(0.0, gap)
        imgui.begin_disabled(not enabled)
        if imgui.button(f"{label}##{of}", imgui.ImVec2(wide, 0.0)):
            pressed = label
        imgui.end_disabled()
        if tip:
            tip_of_last(tip)
    return pressed


def edit_buttons(of: str, any_there: bool) -> str | None:
    """New, Copy and Delete; the one that was pressed."""
    names = (("New", True, ""), ("Copy", any_there, ""), ("Delete", any_there, ""))
    return buttons(of, *names)
