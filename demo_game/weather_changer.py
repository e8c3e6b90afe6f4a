"""`WeatherChanger`: the weather that keys choose, and what the game's mood follows meanwhile."""

from __future__ import annotations

import math
import weakref
from collections import deque
from dataclasses import replace
from typing import TYPE_CHECKING

from demo_game.compass import compass
from demo_game.mood import AIRS, METAR, TURN_STEP, WIND_STEP, MoodChanger
from demo_game.surroundings import WIND_HEADING
from demo_game.wholes import KEY_TIME, next_whole
from weather_ecs.presets import PRESETS

if TYPE_CHECKING:
    from demo_game.game import Game

OPENING = 0.25, 0.10  # state and cover of the sky that a game begins under, whatever it rains
STRIKE_AHEAD, SPREAD = 900.0, 0.3  # m and rad, of a strike that the player calls
MARK, MARKS = 2.0, 60  # s, and how many of them are kept


def first_mood(preset: str, *, is_given: bool, is_tour: bool) -> MoodChanger:
    """The mood that a game begins in; `is_given`: a report or a whole weather sets it at once."""
    mood = MoodChanger(preset, WIND_HEADING)
    if is_given:
        # Theirs is to count from the first frame on.
        mood.put(replace(mood.current, rain_rate=0.0), METAR)
    elif not is_tour and preset not in AIRS and mood.current.rain_rate > 0.0:
        # A shower ahead to walk into, and sun here.
        state, overcast = OPENING
        mood.put(replace(mood.current, state=state, overcast=overcast), preset)
    return mood


class WeatherChanger:
    """Changes a game's weather; what a key calls for returns what to tell the player."""

    def __init__(self, game: Game) -> None:
        # Else a game would live on in a cycle, with its handlers of events, after it is closed.
        self._game: Game = weakref.proxy(game)
        # State of the skies and mm/h, every MARK s of play, for the readout's strip.
        self.history: deque[tuple[float, float]] = deque(maxlen=MARKS)
        self._next_mark = 0.0
        self._strikes = 0

    def update(self, dt: float) -> None:
        """Let dt seconds pass: the mood follows the tour's play, a file, the climate or a whole."""
        game = self._game
        game.mood.update(dt)
        if game.play.is_there:
            game.play.follow(game)
        elif not game.given.follow(game, dt) and game.scape.is_running:
            game.mood.follow_climate(game.scape.state)
        whole = game.wholes.mood(game.weather)
        if whole is not None:
            game.mood.follow(*whole)
        if game.time >= self._next_mark:
            self._next_mark = game.time + MARK
            now = game.mood.current
            self.history.append((now.state, now.rain_rate + now.carried))

    def choose_preset(self, name: str) -> str:
        """Change to a preset of the game's own."""
        game = self._game
        game.given.leave()
        game.scape.stop()
        game.mood.choose(name)
        self._leave_whole()
        return PRESETS[name].description

    def choose_whole(self, name: str, seconds: float = KEY_TIME) -> str:
        """Change to a whole weather."""
        game = self._game
        game.given.leave()
        game.scape.stop()
        game.scape.show(False)
        game.wholes.go(game.weather, name, seconds, game.mood.current)
        return f"{name.replace('_', ' ').capitalize()} within {seconds:.0f} s"

    def next_whole(self, step: int = 1) -> str:
        """Go on to the next whole weather, or back."""
        return self.choose_whole(next_whole(self._game.mood.preset, step))

    def run_climate(self) -> str:
        """Let the climate run, or run back."""
        self._leave_whole()
        onwards = self._game.scape.run()
        return "The weather turns to storm" if onwards else "The weather clears up"

    def blow(self, steps: int) -> str:
        """Strengthen or weaken the wind."""
        mood = self._game.mood
        mood.blow(steps * WIND_STEP)
        return f"Wind {mood.target.wind_speed:.1f} m/s"

    def turn_wind(self, steps: int) -> str:
        """Turn the wind."""
        mood = self._game.mood
        mood.turn_wind(steps * TURN_STEP)
        return f"Wind to {compass(mood.target.wind_heading)}"

    def strike(self) -> str:
        """Lightning ahead of the player."""
        pose = self._game.pose
        x, _, z = pose.eye
        self._strikes += 1
        turn = pose.yaw + SPREAD * math.sin(2.4 * self._strikes)
        target = x - STRIKE_AHEAD * math.sin(turn), 0.0, z - STRIKE_AHEAD * math.cos(turn)
        self._game.weather.strike(target)
        return ""

    def _leave_whole(self) -> None:
        game = self._game
        game.wholes.leave(game.weather, game.mood.target)
        game.scape.show(True)
