"""The pause menu: what it holds and how keys and mouse move through it; drawn elsewhere."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

from demo_game.settings import (
    BACKENDS,
    FIELDS_OF_VIEW,
    QUALITIES,
    SENSITIVITIES,
    VOLUMES,
    Settings,
    step,
)


@dataclass(frozen=True)
class Item:
    """A row: an action, or a value that is changed in place."""

    label: str
    act: Callable[[], None] | None = None
    change: Callable[[int], None] | None = None  # by -1 or +1
    value: Callable[[], str] | None = None


class Menu:
    """Rows with one of them chosen."""

    def __init__(self, title: str, items: list[Item]) -> None:
        self.title = title
        self.items = items
        self.chosen = 0

    def key(self, name: str) -> bool:
        """Handle a key by its name; whether it meant something here."""
        if name in ("UP", "W"):
            self.chosen = (self.chosen - 1) % len(self.items)
        elif name in ("DOWN", "S"):
            self.chosen = (self.chosen + 1) % len(self.items)
        elif name in ("LEFT", "A"):
            self._change(-1)
        elif name in ("RIGHT", "D"):
            self._change(1)
        elif name in ("RETURN", "ENTER", "NUM_ENTER", "SPACE"):
            self.activate()
        else:
            return False
        return True

    def activate(self) -> None:
        """Do what the chosen row does; a value goes on to its next one."""
        item = self.items[self.chosen]
        if item.act is not None:
            item.act()
        else:
            self._change(1)

    def point(self, row: int | None) -> None:
        """The mouse is over a row."""
        if row is not None:
            self.chosen = row

    def click(self, row: int | None, side: int) -> None:
        """The mouse was pressed on a row: side -1 on its back arrow, else +1."""
        if row is None:
            return
        self.chosen = row
        item = self.items[row]
        if item.change is not None:
            item.change(side)
        else:
            self.activate()

    def _change(self, by: int) -> None:
        change = self.items[self.chosen].change
        if change is not None:
            change(by)


class MouseRest:
    """Tells a mouse that the player moves from one that the game has just set free.

    Setting it free moves it to where it was before, and a menu must not take that for a choice.
    """

    SETTLING = 3  # frames
    PLAY = 3  # px

    def __init__(self) -> None:
        self._frames = 0
        self._at: tuple[float, float] | None = None

    def frame(self) -> None:
        """A frame was drawn."""
        self._frames += 1

    def moved(self, x: float, y: float) -> bool:
        """The mouse is at (x, y): whether the player put it there."""
        if self._at is None or self._frames < self.SETTLING:
            self._at = (x, y)
        return abs(x - self._at[0]) + abs(y - self._at[1]) > self.PLAY


@dataclass(frozen=True)
class MenuActions:
    """What the pause menu asks of the window."""

    resume: Callable[[], None]
    settings_changed: Callable[[str], None]  # the name of the field that changed
    again: Callable[[], None]  # another letter
    help: Callable[[], None]
    quit: Callable[[], None]


def pause_menu(settings: Settings, actions: MenuActions) -> Menu:
    """The menu behind Escape, which changes `settings` in place."""

    def choice(label: str, field: str, choices: tuple, show: Callable[[], str]) -> Item:
        def change(by: int) -> None:
            setattr(settings, field, step(choices, getattr(settings, field), by))
            actions.settings_changed(field)

        return Item(label, change=change, value=show)

    on_off = (False, True)
    return Menu(
        "Paused",
        [
            Item("Resume", act=actions.resume),
            choice("Quality", "quality", QUALITIES, lambda: settings.quality),
            choice("Rain engine", "backend", BACKENDS, lambda: settings.backend),
            choice(
                "Mouse sensitivity",
                "sensitivity",
                SENSITIVITIES,
                lambda: f"{settings.sensitivity:g} ×",
            ),
            choice("Invert mouse", "invert", on_off, lambda: "on" if settings.invert else "off"),
            choice(
                "Field of view",
                "field_of_view",
                FIELDS_OF_VIEW,
                lambda: f"{settings.field_of_view:g}°",
            ),
            choice(
                "Full screen",
                "fullscreen",
                on_off,
                lambda: "on" if settings.fullscreen else "off",
            ),
            choice("Sound", "volume", VOLUMES, lambda: f"{settings.volume} %"),
            Item("Another letter", act=actions.again),
            Item("Help", act=actions.help),
            Item("Quit", act=actions.quit),
        ],
    )
