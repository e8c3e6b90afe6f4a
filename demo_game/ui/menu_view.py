"""Draws a menu, the start screen, and says which row the mouse is on."""

from __future__ import annotations

import pyglet

from demo_game.ui.menu import Menu
from demo_game.ui.theme import (
    ACCENT,
    PADDING,
    ROW_CHOSEN,
    SHADE,
    TEXT,
    TEXT_DIM,
    Frame,
    Layer,
    Rect,
    Text,
)

WIDTH = 460.0  # units
ROW = 40.0
HEAD = 74.0
FOOT = 44.0
VALUE_WIDTH = 170.0  # of the part of a row that holds its value


class MenuView:
    """A menu in the middle of the window."""

    def __init__(self, frame: Frame, menu: Menu) -> None:
        self.menu = menu
        self._frame = frame
        self._layer = layer = Layer(frame)
        px = frame.px
        width, height = px(WIDTH), px(HEAD + ROW * len(menu.items) + FOOT)
        left = round((frame.width - width) / 2)
        self.panel = Rect(left, round((frame.height - height) / 2), width, height)
        layer.add(
            pyglet.shapes.Rectangle(
                0, 0, frame.width, frame.height, color=SHADE, batch=layer.batch, group=layer.back
            )
        )
        layer.panel(self.panel)
        pad = px(PADDING * 2)
        layer.text(menu.title, left + pad, self.panel.top - px(HEAD * 0.52), 26, bold=True)
        layer.text(
            "↑ ↓ choose    ← → change    Esc resume",
            left + pad,
            self.panel.y + px(FOOT * 0.5),
            12,
            color=TEXT_DIM,
        )
        self._rows: list[Rect] = []
        self._labels: list[Text] = []
        self._values: list[Text | None] = []
        for index, item in enumerate(menu.items):
            top = self.panel.top - px(HEAD + ROW * index)
            row = Rect(left + px(PADDING), top - px(ROW), width - px(2 * PADDING), px(ROW))
            self._rows.append(row)
            middle = row.y + row.height / 2
            self._labels.append(layer.text(item.label, left + pad, middle, 17))
            value = None
            if item.value is not None:
                center = row.right - px(VALUE_WIDTH / 2)
                value = layer.text("", center, middle, 17, anchor_x="center")
                for mark, x in (
                    ("‹", row.right - px(VALUE_WIDTH - 10)),
                    ("›", row.right - px(10)),
                ):
                    layer.text(mark, x, middle, 19, anchor_x="center", color=TEXT_DIM)
            self._values.append(value)
        self._mark = layer.add(
            pyglet.shapes.RoundedRectangle(
                0,
                0,
                self._rows[0].width,
                self._rows[0].height,
                px(7),
                segments=8,
                color=ROW_CHOSEN,
                batch=layer.batch,
                group=layer.marks,
            )
        )

    def row_at(self, x: float, y: float) -> int | None:
        """The row under the mouse."""
        for index, row in enumerate(self._rows):
            if row.holds(x, y):
                return index
        return None

    def side_at(self, x: float) -> int:
        """-1 left of a row's value, +1 elsewhere."""
        row = self._rows[0]
        middle = row.right - self._frame.px(VALUE_WIDTH / 2)
        return -1 if row.right - self._frame.px(VALUE_WIDTH) <= x < middle else 1

    def draw(self) -> None:
        """Draw it as it stands."""
        for index, item in enumerate(self.menu.items):
            chosen = index == self.menu.chosen
            self._labels[index].set(item.label, ACCENT if chosen else TEXT)
            value = self._values[index]
            if value is not None and item.value is not None:
                value.set(item.value(), ACCENT if chosen else TEXT)
        row = self._rows[self.menu.chosen]
        if self._mark.position != (row.x, row.y):
            self._mark.position = (row.x, row.y)
        self._layer.draw()

    def delete(self) -> None:
        """Give the GPU memory back."""
        self._layer.delete()
