"""The end of a letter: delivered, or ruined; and another one."""

from __future__ import annotations

from demo_game.letter import Letter
from demo_game.letter_words import end_texts
from demo_game.ui.band import add_band
from demo_game.ui.envelope import Envelope
from demo_game.ui.theme import TEXT, TEXT_DIM, WARM, Frame, Layer

ICON = 92.0  # units, width of the envelope


class EndView:
    """Envelope, title, what became of it, and how to go on."""

    def __init__(self, frame: Frame, letter: Letter) -> None:
        self._layer = layer = Layer(frame)
        px = frame.px
        base, middle = add_band(layer, 300), frame.width / 2
        title, line = end_texts(letter)
        icon = px(ICON)
        envelope = Envelope(
            layer, round(middle - icon / 2), base + px(232), icon, parent=layer.marks
        )
        envelope.show(letter.wetness)
        layer.text(title, middle, base + px(180), 46, bold=True, anchor_x="center", color=TEXT)
        layer.text(line, middle, base + px(122), 18, anchor_x="center", color=TEXT)
        layer.text(
            "Press Enter or click for another letter",
            middle,
            base + px(72),
            20,
            anchor_x="center",
            color=WARM,
            bold=True,
        )
        layer.text("Esc walks on", middle, base + px(28), 14, anchor_x="center", color=TEXT_DIM)

    def draw(self) -> None:
        """Draw it."""
        self._layer.draw()

    def delete(self) -> None:
        """Give the GPU memory back."""
        self._layer.delete()
