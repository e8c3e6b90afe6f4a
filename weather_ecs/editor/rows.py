"""Rows of a panel: a label, a control, its tooltip, and what was refused, beside it."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any, NamedTuple

from imgui_bundle import imgui

from weather_ecs.editor import theme
from weather_ecs.editor.document import Content, Document
from weather_ecs.editor.fields import info
from weather_ecs.editor.view_bar import tip_of_last

LABEL = 0.42  # of a row's width

Put = Callable[[Any], Content]


class Thing(NamedTuple):
    """A component of the document, and how to get a content that has another in its place."""

    document: Document
    part: Any  # the component
    key: tuple[Any, ...]  # where it is, for merging
    put: Put

    def change(self, label: str, merge: tuple[Any, ...], **values: Any) -> bool:
        """Give it other values, as a step of undo; whether they were taken."""
        return self.document.try_apply(
            label, lambda: self.put(replace(self.part, **values)), merge=(*self.key, *merge)
        )


def drag(thing: Thing, label: str, field: str, *, speed: float = 0.0, fmt: str = "") -> None:
    """A number without ends that matter: dragged, or typed after a click."""
    value = float(getattr(thing.part, field))
    step = speed or max(abs(value) * 0.01, 0.05)
    with _row(thing, label, (field,)):
        changed, now = imgui.drag_float(
            f"##{field}", value, step, 0.0, 0.0, fmt or _format(thing, field)
        )
        _take(thing, label, changed, (field,), {field: round(now, 4)})


def slide(thing: Thing, label: str, field: str, fmt: str = "") -> None:
    """A number between two ends."""
    low, high = info(type(thing.part), field).soft
    with _row(thing, label, (field,)):
        value = float(getattr(thing.part, field))
        changed, now = imgui.slider_float(
            f"##{field}", value, low, high, fmt or _format(thing, field)
        )
        _take(thing, label, changed, (field,), {field: round(now, 4)})


def drag_whole(thing: Thing, label: str, field: str, *, speed: float = 0.1) -> None:
    """A whole number."""
    with _row(thing, label, (field,)):
        changed, now = imgui.drag_int(
            f"##{field}", min(getattr(thing.part, field), 2**31 - 1), speed
        )
        _take(thing, label, changed, (field,), {field: now})


def drag_pair(thing: Thing, label: str, low: str, high: str, *, whole: bool = False) -> None:
    """A least and a greatest value in two fields; neither passes the other."""
    least, most = getattr(thing.part, low), getattr(thing.part, high)
    with _row(thing, label, (low, high)):
        name, shown = f"##{low}", _format(thing, low)
        changed: bool
        a: float
        b: float
        if whole:
            changed, a, b = imgui.drag_int_range2(name, least, most, 0.05, 0, 0, "%d", "%d")
        else:
            step = max(0.01 * most, 0.05)
            changed, a, b = imgui.drag_float_range2(name, least, most, step, 0.0, 0.0, shown, shown)
            a, b = round(a, 3), round(b, 3)
        _take(thing, label, changed, (low, high), {low: a, high: b})


def drag_range(thing: Thing, label: str, field: str) -> None:
    """A field of two numbers, the least and the greatest."""
    least, most = getattr(thing.part, field)
    with _row(thing, label, (field,)):
        step, shown = max(0.01 * abs(most), 1.0), _format(thing, field)
        changed, a, b = imgui.drag_float_range2(
            f"##{field}", least, most, step, 0.0, 0.0, shown, shown
        )
        _take(thing, label, changed, (field,), {field: (round(a, 3), round(b, 3))})


def drag_place(thing: Thing, label: str, field: str) -> None:
    """Three numbers of metres."""
    value = [float(each) for each in getattr(thing.part, field)]
    with _row(thing, label, (field,), share=0.26):
        step = max(0.005 * max(map(abs, value)), 0.5)
        changed, now = imgui.drag_float3(f"##{field}", value, step, 0.0, 0.0, "%.0f")
        _take(thing, label, changed, (field,), {field: tuple(round(each, 2) for each in now)})


def drag_open(thing: Thing, label: str, field: str, usual: float) -> None:
    """A number that may be infinite: a box beside it says so."""
    value = float(getattr(thing.part, field))
    with _row(thing, label, (field,)):
        endless = math.isinf(value)
        wide = imgui.get_content_region_avail().x - imgui.get_frame_height() - 24.0
        imgui.set_next_item_width(max(wide, 40.0))
        imgui.begin_disabled(endless)
        step = 1.0 if endless else max(0.01 * value, 0.5)
        changed, now = imgui.drag_float(f"##{field}", value, step, 0.0, 0.0, _format(thing, field))
        imgui.end_disabled()
        _take(thing, label, changed, (field,), {field: round(now, 3)})
        imgui.same_line(0.0, 4.0)
        toggled, endless = imgui.checkbox(f"∞##{field}", endless)
        _take(thing, label, toggled, (field,), {field: math.inf if endless else usual})


def check(thing: Thing, label: str, field: str) -> None:
    """Yes or no."""
    with _row(thing, label, (field,)):
        changed, now = imgui.checkbox(f"##{field}", getattr(thing.part, field))
        _take(thing, label, changed, (field,), {field: now})


@contextmanager
def _row(thing: Thing, label: str, fields: tuple[str, ...], share: float = LABEL) -> Iterator[None]:
    """The label, and the control in what is left of the line; what was refused stands below."""
    width = imgui.get_content_region_avail().x
    start = imgui.get_cursor_pos_x()
    imgui.align_text_to_frame_padding()
    imgui.text_colored(theme.vec4(theme.LABEL), label)
    known = [info(type(thing.part), each) for each in fields]
    tip = known[0].tooltip()
    if len(known) > 1:
        tip = "\n".join(f"{each.label}: {each.tooltip()}" for each in known)
    tip_of_last(tip)
    imgui.same_line(start + share * width)
    imgui.set_next_item_width(-1.0)
    problem = thing.document.problem_at((*thing.key, *fields))
    if problem is not None:
        imgui.push_style_color(imgui.Col_.border, theme.vec4(theme.BAD))
        imgui.push_style_var(imgui.StyleVar_.frame_border_size, 1.5)
    imgui.push_id(str(thing.key))
    yield
    imgui.pop_id()
    tip_of_last(tip)
    if problem is not None:
        imgui.pop_style_var()
        imgui.pop_style_color()
    show_problem(thing.document, (*thing.key, *fields))


def section(title: str, *, opened: bool = True) -> bool:
    """A heading that opens and closes what is below it; whether it is open.

    opened: whether it is so at first.
    """
    flags = imgui.TreeNodeFlags_.default_open if opened else 0
    imgui.push_style_color(imgui.Col_.header, theme.vec4(theme.RAISED))
    is_open = imgui.collapsing_header(title, flags)
    imgui.pop_style_color()
    return bool(is_open)


def show_problem(document: Document, merge: tuple[Any, ...]) -> None:
    """Why the last change under this key was refused, if it was."""
    problem = document.problem_at(merge)
    if problem is not None:
        imgui.push_style_color(imgui.Col_.text, theme.vec4(theme.BAD))
        imgui.text_wrapped(problem)
        imgui.pop_style_color()


def _format(thing: Thing, field: str) -> str:
    """How a value is written: shares with two digits, others with what they have, and the unit."""
    known = info(type(thing.part), field)
    if known.unit == "°":
        return "%.0f°"
    number = "%.2f" if not known.unit else "%g"
    return f"{number} {known.unit}".rstrip().replace("%%", "%")


def _take(
    thing: Thing, label: str, changed: bool, merge: tuple[str, ...], values: dict[str, Any]
) -> None:
    if changed:
        thing.change(label, merge, **values)
    if imgui.is_item_deactivated():
        thing.document.end_gesture()
