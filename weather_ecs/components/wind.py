"""`Wind`: a wind over the whole world, with its law, its gusts and its turbulence."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any, ClassVar

from weather_ecs.components._base import (
    Check,
    Component,
    Limits,
    limited,
    number,
    to_floats,
    unit_vector,
    vector,
)
from weather_ecs.errors import InvalidValueError

LAWS = ("constant", "gust", "steady")
LONGEST = 1.0e6  # s
TIMES = f"(rise, hold, duration) in s with 0 < rise < hold < duration <= {LONGEST:g}"


def _law(field: str, value: Any) -> str:
    if not isinstance(value, str) or value not in LAWS:
        raise InvalidValueError(field, value, ", ".join(LAWS))
    return str(value)


def _times(field: str, value: Any) -> tuple[float, ...]:
    rise, hold, duration = to_floats(field, value, 3, TIMES)
    if not 0.0 < rise < hold < duration <= LONGEST:
        raise InvalidValueError(field, value, TIMES)
    return rise, hold, duration


@dataclass(eq=False, slots=True)
class Wind(Component):
    """A wind over the whole world; several add up.

    By its law (Liu and Tong 2015, 2.3) the speed is constant for ever, or that of a gust or of a
    steady wind that begins at `start` and ends with the last of its `times`. Over that, gusts come
    by chance, and the direction veers. Everything follows from the weather's clock, the seed and
    the entity: nothing has to be stored, and a client and its server agree. See docs/wind.md.
    """

    direction: tuple[float, float] = (1.0, 0.0)  # (x, z), where it blows to; kept at length 1
    speed: float = 0.0  # m/s, 0 to 150, 10 m above the ground; the laws' strengths are times this
    law: str = "constant"  # or gust, or steady
    start: float = 0.0  # s of the weather's clock, within 1e9: when gust and steady begin
    times: tuple[float, float, float] = (4.0, 40.0, 60.0)  # s: rise tc, hold t_mid, duration t_max
    coefficients: tuple[float, ...] = (1.0, 0.0, 1.0, 0.3, 1.0, 1.0)  # a to f of the laws
    period: float = 0.0  # s, 0 to 1e6: begins anew so often, as soon as it has ended; 0: once
    gustiness: float = 0.0  # 0 to 1: how far the strongest gusts exceed the mean speed
    interval: float = 20.0  # s, 0.5 to 1e6: one gust in each
    veer: float = 0.0  # rad, 0 to pi: how far the direction may be off
    veer_period: float = 120.0  # s, 1 to 1e6
    exponent: float = 0.0  # 0 to 1, of the growth with height; 1/7 over open land, 0: none
    ground: float = 0.0  # m, within 1e5: world height from which heights count
    turbulence: float = 0.0  # 0 to 1, intensity: standard deviation over the speed
    scale: float = 6.0  # m, 0.5 to 1000, of the largest eddies

    checks: ClassVar[dict[str, Check]] = {
        "direction": unit_vector(2),
        "speed": number(0.0, 150.0),
        "law": limited(_law, Limits("choice", choices=LAWS)),
        "start": number(-1.0e9, 1.0e9),
        "times": limited(_times, Limits("vector", 0.0, LONGEST, above=True, size=3)),
        "coefficients": vector(6, -100.0, 100.0),
        "period": number(0.0, LONGEST),
        "gustiness": number(0.0, 1.0),
        "interval": number(0.5, LONGEST),
        "veer": number(0.0, 3.141592653589793),
        "veer_period": number(1.0, LONGEST),
        "exponent": number(0.0, 1.0),
        "ground": number(-1.0e5, 1.0e5),
        "turbulence": number(0.0, 1.0),
        "scale": number(0.5, 1000.0),
    }
