"""What a report says, as a whole weather."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Any

from weather_ecs.metar_falls import Falls
from weather_ecs.metar_sky import OKTAS, CloudGroup, bank_of
from weather_ecs.physics.haze import haze_visibility
from weather_ecs.physics.optics import CONTRAST, falling_extinction
from weather_ecs.physics.phase import share_at
from weather_ecs.weathers import MOST_BANKS, WIDESPREAD, WholeWeather

FAR = 30_000.0  # m of visibility where a report says ten kilometres or more
BLOWING = 8.0  # m/s at 10 m above which dry snow is blown (Li and Pomeroy 1997)


@dataclass(slots=True)
class Observed:
    """What the groups of a report come to; None where they say nothing."""

    fields: dict[str, Any] = field(default_factory=dict)  # of WholeWeather, the wind's
    falls: Falls = field(default_factory=Falls)
    clouds: list[CloudGroup] = field(default_factory=list)
    visibility: float | None = None  # m
    temperature: float | None = None  # degrees Celsius
    dew_point: float | None = None  # degrees Celsius


def weather_of(name: str, observed: Observed) -> tuple[WholeWeather, list[tuple[str, str]]]:
    """The weather of a report, and what of it had to be changed, and why."""
    changed: list[tuple[str, str]] = []
    falls, wind = observed.falls, observed.fields.get("wind_speed", 0.0)
    wet = falls.rate > 0.0
    t = observed.temperature
    if t is None:
        t = -2.0 if falls.frozen else 15.0
    damp = 0.95 if wet else 0.7
    if observed.dew_point is not None:
        damp = humidity(t, observed.dew_point)
    rate = falls.rate if not (falls.thunder and wet) else max(falls.rate, 8.0)
    adjusted = _to_fall(t, damp, falls.frozen) if falls.frozen or falls.liquid else t
    if adjusted != t:
        what = "snow" if falls.frozen else "rain"
        changed.append((f"{t:g} degrees", f"{adjusted:.1f}, at which {what} falls"))
    frozen = share_at(adjusted, damp)
    sight = observed.visibility
    if sight is None:
        sight = falls.sight if falls.sight is not None else FAR
    if falls.blowing_snow and wind > BLOWING:
        # The flux of blown snow rises with the cube of the wind and more (Pomeroy and Gray).
        sight = min(sight, 5000.0 * (BLOWING / wind) ** 3)
    most = CONTRAST / max(sight, 1.0)
    known = rate if sight < FAR else 0.0
    while (
        known > 0.0
        and rate > 0.2 * known
        and falling_extinction(rate * (1.0 - frozen), rate * frozen) > most
    ):
        rate *= 0.95  # so much would hide more than is reported
    rain, snow = rate * (1.0 - frozen), rate * frozen
    lost = max(CONTRAST / max(sight, 1.0) - falling_extinction(rain, snow), CONTRAST / 50_000.0)
    groups = sorted(observed.clouds, key=lambda g: g.base or 0.0)[:MOST_BANKS]
    banks = tuple([bank_of(group, falls.kind) for group in groups])
    open_sky = math.prod([1.0 - OKTAS[group.amount] / 8.0 for group in groups])
    if falls.thunder and not any(group.kind == "CB" for group in groups):
        groups_left = banks[: MOST_BANKS - 1]
        banks = (*groups_left, bank_of(CloudGroup("SCT", 900.0, "CB"), falls.kind))
    overcast = 1.0 - open_sky
    state = 0.7 * overcast + (0.15 if wet else 0.0)
    if falls.thunder:
        state = max(state, 0.6 + 0.4 * falls.thunder)
    whole = WholeWeather(
        name,
        min(state, 1.0),
        rain_rate=rate,
        rain_radius=4000.0 if falls.showers else WIDESPREAD,
        temperature=adjusted,
        humidity=damp,
        visibility=CONTRAST / lost,
        lightning=falls.thunder,
        overcast=overcast,
        haze=_haze(CONTRAST / lost, falls.haze),
        banks=banks,
        **{"wind_speed": 0.0, **observed.fields},
    )
    return whole, changed


def _haze(visibility: float, reported: bool) -> float:
    """Haze of air in which one sees so far (m): thick where it is reported, never thicker than
    that lets one see.
    """
    haze = min(max(1.0 - math.log10(visibility / 500.0) / 2.0, 0.1), 0.9)
    return 0.7 if reported and haze_visibility(0.7) >= visibility else haze


def humidity(temperature: float, dew_point: float) -> float:
    """Relative humidity, 0 to 1, of two temperatures in degrees Celsius.

    Magnus's formula with the constants of Alduchov and Eskridge (1996).
    """
    over = 17.625 * dew_point / (243.04 + dew_point) - 17.625 * temperature / (243.04 + temperature)
    return min(max(math.exp(over), 0.0), 1.0)


def _to_fall(temperature: float, damp: float, frozen: bool) -> float:
    """The nearest temperature at which what was reported falls so, in tenths of a degree."""
    step = -0.1 if frozen else 0.1
    for k in range(400):
        t = round(temperature + k * step, 1) if k else temperature
        share = share_at(t, damp)
        if (share > 0.9) if frozen else (share < 0.1):
            return t
    return temperature
