"""`TourWeather`: what a tour's play does with the game's weather."""

from __future__ import annotations

from typing import TYPE_CHECKING

from demo_game.plays import Play, Turn

if TYPE_CHECKING:
    from demo_game.game import Game


class TourWeather:
    """Follows a play; without one it does nothing."""

    def __init__(self, play: Play | None) -> None:
        self._play = play
        self._asked, self._called = "", 0
        self.is_there = play is not None
        self.is_whole: bool = getattr(play, "has_whole", False)  # its weather is a whole one
        self.hour: str | None = getattr(play, "hour", None)

    def follow(self, game: Game) -> None:
        """Give the game the weather of its moment."""
        if self._play is None:
            return
        turn = self._play.at(game.time, game.mood.target.wind_heading)
        if turn.whole is not None:
            self._follow_whole(game, turn, turn.whole)
            return
        game.mood.put(turn.mood, turn.name)
        game.scape.let_rain(turn.rains)
        game.weather.speed = turn.speed
        if turn.settling is not None:
            game.entities.flakes.settling = turn.settling

    def _follow_whole(self, game: Game, turn: Turn, name: str) -> None:
        game.weather.speed = turn.speed
        begins = not self._asked
        if name != self._asked:
            self._asked = name
            game.scape.show(False)
            mood = game.mood.current
            game.wholes.go(game.weather, name, turn.seconds, mood, turn.center)
        whole = game.wholes.mood(game.weather)
        if begins and whole is not None:
            game.mood.put(*whole)
        area = game.wholes.area(game.weather)
        if area is not None and area.center != turn.center:
            area.center = turn.center
        for place in turn.strikes[self._called :]:
            game.weather.strike(place)
        self._called = len(turn.strikes)
