"""`Pace`: when the window is drawn: at every tick while something moves, else now and then."""

from __future__ import annotations

AWAKE = 0.7  # s after an event: what it has set going, and the tooltip that follows, are seen
DOZE = 0.25  # s between two frames at rest: a cursor blinks, the file on disk is looked at


class Pace:
    """Says whether a frame is due; times are those of one steady clock, in s."""

    def __init__(self) -> None:
        self._event = 0.0
        self._frame = -DOZE

    def wake(self, now: float) -> None:
        """Something has come in: a mouse, a key, a part of the window that was hidden."""
        self._event = now

    def due(self, now: float, *, moves: bool) -> bool:
        """Whether to draw now; `moves` says whether the last frame is to be followed by another."""
        if moves or now - self._event < AWAKE or now - self._frame >= DOZE:
            self._frame = now
            return True
        return False
