"""The demo's screens: how keys and clicks lead from one to another."""

from __future__ import annotations

import pytest

from demo_game.screens import Screen, Screens
from demo_game.settings import Settings


class Host:
    """Notes what it is asked."""

    def __init__(self) -> None:
        self.asked: list[str] = []

    def screen_changed(self, screen: Screen) -> None:
        self.asked.append(screen.value)

    def new_letter(self) -> None:
        self.asked.append("new letter")

    def settings_changed(self, field: str) -> None:
        self.asked.append(field)

    def close(self) -> None:
        self.asked.append("closed")


@pytest.fixture
def host() -> Host:
    return Host()


@pytest.fixture
def screens(host: Host) -> Screens:
    return Screens(Settings(), host)


def test_the_start_screen_goes_on_by_space_and_closes_by_escape(
    screens: Screens, host: Host
) -> None:
    assert screens.shown is Screen.START
    screens.key("W")
    assert not host.asked
    screens.key("ESCAPE")
    assert host.asked == ["closed"]
    screens.key("SPACE")
    assert screens.shown is Screen.PLAY


def test_escape_closes_the_menu_and_another_pause_begins_at_its_top(screens: Screens) -> None:
    screens.pause()
    assert screens.shown is Screen.START, "there is nothing to pause yet"
    screens.resume()
    screens.pause()
    screens.key("DOWN")
    assert screens.menu.chosen == 1
    screens.key("ESCAPE")
    assert screens.shown is Screen.PLAY
    screens.pause()
    assert screens.menu.chosen == 0


def test_the_help_page_goes_back_to_where_it_was_opened(screens: Screens) -> None:
    screens.toggle_help()
    assert screens.shown is Screen.HELP
    screens.key("ESCAPE")
    assert screens.shown is Screen.START
    screens.resume()
    screens.toggle_help()
    screens.toggle_help()
    assert screens.shown is Screen.PLAY
    screens.open_help()
    screens.click(None, 1)
    assert screens.shown is Screen.PLAY


def test_the_end_is_shown_once_a_letter_and_not_left_by_a_held_space(
    screens: Screens, host: Host
) -> None:
    screens.resume()
    screens.end()
    assert screens.shown is Screen.END
    screens.key("SPACE")
    assert screens.shown is Screen.END
    screens.key("ESCAPE")
    screens.end()
    assert screens.shown is Screen.PLAY, "who goes on is not told again"
    screens.again()
    assert "new letter" in host.asked
    screens.end()
    assert screens.shown is Screen.END
    screens.toggle_pause()
    assert screens.shown is Screen.PLAY and host.asked.count("new letter") == 2


def test_the_menu_acts_on_clicks_and_tells_what_changed(screens: Screens, host: Host) -> None:
    screens.resume()
    screens.pause()
    quality = next(k for k, item in enumerate(screens.menu.items) if item.label == "Quality")
    screens.click(quality, 1)
    assert host.asked[-1] == "quality" and screens.shown is Screen.PAUSE
    screens.click(0, 1)
    assert screens.shown is Screen.PLAY


def test_a_mouse_just_set_free_chooses_nothing(screens: Screens) -> None:
    screens.resume()
    screens.pause()
    screens.point(300.0, 200.0, 3)
    assert screens.menu.chosen == 0
    for _ in range(4):
        screens.frame()
    screens.point(300.0, 200.0, 3)
    assert screens.menu.chosen == 0
    screens.point(320.0, 200.0, 3)
    assert screens.menu.chosen == 3
