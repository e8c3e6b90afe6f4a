"""`OrbitCamera`: round a point, along the picture, nearer and farther, or free as a bird."""

from __future__ import annotations

import math
from dataclasses import dataclass, field

import numpy as np
from numpy.typing import NDArray

STEEPEST = math.radians(89.0)
NEAREST, FARTHEST = 1.0, 2.0e6  # m, of the point that is looked at
FILLED = 1.06  # of the picture, by the box that is framed: clouds are round
SPEED = 0.7  # distances to the point in a second of flight
_TURN = 0.0075  # rad that a pixel of dragging turns

Vector = NDArray[np.float64]


def perspective(fov: float, aspect: float, near: float, far: float) -> NDArray[np.float64]:
    """(4, 4) for column vectors. fov: rad, upright; near, far: m."""
    scale = 1.0 / math.tan(0.5 * fov)
    matrix = np.zeros((4, 4))
    matrix[0, 0], matrix[1, 1] = scale / max(aspect, 1e-3), scale
    matrix[2, 2], matrix[2, 3] = (far + near) / (near - far), 2.0 * far * near / (near - far)
    matrix[3, 2] = -1.0
    return matrix


@dataclass(slots=True)
class OrbitCamera:
    """Looks from `distance` metres away at `target`; yaw 0 looks along -z, pitch up from level."""

    target: Vector = field(default_factory=lambda: np.zeros(3))  # m
    distance: float = 2500.0  # m
    yaw: float = 0.6  # rad, counter-clockwise seen from above
    pitch: float = -0.02  # rad, below 0 looks down
    fov: float = math.radians(42.0)  # rad, of the picture's height

    # Where it looks

    def forward(self) -> Vector:
        """Unit vector along which it looks."""
        level = math.cos(self.pitch)
        return np.array(
            [-level * math.sin(self.yaw), math.sin(self.pitch), -level * math.cos(self.yaw)]
        )

    def right(self) -> Vector:
        """Unit vector to the right of the picture."""
        return np.array([math.cos(self.yaw), 0.0, -math.sin(self.yaw)])

    def up(self) -> Vector:
        """Unit vector to the top of the picture."""
        rise = math.sin(self.pitch)
        return np.array(
            [rise * math.sin(self.yaw), math.cos(self.pitch), rise * math.cos(self.yaw)]
        )

    def eye(self) -> Vector:
        """Where it stands, m."""
        return self.target - self.distance * self.forward()

    def view(self, origin: Vector | None = None) -> Vector:
        """(4, 4) for column vectors, of a world in which `origin` is the camera's (0, 0, 0)."""
        eye = self.eye() if origin is None else self.eye() + origin
        matrix = np.eye(4)
        matrix[0, :3], matrix[1, :3], matrix[2, :3] = self.right(), self.up(), -self.forward()
        matrix[:3, 3] = -matrix[:3, :3] @ eye
        return matrix

    def projection(self, aspect: float) -> Vector:
        """(4, 4) for column vectors; as deep as what it may look at."""
        near = min(max(0.002 * self.distance, 0.5), 50.0)
        far = max(80.0 * self.distance, 120_000.0)
        return perspective(self.fov, aspect, near, far)

    # How it moves

    def orbit(self, dx: float, dy: float) -> None:
        """Turn round the point by a drag of so many pixels."""
        self.yaw = math.remainder(self.yaw - dx * _TURN, 2.0 * math.pi)
        self.pitch = min(max(self.pitch - dy * _TURN, -STEEPEST), STEEPEST)

    def look(self, dx: float, dy: float) -> None:
        """Turn on the spot."""
        eye = self.eye()
        self.orbit(0.5 * dx, 0.5 * dy)
        self.target = eye + self.distance * self.forward()

    def pan(self, dx: float, dy: float, height: float) -> None:
        """Move along the picture, `height` pixels high: what is under the mouse stays there."""
        metres = 2.0 * self.distance * math.tan(0.5 * self.fov) / max(height, 1.0)
        self.target = self.target + metres * (dy * self.up() - dx * self.right())

    def zoom(self, notches: float) -> None:
        """Come nearer by so many notches of the wheel."""
        self.distance = min(max(self.distance * 0.88**notches, NEAREST), FARTHEST)

    def fly(self, ahead: float, aside: float, above: float, dt: float) -> None:
        """Move freely, each of the first three -1 to 1, for `dt` seconds."""
        way = ahead * self.forward() + aside * self.right() + np.array([0.0, above, 0.0])
        self.target = self.target + way * (SPEED * self.distance * dt)

    def sees(self, low: Vector, high: Vector, aspect: float = 1.5) -> bool:
        """Whether all of a box is in the picture."""
        signs = np.array(np.meshgrid((0.0, 1.0), (0.0, 1.0), (0.0, 1.0))).reshape(3, -1)
        corners = low[:, None] + (high - low)[:, None] * signs
        clip = self.projection(aspect) @ self.view() @ np.vstack([corners, np.ones(8)])
        return bool((np.abs(clip[:2]) <= clip[3]).all())

    def frame(self, low: Vector, high: Vector, aspect: float = 1.5) -> None:
        """Bring a box into the picture, as large as it fits, from the side it is seen from now."""
        center, half = 0.5 * (low + high), 0.5 * (high - low)
        tall = math.tan(0.5 * self.fov) * FILLED
        wide = tall * aspect
        # A corner is in the picture where the camera is as far from it as it is off the axis.
        rights, ups = half * np.abs(self.right()), half * np.abs(self.up())
        ahead = float((half * np.abs(self.forward())).sum())
        needed = max(float(rights.sum()) / max(wide, 1e-3), float(ups.sum()) / tall)
        self.target = np.array(center, np.float64)
        self.distance = min(max(needed + 0.5 * ahead, NEAREST), FARTHEST)
