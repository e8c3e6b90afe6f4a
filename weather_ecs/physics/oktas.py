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
# Times as much of the dome as of the ground: at a slant one sees their sides as well. From the
# share of the sky above 5 degrees that pictures all round show covered, for 1.5 to 6 oktas of them.
SLANT = {"cumulus": 2.1, "altocumulus": 1.5, "cirrus": 1.8}
CLOSED = 0.985  # share from which the sky counts as closed, 8 oktas


def shown_footprint(model: str) -> float:
    """km2 of sky that one cloud takes, as an observer counts who looks all round."""
    return FOOTPRINTS[model] * SLANT.get(model, 1.0)


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
