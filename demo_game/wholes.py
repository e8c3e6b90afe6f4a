"""Whole weathers in the game: the weather's own rain, wind and clouds in place of the game's."""

from __future__ import annotations

import math

import esper

from demo_game.mood import Mood
from weather_ecs import Weather
from weather_ecs.components import RainArea
from weather_ecs.presets import PRESETS, SKIES, WEATHERS, WholeWeather

CENTER = (0.0, -40.0)  # (x, z), m, that they lie round
KEY_TIME = 20.0  # s of a change by keys
LEAVE_TIME = 6.0  # s, back to a weather of the game's own
CLOSED = 0.4, 0.9  # cover between which single clouds become one sheet


def shown_name(name: str) -> str:
    """A name that tells a whole weather from a preset or a sky that is called the same."""
    return f"whole {name}" if name in PRESETS or name in SKIES else name


def nothing(mood: Mood) -> WholeWeather:
    """A whole weather that adds nothing to a mood of the game's own; its clouds may flash."""
    return WholeWeather(
        "the game's own",
        mood.state,
        wind_speed=0.0,
        gustiness=0.0,
        temperature=mood.temperature,
        humidity=mood.humidity,
        visibility=mood.visibility,
        lightning=1.0,
        overcast=min(max(mood.overcast, 0.0), 1.0),
    )


class Wholes:
    """Puts whole weathers up, and says what mood the game is in with them."""

    def __init__(self) -> None:
        self.is_on = False

    def go(
        self,
        weather: Weather,
        to: WholeWeather | str,
        seconds: float,
        mood: Mood,
        center: tuple[float, float] = CENTER,
    ) -> None:
        """Change to a whole weather; out of a weather of the game's own, whose mood it is."""
        if weather.whole is None and seconds > 0.0:
            weather.change_to(nothing(mood), 0.0, center=center)
        weather.change_to(to, seconds, center=center)
        self.is_on = True

    def leave(self, weather: Weather, mood: Mood) -> None:
        """Let the game's own weather come back."""
        if self.is_on:
            weather.change_to(nothing(mood), LEAVE_TIME, center=CENTER)
        self.is_on = False

    def mood(self, weather: Weather) -> tuple[Mood, str] | None:
        """The mood of the whole weather as it is, and its name; None where the game has its own."""
        now = weather.whole if self.is_on else None
        if now is None:
            return None
        c = now.conditions
        low, high = CLOSED
        closed = min(max((c.overcast - low) / (high - low), 0.0), 1.0)
        mood = Mood(
            0.0,
            c.wind_speed,
            c.overcast,
            -c.wind_heading,
            c.temperature,
            c.humidity,
            c.visibility,
            closed * closed * (3.0 - 2.0 * closed),
            c.state,
            lent=1.0,
            carried=c.rain_rate,
        )
        return mood, shown_name(now.name)

    def area(self, weather: Weather) -> RainArea | None:
        """The area in which it rains, if there is one with rain."""
        now = weather.whole
        entity = None if now is None else now.entities.get("rain")
        area = None if entity is None else esper.try_component(entity, RainArea)
        return area if area is not None and area.rain_rate > 0.0 else None

    def status(self, weather: Weather) -> str:
        """What is on its way, in a line; empty where the game has its own weather."""
        now = weather.whole if self.is_on else None
        if now is None:
            return ""
        if now.progress >= 1.0:
            return f"{now.name.replace('_', ' ')}, there"
        return f"{now.name.replace('_', ' ')}, {math.floor(100.0 * now.progress)} % there"


def next_whole(name: str, step: int = 1) -> str:
    """The whole weather after the one whose name is shown, or before it; the first after others."""
    names = list(WEATHERS)
    plain = name.removeprefix("whole ")
    if plain not in names or name in PRESETS:
        return names[0 if step > 0 else -1]
    return names[(names.index(plain) + step) % len(names)]
