"""The help page on F1: what to do, and every key, in two columns."""

from __future__ import annotations

import pyglet

from demo_game.ui.theme import ACCENT, PADDING, SHADE, TEXT_DIM, Frame, Layer, Rect

LEFT = (
    ("W A S D, arrows", "walk"),
    ("mouse", "look"),
    ("Shift", "run"),
    ("Space", "jump"),
    ("F", "fly, and walk again"),
    ("Esc", "pause and settings"),
    ("F1", "this page"),
    ("F3", "readout"),
    ("M", "map"),
    ("F11", "full screen"),
    ("F12", "save a picture"),
    ("", ""),
    ("gamepad", "sticks walk and look, A jumps"),
)
RIGHT = (
    ("1", "clear"),
    ("2", "drizzle"),
    ("3  4", "light rain, moderate rain"),
    ("5", "heavy rain"),
    ("6  7", "cloudburst, sleet"),
    ("8  9", "light snow, heavy snow"),
    ("0  -", "blizzard, fog"),
    ("V  B", "whole weathers, on and back"),
    ("L", "lightning ahead"),
    ("C", "to storm, and back to clear"),
    ("[  ]", "less wind, more wind"),
    (",  .", "turn the wind"),
    ("T", "time of day"),
    ("N", "sound on and off"),
)
PURPOSE = (
    "Carry the letter from the table in the cabin to the mailbox at the end of the path, and keep",
    "it dry. Wait under the porch until the rain eases; trees keep the rain off, too.",
)
WIDTH = 860.0  # units
ROW = 30.0
HEAD = 78.0
PURPOSE_ROW = 24.0
GAP = 16.0  # between the purpose and the keys
FOOT = 50.0
KEY_WIDTH = 148.0
SIZE = 16.0
TOP = HEAD + PURPOSE_ROW * len(PURPOSE) + GAP  # of the keys


class HelpView:
    """A panel in the middle of the window."""

    def __init__(self, frame: Frame) -> None:
        self._layer = layer = Layer(frame)
        px = frame.px
        width, height = px(WIDTH), px(TOP + ROW * len(LEFT) + FOOT)
        x, y = round((frame.width - width) / 2), round((frame.height - height) / 2)
        self.panel = Rect(x, y, width, height)
        layer.add(
            pyglet.shapes.Rectangle(
                0, 0, frame.width, frame.height, color=SHADE, batch=layer.batch, group=layer.back
            )
        )
        layer.panel(self.panel)
        pad = px(PADDING * 2)
        layer.text("Help", x + pad, self.panel.top - px(HEAD * 0.52), 26, bold=True)
        for index, line in enumerate(PURPOSE):
            layer.text(line, x + pad, self.panel.top - px(HEAD + PURPOSE_ROW * index), SIZE)
        for column, rows in enumerate((LEFT, RIGHT)):
            start = x + pad + column * px(WIDTH / 2 - PADDING)
            key_width = KEY_WIDTH if column == 0 else KEY_WIDTH * 0.66
            for index, (key, meaning) in enumerate(rows):
                middle = self.panel.top - px(TOP + ROW * (index + 0.5))
                if key:
                    layer.text(key, start, middle, SIZE, color=ACCENT)
                    layer.text(meaning, start + px(key_width), middle, SIZE)
        layer.text("Esc or F1 goes back", x + pad, y + px(FOOT * 0.5), 13, color=TEXT_DIM)

    def draw(self) -> None:
        """Draw it."""
        self._layer.draw()

    def delete(self) -> None:
        """Give the GPU memory back."""
        self._layer.delete()
