"""A letter in its envelope, the size of an icon or of a title picture."""

from __future__ import annotations

import pyglet
from pyglet.graphics import Group

from demo_game.ui.theme import Layer, Rgba

Rgb = tuple[int, int, int]

PAPER: Rgb = (233, 224, 200)
WET: Rgb = (150, 157, 160)  # paper full of water
FLAP, CREASE = 0.90, 0.66  # brightness of flap and creases against the paper
SEAL: Rgb = (176, 62, 50)
INK: Rgb = (38, 52, 104)
# Ink that comes through and runs down: (x, y, radius, length in shares of the width, from wetness)
BLOTS = (
    (0.26, 0.30, 0.040, 0.13, 0.25),
    (0.71, 0.22, 0.048, 0.10, 0.38),
    (0.41, 0.17, 0.034, 0.08, 0.50),
    (0.85, 0.40, 0.036, 0.20, 0.60),
    (0.13, 0.44, 0.042, 0.22, 0.68),
    (0.60, 0.30, 0.050, 0.19, 0.76),
    (0.32, 0.52, 0.044, 0.16, 0.84),
)
SOAKED = 2.0  # radii, the pale rim around a blot
ASPECT = 0.66  # height over width


class Envelope:
    """Seen from behind, with its flap and its seal."""

    def __init__(self, layer: Layer, x: float, y: float, width: float, parent: Group) -> None:
        """x, y: its lower left corner in px; width in px, its height is ASPECT of that."""
        height = width * ASPECT
        groups = (Group(order=k, parent=parent) for k in range(6))
        sheet, flap, soaked, blots, lines, seal = groups
        shapes, batch = pyglet.shapes, layer.batch
        middle, notch = (x + width / 2, y + height * 0.40), y + height
        line = max(1.0, width * 0.028)
        self._sheet = layer.add(
            shapes.Rectangle(x, y, width, height, color=PAPER, batch=batch, group=sheet)
        )
        self._flap = layer.add(
            shapes.Triangle(x, notch, x + width, notch, *middle, batch=batch, group=flap)
        )
        ends = ((x, notch), (x + width, notch), (x, y), (x + width, y))
        left, right = ((x + width * share, y + height * 0.5) for share in (0.4, 0.6))
        inner = (middle, middle, left, right)
        self._lines = [
            layer.add(shapes.Line(*a, *b, thickness=line, batch=batch, group=lines))
            for a, b in zip(ends, inner, strict=True)
        ]
        self._blots = []
        for a, b, radius, length, _ in BLOTS:
            r, at = radius * width, (x + a * width, y + b * width)
            end = at[0], at[1] - length * width
            self._blots.append(
                (
                    (shapes.Circle(*at, SOAKED * r, color=INK, batch=batch, group=soaked), 70),
                    (shapes.Line(*at, *end, 0.9 * r, color=INK, batch=batch, group=blots), 150),
                    (shapes.Circle(*end, 0.55 * r, color=INK, batch=batch, group=blots), 190),
                    (shapes.Circle(*at, r, color=INK, batch=batch, group=blots), 210),
                )
            )
        for shape, _ in (pair for blot in self._blots for pair in blot):
            layer.add(shape)
        layer.add(
            shapes.Circle(*middle, width * 0.085, segments=20, color=SEAL, batch=batch, group=seal)
        )
        self._shown: tuple[float, bool] | None = None
        self.show(0.0)

    def show(self, wetness: float, faint: bool = False) -> None:
        """Show how wet it is, 0 to 1; `faint` where it is not at hand."""
        wetness = round(wetness, 2)
        if (wetness, faint) == self._shown:
            return
        self._shown = wetness, faint
        paper = tuple(round(a + wetness * (b - a)) for a, b in zip(PAPER, WET, strict=True))
        opacity = 120 if faint else 255
        self._sheet.color = _shade(paper, 1.0, opacity)
        self._flap.color = _shade(paper, FLAP, opacity)
        for line in self._lines:
            line.color = _shade(paper, CREASE, opacity)
        for shapes, (*_, begin) in zip(self._blots, BLOTS, strict=True):
            share = min(max((wetness - begin) / 0.16, 0.0), 1.0)
            for shape, opacity in shapes:
                shape.opacity = round(opacity * share)


def _shade(color: tuple[int, ...], brightness: float, opacity: int) -> Rgba:
    red, green, blue = (round(value * brightness) for value in color)
    return red, green, blue, opacity
