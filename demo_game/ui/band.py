"""A dark band across the picture that fades out at both edges: text on it is legible anywhere."""

from __future__ import annotations

import pyglet

from demo_game.ui.theme import Layer

STRIPS = 80  # that it fades out in, on either side
STRIP = 0.88  # units; so thin that no single one is seen


def add_band(layer: Layer, height: float, at: float = 0.5) -> float:
    """Put a band of so many units across the window; returns its lower edge in px.

    at: where its middle is, a share of the window's height.
    """
    frame = layer.frame
    # Whole pixels: strips that share one would show as lines.
    band, strip = float(round(frame.px(height))), float(max(round(frame.px(STRIP)), 1))
    base = float(max(round(frame.height * at - band / 2), 0))
    _strip(layer, base, band, 1.0)
    for index in range(STRIPS):
        share = (1.0 - (index + 0.5) / STRIPS) ** 1.5
        _strip(layer, base + band + index * strip, strip, share)
        if base > index * strip:
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
