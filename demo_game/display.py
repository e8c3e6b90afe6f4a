"""Opens the window, or says why there is none."""

from __future__ import annotations

import importlib
import logging
from typing import TYPE_CHECKING, Unpack

import pyglet

from demo_game.beginning import Beginning
from demo_game.preparing import Abandoned
from demo_game.settings import Settings

if TYPE_CHECKING:
    from demo_game.window import GameWindow

VERSIONS = ((4, 6), (4, 5), (4, 3), (4, 1), (3, 3))  # newest first: compute shaders need 4.3


class NoDisplay(Exception):
    """There is no display to open a window on, or none with OpenGL 3.3."""


def make_window(
    settings: Settings, *, size: tuple[int, int] = (1280, 720), **beginning: Unpack[Beginning]
) -> GameWindow:
    """The game's window with the newest OpenGL there is.

    Raises NoDisplay, Abandoned, or the weather's errors.
    """
    pyglet.options.dpi_scaling = "real"
    try:
        windows = importlib.import_module("pyglet.window")
    except Exception as error:  # pyglet opens the display on import; what fails differs by system
        raise NoDisplay(_reason(error)) from error
    from pyglet.gl import Config

    from demo_game.window import GameWindow

    reason: Exception | None = None
    for major, minor in VERSIONS:
        config = Config(double_buffer=True, depth_size=24, major_version=major, minor_version=minor)
        try:
            surface = windows.Window(1, 1, config=config, visible=False)
        except Exception as error:  # each platform has its own for a version it does not have
            reason = error
            logging.getLogger("demo_game").debug("no OpenGL %d.%d: %s", major, minor, error)
            continue
        surface.close()
        return GameWindow(settings, config, size=size, **beginning)
    raise NoDisplay(_reason(reason))


def open_window(settings: Settings, **beginning: Unpack[Beginning]) -> int:
    """Play until the window is closed; returns the exit code."""
    try:
        window = make_window(settings, **beginning)
    except Abandoned:
        return 0
    try:
        window.play()
    finally:
        window.shut()
    return 0


def _reason(error: Exception | None) -> str:
    text = " ".join(str(error).split()) if error is not None else ""
    return text or type(error).__name__
