"""`WalkSound`: the game's sound, told by the game itself and by its strikes of lightning."""

from __future__ import annotations

from typing import Any

import esper

from demo_game.settings import Settings

from .listener import Walk, listen
from .soundscape import Soundscape


class WalkSound:
    """Follows a game whose esper world is the current one; without a device it does nothing."""

    def __init__(
        self, game: Walk, settings: Settings, seed: int = 0, *, sound: Soundscape | None = None
    ) -> None:
        self._game, self._settings = game, settings
        self.sound = Soundscape(seed) if sound is None else sound
        esper.set_handler("strike", self.on_strike)

    def update(self, dt: float, paused: bool = False) -> None:
        """Hear what the player is in; while the game is paused it fades out."""
        if not self.sound.is_heard:
            return
        self.sound.volume = self._settings.volume / 100.0
        self.sound.muted = self._settings.muted
        if paused:
            self.sound.hush()
        else:
            self.sound.update(dt, **listen(self._game)._asdict())

    def on_strike(self, strike: Any, heard: Any = ()) -> None:
        """Lightning has struck: its thunder is on its way to the player."""
        self.sound.thunder(strike.distance(self._game.pose.eye))

    def close(self) -> None:
        """Stop the sound; a second call does nothing."""
        self.sound.close()
