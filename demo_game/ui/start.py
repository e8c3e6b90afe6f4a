"""The start screen: a title over the picture of the place."""

from __future__ import annotations

import pyglet

from demo_game.ui.theme import TEXT, TEXT_DIM, WARM, Frame, Layer

LINE = "A rain area lies ahead. Walk in, shelter in the cabin, leave by the other side."
STRIPS = 14  # that the band fades out in, on either side
KEYS = "W A S D walk     mouse look     Shift run     Space jump     F1 help"


class StartView:
    """Title, one line of what this is, and how to begin."""

    def __init__(self, frame: Frame) -> None:
        self._layer = layer = Layer(frame)
        px = frame.px
        band = px(246)
        base = round(frame.height * 0.5 - band / 2)
        # A dark band that fades out at both edges carries the text on any picture.
        strip = px(5)
        layer.add(_strip(layer, base, band, 1.0))
        for index in range(STRIPS):
            share = (1.0 - (index + 0.5) / STRIPS) ** 1.5
            layer.add(_strip(layer, base + band + index * strip, strip, share))
            layer.add(_strip(layer, base - (index + 1) * strip, strip, share))
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


def _strip(layer: Layer, y: float, height: float, share: float) -> object:
    return pyglet.shapes.Rectangle(
        0,
        y,
        layer.frame.width,
        height,
        color=(8, 12, 17, round(165 * share)),
        batch=layer.batch,
        group=layer.back,
    )
