"""Presets: named weathers, after the classes that weather services use; clouds and skies."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from weather_ecs.cloud_files import CLOUD_MODELS as CLOUD_MODELS  # names of the kinds of cloud
from weather_ecs.cloud_presets import SKIES as SKIES
from weather_ecs.cloud_presets import cloud_model as cloud_model
from weather_ecs.cloud_presets import sky as sky
from weather_ecs.components import Air, Fog, RainArea, Wind
from weather_ecs.errors import InvalidValueError, shorten
from weather_ecs.weathers import WEATHERS as WEATHERS  # whole ones, for Weather.change_to
from weather_ecs.weathers import CloudBank as CloudBank
from weather_ecs.weathers import WholeWeather as WholeWeather


@dataclass(frozen=True, slots=True)
class Preset:
    """A weather to choose by name."""

    name: str
    rain_rate: float  # mm/h of water, as rain or snow by the air
    wind_speed: float  # m/s, mean at 10 m height
    overcast: float  # 0 to 1, share of the sky that is cloud; 1 is also the darkest
    description: str
    temperature: float = 15.0  # degrees Celsius
    humidity: float = 0.8  # 0 to 1, relative
    visibility: float = 50_000.0  # m, of the air without what falls: mist, fog, snow that is blown
    gustiness: float = 0.0  # 0 to 1: how far the strongest gusts exceed the mean

    def apply(
        self,
        area: RainArea | None = None,
        wind: Wind | None = None,
        air: Air | None = None,
        fog: Fog | None = None,
    ) -> None:
        """Give an area this rate, a wind this speed and gustiness, air and fog what is theirs."""
        if area is not None:
            area.rain_rate = self.rain_rate
        if wind is not None:
            wind.speed = self.wind_speed
            wind.gustiness = self.gustiness
        if air is not None:
            air.temperature = self.temperature
            air.humidity = self.humidity
        if fog is not None:
            fog.visibility = self.visibility

    def area(self, center: Any, radii: Any, **fields: Any) -> RainArea:
        """A rain area of this preset; `fields` are RainArea's others."""
        return RainArea(center, radii, self.rain_rate, **fields)

    def wind(self, direction: Any = (1.0, 0.0), **fields: Any) -> Wind:
        """A wind of this preset; `fields` are Wind's others."""
        return Wind(direction, self.wind_speed, gustiness=self.gustiness, **fields)

    def air(self) -> Air:
        """The air of this preset."""
        return Air(self.temperature, self.humidity)

    def fog(self, **fields: Any) -> Fog:
        """The fog of this preset; `fields` are Fog's others."""
        return Fog(self.visibility, **fields)


class _Presets(dict[str, Preset]):
    """Takes "light snow" and "Light-Snow" for "light_snow"."""

    def __missing__(self, name: str) -> Preset:
        known = self.get(name)
        if known is None:
            raise KeyError(f"no preset {shorten(name)}; there are {', '.join(self)}")
        return known

    def __contains__(self, name: object) -> bool:
        return isinstance(name, str) and super().__contains__(_plain(name))

    def get(self, name: str, default: Any = None) -> Any:
        """The preset of a name, in any spelling, or the default."""
        return super().get(_plain(name), default) if isinstance(name, str) else default


def _plain(name: str) -> str:
    return "_".join(name.lower().replace("-", " ").replace("_", " ").split())


def find(name: str) -> Preset:
    """The preset of a name, in any spelling. Raises InvalidValueError for a name that is none."""
    if name not in PRESETS:
        raise InvalidValueError("preset", name, ", ".join(PRESETS))
    return PRESETS[name]


