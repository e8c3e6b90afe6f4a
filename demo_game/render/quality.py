"""What each quality level of the scene costs."""

from __future__ import annotations

from dataclasses import dataclass

from weather_ecs.errors import InvalidValueError


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


LEVELS = {
    "low": Quality(1024, 512, 16, 14.0, 14.0, 60.0, 100.0),
    "medium": Quality(2048, 768, 16, 16.0, 21.0, 60.0, 150.0),
    "high": Quality(2048, 1024, 64, 40.0, 45.0, 150.0, 260.0),
    "ultra": Quality(4096, 1536, 192, 55.0, 90.0, 300.0, 500.0),
}


def level(name: str) -> Quality:
    """The numbers of a level; "auto" is medium. Raises InvalidValueError for other names."""
    if name != "auto" and name not in LEVELS:
        raise InvalidValueError("quality", name, ", ".join([*LEVELS, "auto"]))
    return LEVELS["medium" if name == "auto" else name]
