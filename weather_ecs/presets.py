"""Presets: named rain and wind, after the classes that weather services use."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

from weather_ecs.components import RainArea, Wind


@dataclass(frozen=True, slots=True)
class Preset:
    """A weather to choose by name."""

    name: str
    rain_rate: float  # mm/h
    wind_speed: float  # m/s, mean at 10 m height
    overcast: float  # 0 to 1, share of the sky that is cloud; 1 is also the darkest
    description: str

    def apply(self, area: RainArea | None = None, wind: Wind | None = None) -> None:
        """Give an area this rain rate, and a wind this speed."""
        if area is not None:
            area.rain_rate = self.rain_rate
        if wind is not None:
            wind.speed = self.wind_speed

    def area(self, center: Any, radii: Any, **fields: Any) -> RainArea:
        """A rain area of this preset; `fields` are RainArea's others."""
        return RainArea(center, radii, self.rain_rate, **fields)

    def wind(self, direction: Any = (1.0, 0.0)) -> Wind:
        """A wind of this preset."""
        return Wind(direction, self.wind_speed)


# Rain: the American Meteorological Society's glossary calls rain light up to 2.5 mm/h, moderate
# to 7.6 mm/h and heavy above, drizzle what seldom exceeds 1 mm/h, and a cloudburst 100 mm/h and
# more. Light, moderate and heavy are also the three rains of Liu and Tong (2015).
# Wind: Beaufort 2 in fine weather, 3 in steady and heavy rain, 5 under a cloudburst's storm.
# Overcast: oktas over 8; steady rain falls from a closed sky.
_TABLE = (
    Preset("clear", 0.0, 2.0, 0.1, "No rain, a light breeze"),
    Preset("drizzle", 0.5, 2.5, 0.9, "Fine drops that barely wet the ground"),
    Preset("light", 2.0, 3.0, 0.85, "Light rain: a hood is enough"),
    Preset("moderate", 5.0, 3.5, 1.0, "Moderate rain: puddles form"),
    Preset("heavy", 25.0, 4.0, 1.0, "Heavy rain: gutters overflow, hills fade out"),
    Preset("cloudburst", 100.0, 9.0, 1.0, "A cloudburst: one sees a few hundred metres"),
)

PRESETS: dict[str, Preset] = {preset.name: preset for preset in _TABLE}