# Rain: the American Meteorological Society's glossary calls rain light up to 2.5 mm/h, moderate
# to 7.6 mm/h and heavy above, drizzle what seldom exceeds 1 mm/h, and a cloudburst 100 mm/h and
# more. Light, moderate and heavy are also the three rains of Liu and Tong (2015).
# Snow: light where one sees more than 1 km, moderate to 500 m and heavy below (WMO; the US Federal
# Meteorological Handbook 1 has 1/2 and 1/4 mile, 0.8 and 0.4 km). By `physics.snow` one sees 1.9 km
# at 0.8 mm/h of water, and 440 m at 3.5 mm/h; Rasmussen et al. (1999) find light snow below 1.0 and
# heavy above 2.5 mm/h.
# Blizzard: the US National Weather Service asks for 35 mph (15.6 m/s) and a visibility below
# 1/4 mile for three hours, falling or blown. Here snow that falls at 3 mm/h shows 510 m, and the
# blown snow besides it is a fog of 300 m: one sees 190 m.
# Sleet, in the British and the WMO's sense of rain and snow together (code 68): a wet bulb of
# 0.8 degrees, where half is snow (`physics.phase`).
# Fog: less than 1 km (WMO), here dense fog, which begins at 1/4 mile by the NWS. Mist in the
# drizzle: 1 to 5 km (AMS). Rain washes the air; what is left under it is a haze of 10 to 20 km.
# Wind: Beaufort 2 in fine weather, 3 in steady and heavy rain and in snow, 5 under a cloudburst's
# storm, 8 in a blizzard; 1 in fog, which a wind of more than 3 m/s lifts. Gusts: over open land
# about half as much again as the mean in a strong wind, less in a weak one, and up to twice it
# under a thunderstorm.
# Temperature: a day of spring or autumn in middle latitudes, a summer's thunderstorm, and for snow
# the degrees at which the heavy snow falls (-1 to -3), a blizzard's below; humidity 0.9 and more
# where something falls for long, 1 in fog.
# Overcast: oktas over 8; steady rain and snow fall from a closed sky.
_TABLE = (
    Preset(
        "clear", 0.0, 2.0, 0.1, "No rain, a light breeze",
        temperature=18.0, humidity=0.6, gustiness=0.2,
    ),
    Preset(
        "drizzle", 0.5, 2.5, 0.9, "Fine drops that barely wet the ground",
        temperature=9.0, humidity=0.97, visibility=4000.0, gustiness=0.2,
    ),
    Preset(
        "light", 2.0, 3.0, 0.85, "Light rain: a hood is enough",
        temperature=12.0, humidity=0.9, visibility=20_000.0, gustiness=0.3,
    ),
    Preset(
        "moderate", 5.0, 3.5, 1.0, "Moderate rain: puddles form",
        temperature=12.0, humidity=0.93, visibility=15_000.0, gustiness=0.3,
    ),
    Preset(
        "heavy", 25.0, 4.0, 1.0, "Heavy rain: gutters overflow, hills fade out",
        temperature=13.0, humidity=0.95, visibility=12_000.0, gustiness=0.4,
    ),
    Preset(
        "cloudburst", 100.0, 9.0, 1.0, "A cloudburst: one sees a few hundred metres",
        temperature=19.0, humidity=0.95, visibility=10_000.0, gustiness=0.8,
    ),
    Preset(
        "sleet", 2.5, 4.0, 1.0, "Sleet: rain and wet snow together",
        temperature=1.7, humidity=0.92, visibility=8000.0, gustiness=0.3,
    ),
    Preset(
        "light_snow", 0.8, 2.0, 0.95, "Light snow: single flakes, the hills still there",
        temperature=-2.0, humidity=0.9, visibility=20_000.0, gustiness=0.2,
    ),
    Preset(
        "heavy_snow", 3.5, 3.5, 1.0, "Heavy snow: large flakes, one sees less than 500 m",
        temperature=-1.0, humidity=0.95, visibility=10_000.0, gustiness=0.3,
    ),
    Preset(
        "blizzard", 3.0, 18.0, 1.0, "A blizzard: a storm white with snow, one sees 200 m",
        temperature=-8.0, humidity=0.9, visibility=300.0, gustiness=0.5,
    ),
    Preset(
        "fog", 0.0, 1.0, 0.9, "Dense fog: what is 250 m off is gone",
        temperature=6.0, humidity=1.0, visibility=250.0,
    ),
)  # fmt: skip

PRESETS: dict[str, Preset] = _Presets((preset.name, preset) for preset in _TABLE)
