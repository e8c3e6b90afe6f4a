"""The letter at the lower left: how wet it is, and whether it gets wetter."""

from __future__ import annotations

import pyglet

from demo_game.letter import Letter, State
from demo_game.letter_words import Tone, words
from demo_game.ui.envelope import ASPECT, Envelope
from demo_game.ui.theme import (
    ACCENT,
    MARGIN,
    PADDING,
    TEXT,
    TEXT_DIM,
    WARM,
    Frame,
    Layer,
    Rect,
    Rgba,
)

WIDTH, HEIGHT = 270.0, 66.0  # units
ICON = 56.0
BAR = 8.0
SIZE = 15.0
TROUGH: Rgba = (255, 255, 255, 38)
DANGER: Rgba = (238, 104, 84, 255)
COLORS = {
    Tone.PLAIN: TEXT,
    Tone.DIM: TEXT_DIM,
    Tone.GOOD: ACCENT,
    Tone.WARNING: WARM,
    Tone.BAD: DANGER,
}


class LetterView:
    """A panel with the letter, a bar, and a word."""

    def __init__(self, frame: Frame) -> None:
        self._layer = layer = Layer(frame)
        px = frame.px
        self.panel = panel = Rect(px(MARGIN), px(MARGIN), px(WIDTH), px(HEIGHT))
        layer.panel(panel)
        icon = px(ICON)
        left = panel.x + px(PADDING)
        below = round(panel.y + (panel.height - icon * ASPECT) / 2)
        self._envelope = Envelope(layer, left, below, icon, layer.marks)
        self._x = left + icon + px(PADDING)
        self._words = layer.text("", self._x, panel.top - px(23), SIZE)
        self._length = panel.right - px(PADDING) - self._x
        bar = self._x, panel.y + px(17), self._length, max(px(BAR), 4.0)
        self._bar = [
            layer.add(pyglet.shapes.Rectangle(*bar, color=color, batch=layer.batch, group=group))
            for color, group in ((TROUGH, layer.marks), (ACCENT, layer.front))
        ]
        self._shown: tuple[int, Rgba] | None = None

    def show(self, letter: Letter) -> None:
        """Set what is seen."""
        self._envelope.show(letter.wetness, faint=letter.state is State.LYING)
        text, tone = words(letter)
        self._words.set(text, COLORS[tone])
        filled = round(self._length * letter.wetness)
        color = bar_color(letter.wetness)
        if (filled, color) != self._shown:
            self._shown = filled, color
            self._bar[1].width = filled
            self._bar[1].color = color
            self._bar[1].visible = filled > 0

    def draw(self) -> None:
        """Draw it."""
        self._layer.draw()

    def delete(self) -> None:
        """Give the GPU memory back."""
        self._layer.delete()


def bar_color(wetness: float) -> Rgba:
    """Blue, then amber, then red."""
    return ACCENT if wetness < 0.45 else WARM if wetness < 0.75 else DANGER
