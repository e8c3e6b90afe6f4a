"""Amounts of cloud as weather reports have them, and how many clouds cover so much of the sky."""

from __future__ import annotations

import math

# km2 that one cloud of the package's own models shades with the sun in the zenith: the union of
# the ellipses in its seeds' outlines, the mean of six clouds.
FOOTPRINTS = {
    "cirrus": 4.63,
    "cirrostratus": 141.0,
    "cirrocumulus": 1.23,
    "altostratus": 60.7,
    "altocumulus": 1.67,
    "nimbostratus": 46.2,
    "stratocumulus": 3.32,
    "stratus": 20.9,
    "cumulus": 0.622,
    "cumulonimbus": 61.2,
    "fractostratus": 0.53,
}
CLOSED = 0.985  # share from which the sky counts as closed, 8 oktas


def share_of(oktas: float) -> float:
    """Share of the sky, 0 to 1, of so many eighths."""
    return min(max(oktas / 8.0, 0.0), 1.0)


def count_for(oktas: float, footprint: float, area: float) -> int:
    """Clouds of a footprint that cover so many oktas of an area; both in km2.

    Places by chance: of what n clouds of the share p of the area each leave open, (1 - p)^n.
    """
    share = min(share_of(oktas), CLOSED)
    if share <= 0.0:
        return 0
    return max(round(-math.log(1.0 - share) * area / footprint), 1)
