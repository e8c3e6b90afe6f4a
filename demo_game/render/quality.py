"""What each quality level of the scene costs."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Quality:
    """Numbers that trade picture for time."""

    shadow_size: int  # texels
    sky_size: int  # texels
    sky_rows: int  # of the sky's map painted a frame
    grass_reach: float  # m
    near_trees: float  # m, up to which trees have all their leaves
    middle_trees: float  # m, up to which they have some
    far_trees: float  # m, beyond which they are but silhouettes
    mirror: int  # the pond's mirror is the picture's size divided by this; 0: sky only


LEVELS = {
    "low": Quality(1024, 512, 16, 14.0, 14.0, 60.0, 100.0, 0),
    "medium": Quality(2048, 768, 16, 24.0, 26.0, 75.0, 185.0, 4),
    "high": Quality(2048, 1024, 64, 40.0, 45.0, 150.0, 260.0, 2),
    "ultra": Quality(4096, 1536, 192, 55.0, 90.0, 300.0, 500.0, 1),
}


def level(name: str) -> Quality:
    """The numbers of a level; "auto" starts at medium. Raises KeyError for other names."""
    return LEVELS["medium" if name == "auto" else name]
