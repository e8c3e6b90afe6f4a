"""What keys and the mouse button do on the screens that are not the play itself."""

from __future__ import annotations

from typing import Protocol

from demo_game.ui.menu import Menu
from demo_game.ui.overlay import Screen

CONFIRM = ("RETURN", "ENTER", "NUM_ENTER")


class Screens(Protocol):
    """What the window can show and do."""

    screen_shown: Screen
    menu: Menu

    def resume(self) -> None:
        """Go on playing."""

    def again(self) -> None:
        """Begin anew, with another letter."""

    def back(self) -> None:
        """From the help page to what was there before."""

    def close(self) -> None:
        """End the game."""


def screen_key(name: str, screens: Screens) -> None:
    """Do what a key means on the screen that is shown."""
    screen = screens.screen_shown
    if screen is Screen.START:
        if name in (*CONFIRM, "SPACE"):
            screens.resume()
        elif name == "ESCAPE":
            screens.close()
    elif screen is Screen.END:  # not by Space, which one may hold from a jump
        if name in CONFIRM:
            screens.again()
        elif name == "ESCAPE":
            screens.resume()
    elif screen is Screen.HELP:
        if name == "ESCAPE":
            screens.back()
    elif screen is Screen.PAUSE:
        if name == "ESCAPE":
            screens.resume()
        else:
            screens.menu.key(name)


def screen_click(screens: Screens, row: int | None, side: int) -> None:
    """Do what a click means there; row and side are the pause menu's, where the mouse is."""
    screen = screens.screen_shown
    if screen is Screen.START:
        screens.resume()
    elif screen is Screen.END:
        screens.again()
    elif screen is Screen.HELP:
        screens.back()
    elif screen is Screen.PAUSE:
        screens.menu.click(row, side)
