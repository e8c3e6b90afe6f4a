"""`Atmosphere`: the sky of a place at a time, and all the light that comes of it."""

from __future__ import annotations

from dataclasses import dataclass
from datetime import UTC, datetime
from typing import Any, ClassVar

from weather_ecs.components._base import Check, Component, Limits, flag, limited, number
from weather_ecs.errors import InvalidValueError

FIRST, LAST = -2208988800.0, 4102444799.0  # s since 1970: the years 1900 to 2099
_seconds = number(FIRST, LAST)
_TIME = "UTC of the years 1900 to 2099: text as 2025-06-21T12:00:00Z, or seconds since 1970"
_share = number(0.0, 1.0)


def _time(field: str, value: Any) -> float:
    """Seconds since 1970, of a number or of ISO 8601 text; without a zone it is UTC."""
    if not isinstance(value, str):
        return float(_seconds(field, value))
    try:
        moment = datetime.fromisoformat(value if len(value) < 64 else "")
        zoned = moment if moment.tzinfo is not None else moment.replace(tzinfo=UTC)
        return float(_seconds(field, zoned.timestamp()))
    except (ValueError, OverflowError):
        raise InvalidValueError(field, value, _TIME) from None


def _optional_share(field: str, value: Any) -> float | None:
    return None if value is None else float(_share(field, value))


@dataclass(eq=False, slots=True)
class Atmosphere(Component):
    """Sun, moon, stars and air over a place. The oldest entity's one counts.

    Where there is one it gives the light, and no `Sun` counts: the sun's direction and colour, the
    light of sky and ground, the colour of fog, what drops, water and clouds show. The world's +x
    is east and its -z north.
    """

    time: float | str = "2025-06-21T12:00:00Z"  # UTC, kept as seconds since 1970; 1900 to 2099
    latitude: float = 45.0  # degrees north, -90 to 90
    longitude: float = 0.0  # degrees east, -180 to 180
    speed: float = 1.0  # s of the sky in a second of weather, -1e6 to 1e6; 0 stops the sun
    turbidity: float = 2.2  # 1 clean air, 2 to 3 a clear day, to 10 thick haze
    overcast: float | None = None  # 0 to 1, share of the sky covered; None: by the climate's state
    exposure: float = 1.0  # factor on all light, 0 to 1000
    adaptation: float = 1.0  # 0 to 1, how far the eye gets used to the dark
    draw: bool = False  # the sky behind the game's scene, for games that have none of their own
    stars: float = 1.0  # factor on their light, 0 to 100
    disc: float = 1.5  # factor on the width of sun and moon, look only, 0.1 to 20
    halo: float | None = None  # 0 to 1, ring of 22 degrees; None: by the cirrostratus there is
    rainbow: float = 1.0  # factor on what rain and sun call for, 0 to 10

    checks: ClassVar[dict[str, Check]] = {
        "time": limited(_time, Limits("number", FIRST, LAST)),
        "latitude": number(-90.0, 90.0),
        "longitude": number(-180.0, 180.0),
        "speed": number(-1.0e6, 1.0e6),
        "turbidity": number(1.0, 10.0),
        "overcast": limited(_optional_share, Limits("number", 0.0, 1.0, optional=True)),
        "exposure": number(0.0, 1000.0),
        "adaptation": _share,
        "draw": flag(),
        "stars": number(0.0, 100.0),
        "disc": number(0.1, 20.0),
        "halo": limited(_optional_share, Limits("number", 0.0, 1.0, optional=True)),
        "rainbow": number(0.0, 10.0),
    }
