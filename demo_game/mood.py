"""What falls and blows, in what air: presets that change into each other over a few seconds."""

from __future__ import annotations

import math
from dataclasses import dataclass, replace

from weather_ecs.presets import PRESETS, SKIES

CHANGE_TIME = 4.0  # s from one preset to the next
TURN_TIME = 1.0  # s for a change of the wind by hand
STRONGEST_WIND = 24.0  # m/s, by hand
WIND_STEP = 2.0  # m/s per key
TURN_STEP = math.radians(22.5)  # per key
# Presets whose point is the air; the others rain out of clouds of their own.
AIRS = frozenset(("sleet", "light_snow", "heavy_snow", "blizzard", "fog"))

# State of the skies; a rain of the walk is a shower that falls from broken clouds.
STATES = {
    "clear": 0.25, "drizzle": 0.5, "light": 0.5, "moderate": 0.5, "heavy": 0.5, "cloudburst": 0.5,
    "sleet": 0.75, "light_snow": 0.75, "heavy_snow": 0.75, "blizzard": 0.75, "fog": 0.0,
}  # fmt: skip
CLIMATE = "climate"  # in place of a preset's name while the climate runs
METAR = "metar"  # in place of a preset's name until the report is read


@dataclass(frozen=True)
class Mood:
    """What the presets set, and the wind's heading."""

    rain_rate: float  # mm/h
    wind_speed: float  # m/s
    overcast: float  # 0..1
    wind_heading: float  # rad, where it blows to, counter-clockwise seen from above
    temperature: float = 15.0  # degrees Celsius
    humidity: float = 0.8  # 0..1
    visibility: float = 50_000.0  # m, of the air without what falls
    closed: float = 0.0  # 0..1: how far the cloud is one sheet, and not only over the rain
    state: float = 0.0  # of the skies, 0 clear to 1 storm
    lent: float = 0.0  # 0..1: share of the wind that is not the game's own
    carried: float = 0.0  # mm/h that a whole weather brings


def preset_mood(name: str, wind_heading: float) -> Mood:
    """The mood of a preset; raises KeyError for a name that is none."""
    preset = PRESETS[name]
    return Mood(
        preset.rain_rate,
        preset.wind_speed,
        preset.overcast,
        wind_heading,
        preset.temperature,
        preset.humidity,
        preset.visibility,
        float(name in AIRS),
        STATES[name],
    )


def climate_mood(state: float, wind_heading: float) -> Mood:
    """The mood while the climate runs: the rain is the clouds' own."""
    clear, storm = preset_mood("clear", wind_heading), preset_mood("cloudburst", wind_heading)
    mood = blend(clear, storm, state)
    return replace(mood, rain_rate=0.0, closed=min(max(2.0 * state - 0.6, 0.0), 1.0), state=state)


def blend(before: Mood, after: Mood, share: float) -> Mood:
    """From `before` to `after`."""
    return Mood(
        _blend_rate(before.rain_rate, after.rain_rate, share),
        before.wind_speed + share * (after.wind_speed - before.wind_speed),
        before.overcast + share * (after.overcast - before.overcast),
        before.wind_heading + share * (after.wind_heading - before.wind_heading),
        before.temperature + share * (after.temperature - before.temperature),
        before.humidity + share * (after.humidity - before.humidity),
        _blend_visibility(before.visibility, after.visibility, share),
        before.closed + share * (after.closed - before.closed),
        before.state + share * (after.state - before.state),
        before.lent + share * (after.lent - before.lent),
        _blend_rate(before.carried, after.carried, share),
    )


def _blend_rate(before: float, after: float, share: float) -> float:
    if share >= 1.0:
        return after
    # log1p keeps the change even to the eye and reaches 0 without a jump.
    return math.expm1(math.log1p(before) + share * (math.log1p(after) - math.log1p(before)))


def _blend_visibility(before: float, after: float, share: float) -> float:
    """Even to the eye: by the same factor in the same time."""
    if share >= 1.0:
        return after
    return math.exp(math.log(before) + share * (math.log(after) - math.log(before)))


def mood_of(name: str, wind_heading: float) -> Mood:
    """The mood of a preset, of a sky by name, or of whatever sky a file holds: fair weather."""
    if name in PRESETS:
        return preset_mood(name, wind_heading)
    return climate_mood(SKIES.get(name, SKIES["fair"]), wind_heading)


class MoodChanger:
    """The current mood, on its way to the one that was asked for."""

    def __init__(self, preset: str, wind_heading: float) -> None:
        self.preset = preset
        self.current = mood_of(preset, wind_heading)
        self._from = self._to = self.current
        self._time, self._length = 1.0, 1.0
        self._follows = False  # a mood that changes by itself

    @property
    def target(self) -> Mood:
        """The mood that will be reached."""
        return self._to

    @property
    def changing(self) -> bool:
        """Whether a change is under way."""
        return self._time < self._length

    def choose(self, preset: str) -> None:
        """Change to a preset; the wind keeps its heading."""
        target = preset_mood(preset, self._to.wind_heading)
        self.preset, self._follows = preset, False
        self._go(target, CHANGE_TIME)

    def follow_climate(self, state: float) -> None:
        """Go by the state of the skies, gliding there if it was a preset so far."""
        self.follow(climate_mood(state, self._to.wind_heading), CLIMATE)

    def follow(self, target: Mood, name: str) -> None:
        """Go by a mood that changes by itself, gliding there from where one was."""
        if self.preset != name:
            if not self._follows:
                self._go(target, CHANGE_TIME)
            self.preset, self._follows = name, True
        self._to = target
        if not self.changing:
            self.current = target

    def put(self, mood: Mood, name: str) -> None:
        """Be in a mood at once."""
        self.preset = name
        self.current = self._from = self._to = mood
        self._time = self._length

    def blow(self, by: float) -> None:
        """Strengthen the wind by so many m/s, within 0 and STRONGEST_WIND."""
        speed = min(max(self._to.wind_speed + by, 0.0), STRONGEST_WIND)
        self._go(replace(self._to, wind_speed=speed), max(TURN_TIME, self._length - self._time))

    def turn_wind(self, by: float) -> None:
        """Turn the wind by so many rad."""
        turned = replace(self._to, wind_heading=self._to.wind_heading + by)
        self._go(turned, max(TURN_TIME, self._length - self._time))

    def update(self, dt: float) -> None:
        """Let dt seconds pass."""
        if not self.changing:
            return
        self._time = min(self._time + dt, self._length)
        share = self._time / self._length
        self.current = blend(self._from, self._to, share * share * (3.0 - 2.0 * share))

    def _go(self, target: Mood, length: float) -> None:
        self._from, self._to = self.current, target
        self._time, self._length = 0.0, length
