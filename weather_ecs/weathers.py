"""Whole weathers: clouds, rain, wind, air, fog and lightning that go together, by name."""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import Any, NamedTuple

from weather_ecs.cloud_files import CLOUD_MODELS
from weather_ecs.components._base import number
from weather_ecs.errors import InvalidValueError
from weather_ecs.physics.oktas import count_for, shown_footprint
from weather_ecs.systems import transition
from weather_ecs.systems.course import LONGEST_NAME, Conditions, checked
from weather_ecs.systems.state import WeatherState
from weather_ecs.systems.transition import remove_all as remove_all

MOST_BANKS = 8
# m of the square in which a bank's clouds stand, by the height of its base.
SIDES = ((2000.0, 20_000.0), (6000.0, 26_000.0), (math.inf, 40_000.0))
# An anvil is 10 km wide, and a sheet has to reach over the horizon.
WIDE, WIDE_SIDE = 20.0, 36_000.0  # km2, m
WIDESPREAD = 0.5 * WIDE_SIDE  # m of rain round its middle: as far as the sheet that it falls from

_oktas = number(0.0, 8.0)
_base = number(0.0, 20_000.0)
_bearing = number(0.0, 360.0)


@dataclass(frozen=True, slots=True)
class CloudBank:
    """Clouds of one height in a whole weather; raises InvalidValueError for bad values."""

    models: tuple[str, ...]  # names of `presets.CLOUD_MODELS`
    base: float  # m, 0 to 20000
    oktas: float  # 0 to 8: eighths of the sky that they cover
    weights: tuple[float, ...] = ()  # of the models; none: all the same

    def __post_init__(self) -> None:
        good = (
            isinstance(self.models, tuple) and self.models and set(self.models) <= {*CLOUD_MODELS}
        )
        if not good:
            raise InvalidValueError("CloudBank.models", self.models, ", ".join(CLOUD_MODELS))
        _base("CloudBank.base", self.base)
        _oktas("CloudBank.oktas", self.oktas)
        if self.weights and len(self.weights) != len(self.models):
            raise InvalidValueError(
                "CloudBank.weights", self.weights, "none, or one for each model"
            )

    def bank(self) -> transition.Bank:
        """The same as the layer has it: how many clouds stand in how large a square."""
        weights = self.weights or (1.0,) * len(self.models)
        shares = [(w, shown_footprint(m)) for w, m in zip(weights, self.models, strict=True)]
        footprint = sum(w * area for w, area in shares) / sum(weights)
        side = next(side for top, side in SIDES if self.base <= top)
        side = WIDE_SIDE if footprint > WIDE else side
        clouds = count_for(self.oktas, footprint, (0.001 * side) ** 2)
        return transition.Bank(
            self.models, self.weights, self.base, clouds, side, min(0.06 * self.base, 250.0)
        )


@dataclass(frozen=True, slots=True)
class WholeWeather:
    """A complete weather. `presets.WEATHERS` are some; a game may make others."""

    name: str
    state: float  # 0 clear to 1 storm, of the skies
    rain_rate: float = 0.0  # mm/h of water, as rain or snow by the air
    rain_radius: float = WIDESPREAD  # m, of the area it falls in
    wind_speed: float = 2.0  # m/s, mean at 10 m
    wind_from: float | None = None  # degrees clockwise from north, -z; None: as it blows already
    gustiness: float = 0.2  # 0 to 1: how far the strongest gusts exceed the mean
    veer: float = 0.15  # rad: how far the direction may be off
    temperature: float = 15.0  # degrees Celsius
    humidity: float = 0.7  # 0 to 1
    visibility: float = 50_000.0  # m, of the air without what falls
    lightning: float = 0.0  # 0 to 1: share of what the clouds' models flash
    overcast: float = 0.0  # 0 to 1, share of the sky that is cloud
    haze: float = 0.1  # 0 to 1, from the clearest air to thick haze
    banks: tuple[CloudBank, ...] = ()  # from low to high, at most 8
    description: str = ""

    def __post_init__(self) -> None:
        if not isinstance(self.name, str) or not 0 < len(self.name) <= LONGEST_NAME:
            raise InvalidValueError("name", self.name, f"1 to {LONGEST_NAME} characters")
        if not isinstance(self.banks, tuple) or len(self.banks) > MOST_BANKS:
            raise InvalidValueError("banks", self.banks, f"a tuple of at most {MOST_BANKS}")
        if not all(isinstance(bank, CloudBank) for bank in self.banks):
            raise InvalidValueError("banks", self.banks, "CloudBank each")
        if self.wind_from is not None:
            _bearing("wind_from", self.wind_from)
        self.conditions(0.0)

    def conditions(self, heading: float) -> Conditions:
        """What glides; `heading` is that of the wind where the weather has none of its own."""
        if self.wind_from is not None:
            heading = heading_of(self.wind_from)
        return checked(
            Conditions(
                self.state,
                self.rain_rate,
                self.rain_radius,
                self.wind_speed,
                heading,
                self.gustiness,
                self.veer,
                self.temperature,
                self.humidity,
                self.visibility,
                self.lightning,
                self.overcast,
                self.haze,
            )
        )


class WeatherNow(NamedTuple):
    """A whole weather as it is at a moment."""

    name: str  # of the weather it is on its way to, or has reached
    progress: float  # 0 to 1, of the time that the transition takes
    conditions: Conditions
    entities: dict[str, int]  # of its own components: air, fog, lightning, rain, wind


