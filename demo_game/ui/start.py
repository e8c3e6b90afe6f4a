"""The start screen: a title under the picture of the place."""

from __future__ import annotations

from demo_game.ui.band import add_band
from demo_game.ui.theme import TEXT, TEXT_DIM, WARM, Frame, Layer

LINE = "Carry a letter from the cabin to the mailbox at the end of the path. Keep it dry."
KEYS = "W A S D walk     mouse look     Shift run     Space jump     M map     F1 help"
HEIGHT, AT = 246.0, 0.16  # units; share of the window's height: the shower ahead stays in view


class StartView:
    """Title, one line of what this is, and how to begin."""

    def __init__(self, frame: Frame) -> None:
        self._layer = layer = Layer(frame)
        px = frame.px
        base = add_band(layer, HEIGHT, AT)
        middle = frame.width / 2
        layer.text("The Walk", middle, base + px(188), 58, bold=True, anchor_x="center", color=TEXT)
        layer.text(LINE, middle, base + px(126), 18, anchor_x="center", color=TEXT)
        layer.text(
            "Press Enter or click to begin",
            middle,
            base + px(74),
            20,
            anchor_x="center",
            color=WARM,
            bold=True,
        )
        layer.text(KEYS, middle, base + px(26), 14, anchor_x="center", color=TEXT_DIM)

    def draw(self) -> None:
        """Draw it."""
        self._layer.draw()

    def delete(self) -> None:
        """Give the GPU memory back."""
        self._layer.delete()
