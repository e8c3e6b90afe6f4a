"""Headings as people say them."""

from __future__ import annotations

import math

POINTS = (
    "N", "NNE", "NE", "ENE", "E", "ESE", "SE", "SSE",
    "S", "SSW", "SW", "WSW", "W", "WNW", "NW", "NNW",
)  # fmt: skip


def bearing(heading: float) -> float:
    """Degrees from -z (north) over +x (east) of a heading in rad, counter-clockwise from +x."""
    return (90.0 - math.degrees(heading)) % 360.0


def compass(heading: float) -> str:
    """The point of the compass nearest to a heading."""
    return POINTS[round(bearing(heading) / 22.5) % 16]