def heading_of(bearing: float) -> float:
    """Angle from +x towards +z to which a wind blows that comes from a bearing in degrees.

    North is -z and east is +x.
    """
    angle = math.radians(bearing)
    return math.atan2(math.cos(angle), -math.sin(angle))


def find(weather: Any) -> WholeWeather:
    """The weather itself, or that of a name. Raises InvalidValueError for neither."""
    if isinstance(weather, WholeWeather):
        return weather
    name = weather.lower().replace("-", "_").replace(" ", "_") if isinstance(weather, str) else ""
    if name not in WEATHERS:
        raise InvalidValueError("weather", weather, "a WholeWeather or " + ", ".join(WEATHERS))
    return WEATHERS[name]


def begin(
    state: WeatherState, whole: WholeWeather, seconds: float, center: tuple[float, float]
) -> None:
    """Set out for a weather in esper's current world."""
    heading = 0.0
    if state.course is not None:
        heading = state.course.at(state.clock.steps).wind_heading
    banks = tuple([bank.bank() for bank in whole.banks])
    transition.begin(state, whole.name, whole.conditions(heading), banks, seconds, center)


def now(state: WeatherState) -> WeatherNow | None:
    """The weather as it is now."""
    course, step = state.course, state.clock.steps
    if course is None:
        return None
    entity_of = {uid: entity for entity, uid in state.uids.current().items()}
    owned = {what: entity_of[uid] for what, uid in course.owned.items() if uid in entity_of}
    return WeatherNow(course.name, course.progress(step), course.at(step), owned)


# Rates, winds, visibilities and temperatures are those of `presets.PRESETS`, whose sources are
# there; amounts of cloud in oktas, bases by the genera (WMO International Cloud Atlas). Showers
# and a thunderstorm's rain come as an area of some km, as wide as a cell (Byers and Braham 1949),
# all other precipitation as one that reaches to the horizon.
_TABLE = (
    WholeWeather(
        "clear", 0.0, wind_speed=2.0, temperature=20.0, humidity=0.5,
        haze=0.1, overcast=0.05, banks=(CloudBank(("cirrus",), 9000.0, 0.5),),
        description="A blue sky with a wisp of cirrus",
    ),
    WholeWeather(
        "fair_cumulus", 0.25, wind_speed=3.5, gustiness=0.3, temperature=21.0, humidity=0.55,
        overcast=0.3, haze=0.15,
        banks=(CloudBank(("cumulus",), 1200.0, 2.5), CloudBank(("cirrus",), 9000.0, 0.5)),
        description="Cumulus of a fine day",
    ),
    WholeWeather(
        "overcast_drizzle", 0.75, 0.4, wind_speed=2.5, temperature=9.0, humidity=0.97,
        visibility=4000.0, overcast=1.0, haze=0.5,
        banks=(CloudBank(("stratus",), 300.0, 8.0),),
        description="Low stratus, mist and drizzle",
    ),
    WholeWeather(
        "steady_rain", 0.85, 5.0, wind_speed=4.5, gustiness=0.3, temperature=11.0, humidity=0.94,
        visibility=15_000.0, overcast=1.0, haze=0.3,
        banks=(
            CloudBank(("fractostratus",), 350.0, 2.0),
            CloudBank(("altostratus",), 2600.0, 8.0),
        ),
        description="Hours of rain from a closed sky",
    ),
    WholeWeather(
        "showers", 0.55, 10.0, 1800.0, wind_speed=7.0, gustiness=0.5, temperature=13.0,
        humidity=0.8, visibility=30_000.0, overcast=0.6, haze=0.1,
        banks=(
            CloudBank(("cumulus", "stratocumulus"), 900.0, 4.5, (4.0, 1.0)),
            CloudBank(("cirrus",), 8500.0, 1.0),
        ),
        description="Sun and showers in turn, gusty",
    ),
    WholeWeather(
        "thunderstorm", 1.0, 40.0, 4000.0, wind_speed=9.0, gustiness=0.8, veer=0.5,
        temperature=19.0, humidity=0.92, visibility=12_000.0, lightning=1.0, overcast=0.95,
        haze=0.3,
        banks=(
            CloudBank(("cumulonimbus",), 900.0, 6.0),
            CloudBank(("stratocumulus",), 1400.0, 3.0),
        ),
        description="Cloudburst, squalls and lightning",
    ),
    WholeWeather(
        "snow", 0.8, 1.5, wind_speed=3.0, temperature=-2.0, humidity=0.93, visibility=12_000.0,
        overcast=1.0, haze=0.3, banks=(CloudBank(("altostratus",), 2300.0, 8.0),),
        description="Moderate snow from a closed sky",
    ),
    WholeWeather(
        "blizzard", 0.95, 3.0, wind_speed=18.0, gustiness=0.5, veer=0.2, temperature=-8.0,
        humidity=0.9, visibility=300.0, overcast=1.0, haze=0.8,
        banks=(CloudBank(("stratus",), 500.0, 8.0),),
        description="A storm white with snow",
    ),
    WholeWeather(
        "fog", 0.4, wind_speed=0.8, gustiness=0.0, veer=0.4, temperature=6.0, humidity=1.0,
        visibility=250.0, overcast=0.9, haze=0.9, banks=(CloudBank(("stratus",), 120.0, 6.0),),
        description="Dense fog",
    ),
)  # fmt: skip

WEATHERS: dict[str, WholeWeather] = {whole.name: whole for whole in _TABLE}
