"""`Tour`: a scripted way, and what the weather does on it."""

from __future__ import annotations

import math
from collections.abc import Callable
from typing import Protocol

from demo_game.camera import Pose
from demo_game.player import BOB, STRIDE, SWAY
from demo_game.plays import Play
from demo_game.route import Route

WALKING = 1.4  # m/s


class Tour(Protocol):
    """A pose for every moment, and a course of the weather if the tour has one."""

    name: str
    play: Play | None

    def pose(self, time: float) -> Pose:
        """Eye and look at `time` seconds."""

    def stage(self, time: float) -> str:
        """Name of the stage at `time`."""


class WalkTour:
    """A tour on foot."""

    def __init__(
        self,
        name: str,
        route: Route,
        along: Callable[[float], float],
        look: Callable[[float], tuple[float, float]],
        stages: Callable[[float], str],
        *,
        hurried: bool = False,
        play: Play | None = None,
    ) -> None:
        self.name = name
        self.play: Play | None = play
        self._route, self._along, self._look, self._stages = route, along, look, stages
        self._hurried = hurried

    def pose(self, time: float) -> Pose:
        """Eye and look at `time` seconds."""
        along = self._along(time)
        speed = (self._along(time + 0.02) - self._along(time - 0.02)) / 0.04
        # Where the way is hurried the steps follow the clock: nobody takes 15 of them a second.
        phase = math.tau * (time * WALKING if self._hurried else along) / STRIDE
        share = min(max(speed / WALKING, 0.0), 1.0)
        x, y, z = self._route.eye(along)
        yaw, pitch = self._look(time)
        eye = (x, y - share * BOB * math.cos(2 * phase), z)
        return Pose(eye, yaw, pitch, share * SWAY * math.sin(phase))

    def stage(self, time: float) -> str:
        """Name of the stage at `time`."""
        return self._stages(time)
