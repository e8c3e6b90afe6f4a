"""`Sharpness`: fewer pixels while a picture moves on a slow machine, all of them at rest."""

from __future__ import annotations

SLOW, FAST = 1.0 / 31.0, 1.0 / 50.0  # s of a frame: more takes pixels away, less gives them back
LEAST = 0.45  # of the sides
REST = 0.12  # s without a change, after which the picture is taken with all pixels


class Sharpness:
    """What share of a picture's sides is drawn."""

    def __init__(self) -> None:
        self.share = 1.0
        self._moved = False  # in the last frame
        self._rested = 0.0  # s
        self._is_sharp = False  # what was drawn last
        self._draws = 1.0

    def wants(self, dt: float, *, moves: bool) -> bool:
        """Whether the picture is to be drawn now; dt: s that the last frame took."""
        if moves:
            if self._moved and dt > SLOW:
                self.share = max(self.share * 0.85, LEAST)
            elif self._moved and dt < FAST:
                self.share = min(self.share * 1.06, 1.0)
            self._draws, self._rested = self.share, 0.0
        else:
            self._rested += dt
            if self._is_sharp or self._rested < REST:
                self._moved = False
                return False
            self._draws = 1.0
        self._moved, self._is_sharp = moves, self._draws >= 1.0
        return True

    @property
    def rests(self) -> bool:
        """Whether the last picture has all of its pixels: no other is to come by itself."""
        return self._is_sharp and not self._moved

    def pixels(self, whole: tuple[int, int]) -> tuple[int, int]:
        """Of the picture that is drawn now."""
        return max(round(whole[0] * self._draws), 1), max(round(whole[1] * self._draws), 1)
