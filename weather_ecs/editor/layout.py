"""Where the parts of the window stand: fixed, and the same share of any size."""

from __future__ import annotations

from typing import NamedTuple

from weather_ecs.editor.panels import Place

GAP = 4.0  # pixels between the parts
STATUS = 26.0  # pixels, height of the line below


class Box(NamedTuple):
    """A rectangle of the window, pixels from its upper left corner."""

    x: float
    y: float
    width: float
    height: float


def boxes(width: float, height: float, top: float, *, below: bool) -> dict[str, Box]:
    """The parts by their names: left, right, view, below and status.

    top: height of the bar above; below: whether there is anything under the view.
    """
    side = min(max(0.222 * width, 284.0), 380.0)
    side = min(side, 0.4 * width)
    high = max(height - top - STATUS - GAP, 1.0)
    middle = max(width - 2.0 * (side + GAP), 1.0)
    low = min(max(0.19 * height, 128.0), 190.0) if below else 0.0
    low = min(low, 0.5 * high)
    seen = max(high - (low + GAP if below else 0.0), 1.0)
    return {
        "left": Box(0.0, top, side, high),
        "right": Box(width - side, top, side, high),
        "view": Box(side + GAP, top, middle, seen),
        "below": Box(side + GAP, top + seen + GAP, middle, max(low, 1.0)),
        "status": Box(0.0, height - STATUS, width, STATUS),
    }


def part_of(place: Place) -> str:
    """The name of the part that a place means."""
    return place.value.split()[1]


def workspace_of(place: Place) -> str:
    """The workspace that a place belongs to."""
    return place.value.split()[0]
