"""Widgets made from the table of fields: one line each for any field of any component."""

from __future__ import annotations

import math
from collections.abc import Callable, Iterator
from contextlib import contextmanager
from dataclasses import dataclass, replace
from typing import Any

from imgui_bundle import imgui

from weather_ecs.editor import theme
from weather_ecs.editor.document import Content, Document
from weather_ecs.editor.fields import Field, info
from weather_ecs.editor.view_bar import tip_of_last

LABEL = 0.40  # of a row's width
_WIDE = 300.0  # highest over lowest from which a slider is logarithmic
_LOG = imgui.SliderFlags_.logarithmic
_ROUND = imgui.SliderFlags_.no_round_to_format


@dataclass(frozen=True, slots=True)
class Bound:
    """A component of the document, and how to get a content with another in its place."""

    document: Document
    part: Any  # a component
    put: Callable[[Any], Content]
    key: tuple[Any, ...]  # where it is: what merges the changes of a drag
    what: str  # as Undo calls it

    def set(self, name: str, label: str, **values: Any) -> bool:
        """Give it other values; whether they were taken."""
        return self.document.try_apply(
            f"{self.what}: {label[:1].lower()}{label[1:]}",
            lambda: self.put(replace(self.part, **values)),
            merge=(*self.key, name),
        )


def rows(bound: Bound, *names: str) -> None:
    """A line for each of these fields."""
    for name in names:
        row(bound, name)


def row(bound: Bound, name: str, label: str | None = None, unit: str | None = None) -> None:
    """The line of a field: the widget follows from what the field may be."""
    kind: Any = type(bound.part)
    known = info(kind, name)
    value = getattr(bound.part, name)
    title = label or known.label
    with line(bound, name, title, known):
        if known.limits.optional:
            _optional(bound, known, title, value)
        elif known.limits.kind == "flag":
            changed, on = imgui.checkbox("##value", value)
            take(bound, name, title, changed, on)
        elif known.limits.kind == "choice":
            choices = list(known.limits.choices)
            changed, index = imgui.combo("##value", choices.index(value), choices)
            take(bound, name, title, changed, choices[index])
        elif known.limits.kind == "integer":
            low, high = (int(each) for each in known.soft)
            changed, whole = imgui.slider_int("##value", min(value, 2**31 - 1), low, high)
            take(bound, name, title, changed, whole)
        elif known.limits.size > 1:
            _several(bound, known, title, value)
        else:
            changed, now = slider(value, known, unit)
            take(bound, name, title, changed, now)


def slider(value: float, known: Field, unit: str | None = None) -> tuple[bool, float]:
    """A number by a slider over its usual range; typed after Ctrl+click it may go beyond."""
    low, high = known.soft
    if known.unit == "rad":
        changed, now = imgui.slider_float(
            "##value", math.degrees(value), math.degrees(low), math.degrees(high), "%.0f°", _ROUND
        )
        return changed, tidy(math.radians(now))
    least = low if low > 0.0 else 0.01
    wide = low >= 0.0 and high / least >= _WIDE and high > 100.0
    shown = format_of(high - low, known.unit if unit is None else unit)
    flags = (_LOG if wide else 0) | _ROUND
    changed, now = imgui.slider_float("##value", value, low, high, shown, flags)
    return changed, tidy(now)


def format_of(span: float, unit: str) -> str:
    """How a number of such a range is written."""
    digits = 2 if span <= 4.0 else 1 if span <= 200.0 else 0
    return f"%.{digits}f" + (f" {unit}".replace("%", "%%") if unit and unit != "°" else unit)


def tidy(value: float) -> float:
    """A number as somebody would have typed it: the widgets' have seven digits, and noise."""
    if value == 0.0 or not math.isfinite(value):
        return value
    return round(value, 4 - math.floor(math.log10(abs(value))))


def take(bound: Bound, name: str, label: str, changed: bool, value: Any) -> None:
    """Put what the widget just made into the document; a drag that ends is one step of undo."""
    if changed:
        bound.set(name, label, **{name: value})
    # A choice from a list, or a tick, is a gesture of its own; a drag lasts as long as it is held.
    if imgui.is_item_deactivated() or (changed and not imgui.is_item_active()):
        bound.document.end_gesture()


@contextmanager
def line(bound: Bound, name: str, label: str, known: Field | None = None) -> Iterator[None]:
    """A label, and the widget that is made inside; what was refused stands below, in red."""
    tip = "" if known is None else known.tooltip()
    problem = bound.document.problem_at((*bound.key, name))
    imgui.push_id("/".join(map(str, (*bound.key, name))))
    caption(label, tip)
    if problem is not None:
        imgui.push_style_color(imgui.Col_.border, theme.vec4(theme.BAD))
        imgui.push_style_var(imgui.StyleVar_.frame_border_size, 1.5)
    yield
    if problem is not None:
        imgui.pop_style_var()
        imgui.pop_style_color()
    if tip:
        tip_of_last(tip)
    imgui.pop_id()
    if problem is not None:
        imgui.push_style_color(imgui.Col_.text, theme.vec4(theme.BAD))
        imgui.text_wrapped(problem)
        imgui.pop_style_color()


def caption(label: str, tip: str = "", share: float = LABEL) -> None:
    """A row's label; what follows stands beside it and fills the row."""
    start, width = imgui.get_cursor_pos_x(), imgui.get_content_region_avail().x
    imgui.align_text_to_frame_padding()
    imgui.text_colored(theme.vec4(theme.LABEL), label)
    if tip:
        tip_of_last(tip)
    imgui.same_line(start + share * width)
    imgui.set_next_item_width(-1.0)


def _several(bound: Bound, known: Field, title: str, value: tuple[float, ...]) -> None:
    """Two or three numbers, dragged."""
    span = known.soft[1] - known.soft[0]
    low, high = known.limits.low, known.limits.high
    step = span / 1000.0 if math.isfinite(span) else 1.0
    ends = (low, high) if max(abs(low), abs(high)) < 1e9 else (0.0, 0.0)
    shown = format_of(span, "").replace(".0f", ".0f")
    drag = imgui.drag_float2 if len(value) == 2 else imgui.drag_float3
    changed, now = drag("##value", [*map(float, value)], step, *ends, shown, _ROUND)
    take(bound, known.name, title, changed, tuple(map(tidy, now)))


def _optional(bound: Bound, known: Field, title: str, value: Any) -> None:
    """A box for whether there is a value, and the value."""
    changed, there = imgui.checkbox("##there", value is not None)
    start = (0.5, 0.5, 0.5) if known.limits.size == 3 else sum(known.soft) / 2.0
    take(bound, known.name, title, changed, start if there else None)
    imgui.same_line(0.0, 4.0)
    imgui.set_next_item_width(-1.0)
    if value is None:
        imgui.text_disabled("by the weather")
    elif known.limits.size == 3:
        changed, color = imgui.color_edit3("##value", list(value), imgui.ColorEditFlags_.float)
        take(bound, known.name, title, changed, tuple(map(tidy, color)))
    else:
        changed, now = slider(value, known)
        take(bound, known.name, title, changed, now)
