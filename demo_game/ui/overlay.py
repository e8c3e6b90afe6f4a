"""Everything drawn over the picture: which of it is shown, and laid out for which window size."""

from __future__ import annotations

from typing import Any

from demo_game.game import Game
from demo_game.reports import summary
from demo_game.screens import Screen
from demo_game.ui.end import EndView
from demo_game.ui.help import HelpView
from demo_game.ui.hud import INTERVAL, Message, Readout, readout_values
from demo_game.ui.letter_view import LetterView
from demo_game.ui.menu import Menu
from demo_game.ui.menu_view import MenuView
from demo_game.ui.minimap import MapArea, MapPlace, Minimap
from demo_game.ui.start import StartView
from demo_game.ui.theme import Frame


class Overlay:
    """The views, made anew for every size of the window."""

    def __init__(self, menu: Menu, place: MapPlace) -> None:
        self.show_readout = False
        self.show_map = False
        self._menu, self._place = menu, place
        self._frame = Frame(1280, 720)
        self._ratio = 1.0
        self._views: dict[str, Any] = {}
        self._message = Message(self._frame)
        self._since = INTERVAL
        self._ended: object = None

    def resize(self, width: int, height: int, ratio: float = 1.0) -> None:
        """Lay out for another window; ratio is framebuffer px per window px."""
        self.delete()
        self._frame, self._ratio = Frame(width, height), ratio
        self._message = Message(self._frame)
        self._since = INTERVAL

    @property
    def pause_view(self) -> MenuView:
        """The pause menu, for the mouse."""
        return self._view("pause")

    def say(self, text: str) -> None:
        """Show a line for a few seconds."""
        self._message.say(text)

    def update(self, dt: float) -> None:
        """Let dt seconds pass."""
        self._message.update(dt)
        self._since += dt

    def draw(self, screen: Screen, game: Game, ms: float) -> None:
        """Draw what belongs to a screen."""
        if screen is Screen.START:
            self._view("start").draw()
            return
        if screen is Screen.PAUSE:
            self.pause_view.draw()
        elif screen is Screen.HELP:
            self._view("help").draw()
        elif screen is Screen.END:
            self._end_view(game).draw()
        else:
            if self.show_map:
                self._draw_map(game)
            if self.show_readout:
                self._draw_readout(game, ms)
            letter = self._view("letter")
            letter.show(game.letter)
            letter.draw()
            self._message.draw()

    def delete(self) -> None:
        """Give the GPU memory of all views back."""
        for view in self._views.values():
            view.delete()
        self._views.clear()
        self._message.delete()

    def _view(self, name: str) -> Any:
        if name not in self._views:
            frame = self._frame
            self._views[name] = {
                "start": lambda: StartView(frame),
                "pause": lambda: MenuView(frame, self._menu),
                "help": lambda: HelpView(frame),
                "letter": lambda: LetterView(frame),
                "readout": lambda: Readout(frame),
                "map": lambda: Minimap(frame, self._place, self._ratio),
            }[name]()
        return self._views[name]

    def _end_view(self, game: Game) -> EndView:
        # It says how this letter ended, so another one needs another view.
        ended = game.letter.state, game.letter.time
        if ended != self._ended and "end" in self._views:
            self._views.pop("end").delete()
        self._ended = ended
        if "end" not in self._views:
            self._views["end"] = EndView(self._frame, game.letter)
        return self._views["end"]

    def _draw_map(self, game: Game) -> None:
        x, _, z = game.pose.eye
        areas = [
            MapArea(area.center, area.radii, area.heading, area.soft_edge, area.rain_rate)
            for area in game.areas
        ]
        view = self._view("map")
        view.show(areas, (x, z), game.pose.yaw, game.letter.goal)
        view.draw()

    def _draw_readout(self, game: Game, ms: float) -> None:
        view = self._view("readout")
        if self._since >= INTERVAL:
            self._since = 0.0
            mood = game.mood.current
            view.show_strip(game.changer.history)
            view.show(
                readout_values(
                    here=game.weather.sample(game.pose.eye),
                    ms=ms,
                    stats=game.weather.stats,
                    wind=(mood.wind_speed, mood.wind_heading),
                    state=f"{game.state.replace('_', ' ')}, {_hour(game)}",
                    quality=game.settings.quality,
                    backend=game.weather.backend,
                    position=game.pose.eye,
                    weather=game.wholes.status(game.weather),
                    report=_report(game),
                )
            )
        view.draw()


def _report(game: Game) -> list[str]:
    """What was understood of a METAR report, or what is the matter with a file."""
    if game.given.file is not None:
        return game.given.file.lines()
    return [] if game.given.report is None else summary(game.given.report)


def _hour(game: Game) -> str:
    """The time of day: by its name, or as the file has it."""
    if game.given.file is not None and game.given.file.content.atmosphere is not None:
        minutes = int(float(game.sky.atmosphere.time) // 60.0) % 1440
        return f"{minutes // 60:02}:{minutes % 60:02} UTC"
    return game.sky.name
