"""What the lists of the panels have in common."""

from __future__ import annotations

from imgui_bundle import imgui


def buttons(what: str, any_there: bool) -> str:
    """New, copy and delete in one line; the one that was pressed, or nothing."""
    pressed = ""
    for name in ("New", "Copy", "Delete"):
        imgui.begin_disabled(name != "New" and not any_there)
        if imgui.button(f"{name}##{what}"):
            pressed = name
        imgui.end_disabled()
        imgui.same_line(0.0, 4.0)
    imgui.new_line()
    return pressed
