"""What the window shows while the place is built."""

from __future__ import annotations

import pyglet

from demo_game.ui.preparing import PreparingView
from demo_game.ui.surface import prepare_for_pyglet
from demo_game.ui.theme import Frame


class PreparingScreen:
    """Keeps the window alive and drawn until there is a game, unless it is closed before."""

    def __init__(self, window: pyglet.window.Window) -> None:
        self.closed = False
        self._window = window
        self._drawn = (0, 0, 0)

    def keep_alive(self, seconds: float) -> bool:
        """Handle events and draw what has changed; whether to go on."""
        window = self._window
        window.dispatch_events()
        state = (window.width, window.height, int(seconds * 2))
        if self.closed or window.width < 1 or window.height < 1 or state == self._drawn:
            return not self.closed
        self._drawn = state
        window.switch_to()
        prepare_for_pyglet(window)
        view = PreparingView(Frame(window.width, window.height))
        view.draw(seconds)
        view.delete()
        window.flip()
        return True
