"""`WorldCamera`: a player's eye, on foot or in the air."""

from __future__ import annotations

import math
from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from weather_ecs.editor.camera import perspective

EYE = 1.7  # m over the ground
STEEPEST = math.radians(89.0)
WALK, FLIGHT = 4.0, 90.0  # m/s
LOWEST, HIGHEST = 1.0, 30_000.0  # m over the ground, of a flight
FARTHEST = 1.0e6  # m from the origin
NARROWEST, WIDEST = math.radians(4.0), math.radians(100.0)  # of the picture's height
NEAR, FAR = 0.4, 150_000.0  # m
_TURN = 0.0045  # rad that a pixel of dragging turns, at the usual width of view

Vector = NDArray[np.float64]
USUAL_FOV = math.radians(60.0)


@dataclass(slots=True)
class WorldCamera:
    """Yaw 0 looks north, along -z, and grows counter-clockwise; pitch up from level."""

    x: float = 0.0  # m
    z: float = 55.0
    height: float = EYE  # m over the ground
    yaw: float = 0.0  # rad
    pitch: float = math.radians(12.0)  # rad
    fov: float = USUAL_FOV  # rad, of the picture's height
    flying: bool = False
    ground: Callable[[float, float], float] = lambda x, z: 0.0  # m, of the land at (x, z)

    def eye(self) -> Vector:
        """Where it is, m."""
        return np.array([self.x, self.ground(self.x, self.z) + self.height, self.z])

    @property
    def bearing(self) -> float:
        """Degrees clockwise from north that it looks to, 0 to 360."""
        return math.degrees(-self.yaw) % 360.0

    def forward(self) -> Vector:
        """Unit vector along which it looks."""
        level = math.cos(self.pitch)
        return np.array(
            [-level * math.sin(self.yaw), math.sin(self.pitch), -level * math.cos(self.yaw)]
        )

    def turn_matrix(self) -> Vector:
        """(4, 4): from the world's axes to the eye's."""
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        forward = self.forward()
        right = np.array([c, 0.0, -s])
        matrix = np.eye(4)
        matrix[0, :3], matrix[1, :3], matrix[2, :3] = right, np.cross(right, forward), -forward
        return matrix

    def view(self) -> Vector:
        """(4, 4) for column vectors."""
        matrix = self.turn_matrix()
        matrix[:3, 3] = -matrix[:3, :3] @ self.eye()
        return matrix

    def projection(self, aspect: float) -> Vector:
        """(4, 4) for column vectors."""
        return perspective(self.fov, aspect, NEAR, FAR)

    def look(self, dx: float, dy: float) -> None:
        """Turn by a drag of so many pixels: what was under the mouse stays near it."""
        turn = _TURN * self.fov / USUAL_FOV
        self.yaw = math.remainder(self.yaw + dx * turn, math.tau)
        self.pitch = min(max(self.pitch + dy * turn, -STEEPEST), STEEPEST)

    def zoom(self, notches: float) -> None:
        """Look closer by so many notches of the wheel."""
        self.fov = min(max(self.fov * 0.9 ** min(max(notches, -50.0), 50.0), NARROWEST), WIDEST)

    def move(self, ahead: float, aside: float, above: float, dt: float, fast: bool = False) -> None:
        """Walk, or fly, each of the first three -1 to 1, for `dt` seconds."""
        level = math.hypot(ahead, aside)
        if above and not self.flying:
            self.flying = True
        # The higher, the faster: a layer of clouds is kilometres wide.
        speed = max(FLIGHT, 0.5 * self.height) if self.flying else WALK
        reach = speed * (5.0 if fast else 1.0) * dt / max(level, 1.0)
        c, s = math.cos(self.yaw), math.sin(self.yaw)
        self.x = _within(self.x + reach * (aside * c - ahead * s))
        self.z = _within(self.z - reach * (ahead * c + aside * s))
        if self.flying:
            climb = ahead * math.sin(self.pitch) + above
            self.height = min(max(self.height + reach * climb, LOWEST), HIGHEST)

    def land(self) -> None:
        """Stand on the ground."""
        self.flying, self.height = False, EYE

    def go(self, x: float, z: float) -> None:
        """Stand elsewhere, as high as before."""
        self.x, self.z = _within(x), _within(z)


def _within(value: float) -> float:
    return min(max(value, -FARTHEST), FARTHEST)
