"""The screens: which one is shown, and how one comes from each to the others."""

from __future__ import annotations

from enum import Enum
from typing import Protocol

from demo_game.settings import Settings
from demo_game.ui.menu import MenuActions, MouseRest, pause_menu

CONFIRM = ("RETURN", "ENTER", "NUM_ENTER")


class Screen(Enum):
    """What the player is looking at."""

    START = "start"
    PLAY = "play"
    PAUSE = "pause"
    HELP = "help"
    END = "end"


class Host(Protocol):
    """What the screens ask of the window."""

    def screen_changed(self, screen: Screen) -> None:
        """Another one is shown."""

    def new_letter(self) -> None:
        """Begin anew."""

    def settings_changed(self, field: str) -> None:
        """A setting has another value."""

    def close(self) -> None:
        """End the game."""


class Screens:
    """The screen that is shown, with the pause menu."""

    def __init__(self, settings: Settings, host: Host) -> None:
        self.shown = Screen.START
        self.menu = pause_menu(
            settings,
            MenuActions(
                resume=self.resume,
                settings_changed=host.settings_changed,
                again=self.again,
                help=self.open_help,
                quit=host.close,
            ),
        )
        self._host = host
        self._help_from = Screen.PAUSE
        self._end_seen = False
        self._mouse_rest = MouseRest()

    def frame(self) -> None:
        """A frame goes by."""
        self._mouse_rest.frame()

    def resume(self) -> None:
        """Go on playing."""
        self._show(Screen.PLAY)

    def again(self) -> None:
        """Begin anew, with another letter."""
        self._host.new_letter()
        self._end_seen = False
        self.resume()

    def end(self) -> None:
        """The letter's way is over; who goes on playing is told once."""
        if not self._end_seen:
            self._end_seen = True
            self._show(Screen.END)

    def pause(self) -> None:
        """Stop and show the menu; from the start screen or the help page nothing changes."""
        if self.shown is Screen.PLAY:
            self.menu.chosen = 0
            self._show(Screen.PAUSE)

    def toggle_pause(self) -> None:
        """The pause button of a gamepad, which also chooses on the other screens."""
        if self.shown is Screen.PLAY:
            self.pause()
        elif self.shown is Screen.END:
            self.again()
        else:
            self.resume()

    def open_help(self) -> None:
        """Show the help page."""
        self._help_from = self.shown
        self._show(Screen.HELP)

    def back(self) -> None:
        """From the help page to what was there before."""
        self._show(self._help_from)

    def toggle_help(self) -> None:
        """Open the help page, or close it."""
        self.back() if self.shown is Screen.HELP else self.open_help()

    def key(self, name: str) -> None:
        """Do what a key means on the screen that is shown, which is not the play itself."""
        if self.shown is Screen.START:
            if name in (*CONFIRM, "SPACE"):
                self.resume()
            elif name == "ESCAPE":
                self._host.close()
        elif self.shown is Screen.END:  # not by Space, which one may hold from a jump
            if name in CONFIRM:
                self.again()
            elif name == "ESCAPE":
                self.resume()
        elif self.shown is Screen.HELP:
            if name == "ESCAPE":
                self.back()
        elif self.shown is Screen.PAUSE:
            if name == "ESCAPE":
                self.resume()
            else:
                self.menu.key(name)

    def click(self, row: int | None, side: int) -> None:
        """Do what a click means there; row and side are the pause menu's, where the mouse is."""
        if self.shown is Screen.START:
            self.resume()
        elif self.shown is Screen.END:
            self.again()
        elif self.shown is Screen.HELP:
            self.back()
        elif self.shown is Screen.PAUSE:
            self.menu.click(row, side)

    def point(self, x: float, y: float, row: int | None) -> None:
        """The mouse is at (x, y) px, over a row of the pause menu or beside it."""
        if self._mouse_rest.moved(x, y):
            self.menu.point(row)

    def _show(self, screen: Screen) -> None:
        self.shown = screen
        self._mouse_rest = MouseRest()
        self._host.screen_changed(screen)
