"""A dark band across the picture that fades out at both edges: text on it is legible anywhere."""

from __future__ import annotations

import pyglet

from demo_game.ui.theme import Layer

STRIPS = 14  # that it fades out in, on either side
STRIP = 5.0  # units


def add_band(layer: Layer, height: float) -> float:
    """Put a band of so many units in the window's middle; returns its lower edge in px."""
    frame = layer.frame
    band, strip = frame.px(height), frame.px(STRIP)
    base = float(round(frame.height * 0.5 - band / 2))
    _strip(layer, base, band, 1.0)
    for index in range(STRIPS):
        share = (1.0 - (index + 0.5) / STRIPS) ** 1.5
        _strip(layer, base + band + index * strip, strip, share)
        _strip(layer, base - (index + 1) * strip, strip, share)
    return base


def _strip(layer: Layer, y: float, height: float, share: float) -> None:
    layer.add(
        pyglet.shapes.Rectangle(
            0,
            y,
            layer.frame.width,
            height,
            color=(8, 12, 17, round(165 * share)),
            batch=layer.batch,
            group=layer.back,
        )
    )
