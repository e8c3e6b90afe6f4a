"""What the player hears where the player is, from what the weather says of it."""

from __future__ import annotations

import math
from typing import Any, NamedTuple, Protocol

from demo_game.place import Place

ABOVE = 60.0  # m, over every roof and below the clouds' rain
EAVES = 0.6  # m that a roof reaches beyond floor and porch


class Walk(Protocol):
    """What is asked of the game."""

    place: Place
    weather: Any
    pose: Any


class Listened(NamedTuple):
    """Arguments of `Soundscape.update`."""

    rain_rate: float  # mm/h
    leaves: float  # 0 or 1
    roof: float  # 0 or 1
    wind_speed: float  # m/s
    snow_depth: float  # m


def listen(game: Walk) -> Listened:
    """What is heard at the player's eyes."""
    x, y, z = game.pose.eye
    here, above = game.weather.sample((x, y, z)), game.weather.sample((x, ABOVE, z))
    boards = here.sheltered and under_boards(game.place, x, z)
    wind = math.hypot(here.wind[0], here.wind[2])
    return Listened(
        above.rain_rate,
        float(here.sheltered and not boards),
        float(boards),
        wind,
        above.snow_depth,
    )


def under_boards(place: Place, x: float, z: float) -> bool:
    """Whether (x, z) is under the roof of the cabin or of its porch."""
    for block in place.blocks:
        if block.walkable:
            at = place.cabin_origin + block.center
            near = abs(x - at[0]) - block.size[0] / 2.0, abs(z - at[2]) - block.size[2] / 2.0
            if max(near) <= EAVES:
                return True
    return False
