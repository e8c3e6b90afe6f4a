"""What a tour does with the weather on its way: a course of moods over the share of its time."""

from __future__ import annotations

from dataclasses import dataclass, replace
from typing import Protocol

from demo_game.mood import CLIMATE, Mood, blend, climate_mood, preset_mood
from demo_game.wholes import CENTER


@dataclass(frozen=True)
class Turn:
    """The weather at one moment of a tour."""

    mood: Mood
    name: str  # of the preset it is nearest to, or `mood.CLIMATE`
    speed: float = 1.0  # s of weather in a second
    rains: bool = False  # whether the clouds of the sky bring their own rain
    settling: float | None = None  # how fast snow settles; None: as in play
    whole: str | None = None  # a whole weather in place of the mood
    seconds: float = 0.0  # of weather, in which it comes
    center: tuple[float, float] = CENTER  # (x, z), m, of its rain
    strikes: tuple[tuple[float, float, float], ...] = ()  # that were called up to now, m


class Play(Protocol):
    """A course of the weather."""

    def at(self, time: float, wind_heading: float) -> Turn:
        """The weather at `time` s of the tour."""


class StormPlay:
    """From a clear sky to a storm, in the time-lapse that a short tour needs; then as it is."""

    RISE = 0.03, 0.44  # shares of the tour in which the state goes from 0 to 1
    STEADY = 0.62  # share from which the weather runs at its own speed
    LENGTH = 260.0  # s of weather in which the sky fills

    def __init__(self, duration: float) -> None:
        self._duration = duration
        self._speed = min(max(self.LENGTH / (self.STEADY * duration), 1.0), 900.0)

    def at(self, time: float, wind_heading: float) -> Turn:
        """The weather at `time` s of the tour."""
        u = time / self._duration
        begin, end = self.RISE
        state = min(max((u - begin) / (end - begin), 0.0), 1.0)
        speed = self._speed if u < self.STEADY else 1.0
        return Turn(climate_mood(state, wind_heading), CLIMATE, speed, rains=True)


class SnowPlay:
    """A cold grey day on which it begins to snow, snows until all is white, and stops.

    Flakes need most of a minute from their cloud to the ground: while snow comes and goes a short
    tour is a time-lapse, and in between it snows at its own speed.
    """

    BEGINS, FULL, EASES, ENDS = 0.08, 0.12, 0.66, 0.70  # shares of the tour
    CALM = 0.48, 0.66  # shares between which the weather runs at its own speed
    BEFORE, AFTER = 110.0, 90.0  # s of weather before and after that
    DEPTH = 0.030  # m that lie at the end
    GROWS = 0.035 / 3600.0  # m/s, by which 3.5 mm/h of water grow deep where nothing is hastened

    def __init__(self, duration: float) -> None:
        self._duration = duration
        begin, end = self.CALM
        self._before = min(max(self.BEFORE / (begin * duration), 1.0), 900.0)
        self._after = min(max(self.AFTER / ((1.0 - end) * duration), 1.0), 900.0)
        passed = (begin - self.BEGINS) * self._before + (end - begin)
        passed += (self.ENDS - end) * self._after
        self._settling = min(max(self.DEPTH / (self.GROWS * passed * duration), 1.0), 100.0)

    def at(self, time: float, wind_heading: float) -> Turn:
        """The weather at `time` s of the tour."""
        u = time / self._duration
        snows = preset_mood("heavy_snow", wind_heading)
        rests = replace(snows, rain_rate=0.0, wind_speed=1.5, visibility=30_000.0)
        share = min(
            max((u - self.BEGINS) / (self.FULL - self.BEGINS), 0.0),
            max((self.ENDS - u) / (self.ENDS - self.EASES), 0.0),
            1.0,
        )
        begin, end = self.CALM
        speed = self._before if u < begin else self._after if u > end else 1.0
        return Turn(blend(rests, snows, share), "heavy_snow", speed, settling=self._settling)


class ThunderPlay:
    """A fine day on which a thunderstorm comes up, in the time-lapse that a short tour needs.

    From `STEADY` on the weather runs at its own speed, and lightning strikes ahead.
    """

    has_whole = True
    BEGINS, STEADY = 0.05, 0.52  # shares of the tour
    LENGTH = 110.0  # s of weather in which the storm comes
    FROM, TO = (-600.0, -9500.0), (0.0, -2500.0)  # (x, z), m, of the middle of its rain
    STRIKES = (
        (0.56, (-260.0, 0.0, -1150.0)),
        (0.66, (210.0, 0.0, -760.0)),
        (0.77, (-90.0, 0.0, -620.0)),
        (0.88, (60.0, 0.0, -430.0)),
    )  # share of the tour, m

    def __init__(self, duration: float) -> None:
        self._duration = duration
        passed = (self.STEADY - self.BEGINS) * duration
        self._speed = min(max(self.LENGTH / passed, 1.0), 900.0)

    def at(self, time: float, wind_heading: float) -> Turn:
        """The weather at `time` s of the tour."""
        u = time / self._duration
        share = min(max((u - self.BEGINS) / (1.0 - self.BEGINS), 0.0), 1.0)
        (x0, z0), (x1, z1) = self.FROM, self.TO
        fair = u < self.BEGINS
        return Turn(
            preset_mood("clear", wind_heading),
            "",
            1.0 if fair or u >= self.STEADY else self._speed,
            whole="fair_cumulus" if fair else "thunderstorm",
            seconds=0.0 if fair else self.LENGTH,
            center=(x0 + share * (x1 - x0), z0 + share * (z1 - z0)),
            strikes=tuple(place for at, place in self.STRIKES if at <= u),
        )


class NightPlay:
    """A night of showers under a full moon."""

    has_whole = True
    hour = "night"

    def at(self, time: float, wind_heading: float) -> Turn:
        """The weather at `time` s of the tour."""
        return Turn(preset_mood("clear", wind_heading), "", whole="showers")
