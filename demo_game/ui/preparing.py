"""What is seen while the place is being built."""

from __future__ import annotations

import pyglet

from demo_game.ui.theme import TEXT, TEXT_DIM, Frame, Layer

GROUND = (16, 21, 28, 255)


class PreparingView:
    """The title and a line with dots that come and go."""

    def __init__(self, frame: Frame) -> None:
        self._layer = layer = Layer(frame)
        middle, height = frame.width / 2, frame.height / 2
        layer.add(
            pyglet.shapes.Rectangle(
                0, 0, frame.width, frame.height, color=GROUND, batch=layer.batch, group=layer.back
            )
        )
        layer.text(
            "The Walk", middle, height + frame.px(65), 58, bold=True, anchor_x="center", color=TEXT
        )
        left = middle - frame.px(78)
        self._line = layer.text("", left, height + frame.px(3), 18, color=TEXT_DIM)

    def draw(self, seconds: float) -> None:
        """Draw it as it is after so many seconds."""
        self._line.set("Building the place" + "." * (int(seconds * 2) % 4))
        self._layer.draw()

    def delete(self) -> None:
        """Give the GPU memory back."""
        self._layer.delete()
