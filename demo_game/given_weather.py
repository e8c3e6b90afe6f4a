"""`GivenWeather`: the game's weather as a file or a METAR report has it."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

from demo_game.file_weather import FileWeather
from demo_game.wholes import CENTER

if TYPE_CHECKING:
    from demo_game.game import Game


class GivenWeather:
    """Knows the file or the report; with neither it does nothing."""

    def __init__(self) -> None:
        self.report: Any = None  # of METAR, if there is one
        self.file: FileWeather | None = None

    def load(self, game: Game, path: str, watch: bool) -> None:
        """The weather of a file in place of the game's. Raises WeatherError for a bad one."""
        self.file = FileWeather(path, watch=watch)
        self._take(game, self.file)

    def take_report(self, game: Game, text: str) -> None:
        """The weather of a METAR report, at once. Raises WeatherError for a bad one."""
        self.report = game.weather.apply_metar(text, 0.0, center=CENTER)
        game.scape.show(False)
        game.wholes.is_on = True
        whole = game.wholes.mood(game.weather)
        if whole is not None:
            game.mood.put(*whole)
        game.surroundings.light_up(game)

    def follow(self, game: Game, dt: float) -> bool:
        """Let dt seconds pass; whether there is a file, which the game's mood then follows."""
        file = self.file
        if file is None:
            return False
        before, news = file.readings, file.look(dt)
        if news:
            game.errand.tell(news)
        if file.readings != before:
            self._take(game, file)
        mood = file.mood(game.scape.state, game.mood.target.wind_heading)
        game.mood.follow(mood, file.path.stem)
        return True

    def leave(self) -> None:
        """The game has a weather of its own now."""
        if self.file is not None:
            self.file.leave()
        self.file = self.report = None

    def _take(self, game: Game, file: FileWeather) -> None:
        """The file says something new."""
        game.scape.follow(file.climate)
        file.set_sky(game.sky.atmosphere)
        mood = file.mood(game.scape.state, game.mood.target.wind_heading)
        game.mood.put(mood, file.path.stem)
        game.surroundings.light_up(game)
