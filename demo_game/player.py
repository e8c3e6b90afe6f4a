"""First-person walking: gravity, jump, collision, look. No OpenGL, no window, no esper."""

from __future__ import annotations

import math
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from demo_game.camera import Pose
from demo_game.collision import Colliders
from demo_game.flight import kept_in, velocity_of

EYE_HEIGHT = 1.66  # m above the feet
RADIUS = 0.30  # m, of the body's upright cylinder
BODY_HEIGHT = 1.78  # m
WALK_SPEED = 1.9  # m/s, a brisk walk; the tours walk at 1.4
RUN_SPEED = 6.0  # m/s
STEP_HEIGHT = 0.35  # m, climbed without a jump
GROUND_RESPONSE = 11.0  # 1/s, how fast the speed follows the keys on the ground
AIR_RESPONSE = 1.5  # 1/s, the same in the air
GRAVITY = 9.81  # m/s2
JUMP_SPEED = 4.2  # m/s, a jump of 0.9 m
PITCH_LIMIT = math.radians(88.0)
STRIDE = 1.5  # m walked in one cycle of the head (two steps)
BOB = 0.022  # m, the head's rise and fall
SWAY = math.radians(0.18)  # the head's lean
LONGEST_STEP = 1.0 / 60.0  # s, of the integration; a longer dt is cut into several
LONGEST_STRIDE = 0.1  # m moved between two looks at the walls: nothing thin is jumped over


class Ground(Protocol):
    """What a player needs to know of a place."""

    bounds: tuple[NDArray, NDArray]  # lowest and highest corner, m; only x and z count

    def floor_height(self, x: float, z: float, y: float) -> float:
        """Height of the floor at (x, z) for somebody whose feet are at y."""


@dataclass(frozen=True)
class Intent:
    """What the keys ask for."""

    forward: float = 0.0  # -1..1
    right: float = 0.0  # -1..1
    run: bool = False
    jump: bool = False


@dataclass
class Player:
    """A walker; `position` is at the feet."""

    ground: Ground
    colliders: Colliders = field(default_factory=Colliders)
    position: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))  # m
    velocity: NDArray[np.float64] = field(default_factory=lambda: np.zeros(3))  # m/s
    yaw: float = 0.0  # rad, 0 looks along -z
    pitch: float = 0.0  # rad, positive looks up
    on_ground: bool = True
    flying: bool = False
    _walked: float = 0.0  # m, for the head's bob
    _bob: float = 0.0  # 0..1, how much of the bob shows
    _lag: float = 0.0  # m, how far the eye is behind a step just climbed

    def place_at(self, x: float, z: float, yaw: float, y: float | None = None) -> None:
        """Stand at (x, z), at rest."""
        floor = self.ground.floor_height(x, z, math.inf if y is None else y)
        self.position = np.array((x, floor, z), np.float64)
        self.velocity = np.zeros(3)
        self.yaw, self.pitch = yaw, 0.0
        self.on_ground, self._lag, self._bob = True, 0.0, 0.0
        self.flying = False

    def switch_flight(self) -> None:
        """Fly, or come down again: from beyond the place's rim to its edge."""
        self.flying = not self.flying
        self.on_ground = False
        if not self.flying:
            (x0, _, z0), (x1, _, z1) = self.ground.bounds
            self.position[0] = min(max(self.position[0], x0), x1)
            self.position[2] = min(max(self.position[2], z0), z1)
            self.velocity *= 0.0

    def look(self, turn: float, rise: float) -> None:
        """Turn to the left by `turn` and look up by `rise`, rad."""
        self.yaw = (self.yaw + turn + math.pi) % math.tau - math.pi
        self.pitch = min(max(self.pitch + rise, -PITCH_LIMIT), PITCH_LIMIT)

    def pose(self) -> Pose:
        """The eye, with the head's bob while walking."""
        phase = math.tau * self._walked / STRIDE
        x, y, z = (float(value) for value in self.position)
        bob = self._bob * BOB * -math.cos(2 * phase)
        eye = (x, y + EYE_HEIGHT - self._lag + bob, z)
        return Pose(eye, self.yaw, self.pitch, self._bob * SWAY * math.sin(phase))

    def update(self, dt: float, intent: Intent) -> None:
        """Move for dt seconds (any length: it is cut into short steps)."""
        if not (math.isfinite(dt) and dt >= 0.0):
            raise ValueError(f"dt: got {dt!r}, allowed: finite and not negative, s")
        if self.flying:
            self._fly(dt, intent)
            return
        steps = max(1, math.ceil(dt / LONGEST_STEP - 1e-9))
        for index in range(steps):
            self._step(dt / steps, intent, jump=intent.jump and index == 0)

    def _fly(self, dt: float, intent: Intent) -> None:
        self.velocity = velocity_of(self.velocity, self.yaw, self.pitch, intent, dt)
        to = self.position + self.velocity * dt
        (x0, _, z0), (x1, _, z1) = self.ground.bounds
        x, z = min(max(float(to[0]), x0), x1), min(max(float(to[2]), z0), z1)
        self.position = kept_in(to, self.ground.floor_height(x, z, math.inf))
        self._bob = 0.0

    def _step(self, dt: float, intent: Intent, *, jump: bool) -> None:
        self._accelerate(dt, intent)
        if jump and self.on_ground:
            self.velocity[1] = JUMP_SPEED
            self.on_ground = False
        before = self.position.copy()
        self._move_sideways(dt)
        self._move_upright(dt)
        walked = math.hypot(self.position[0] - before[0], self.position[2] - before[2])
        if dt > 0.0:
            # What the walls took away is no speed any more.
            self.velocity[0] = (self.position[0] - before[0]) / dt
            self.velocity[2] = (self.position[2] - before[2]) / dt
            self._move_head(dt, walked)

    def _accelerate(self, dt: float, intent: Intent) -> None:
        forward, right = intent.forward, intent.right
        length = math.hypot(forward, right)
        speed = (RUN_SPEED if intent.run else WALK_SPEED) / max(length, 1.0)
        s, c = math.sin(self.yaw), math.cos(self.yaw)
        wanted_x = speed * (-s * forward + c * right)
        wanted_z = speed * (-c * forward - s * right)
        share = 1.0 - math.exp(-dt * (GROUND_RESPONSE if self.on_ground else AIR_RESPONSE))
        self.velocity[0] += share * (wanted_x - self.velocity[0])
        self.velocity[2] += share * (wanted_z - self.velocity[2])

    def _move_sideways(self, dt: float) -> None:
        dx, dz = self.velocity[0] * dt, self.velocity[2] * dt
        length = math.hypot(dx, dz)
        if length == 0.0:
            return
        pieces = max(1, math.ceil(length / LONGEST_STRIDE))
        near = self.colliders.near(self.position[0], self.position[2], length + 2 * RADIUS)
        (x0, _, z0), (x1, _, z1) = self.ground.bounds
        for _ in range(pieces):
            x, y, z = (float(value) for value in self.position)
            low, high = y + STEP_HEIGHT, y + BODY_HEIGHT
            to_x, to_z = near.push_out(x + dx / pieces, z + dz / pieces, RADIUS, low, high)
            to_x = float(min(max(to_x, x0), x1))
            to_z = float(min(max(to_z, z0), z1))
            for try_x, try_z in ((to_x, to_z), (to_x, z), (x, to_z)):
                # A floor too high to climb is a wall; slide along it where one axis is free.
                if self._floor(near, try_x, try_z, y) <= y + STEP_HEIGHT and near.is_free(
                    try_x, try_z, RADIUS - 0.02, low, high
                ):
                    self.position[0], self.position[2] = try_x, try_z
                    break
            floor = self._floor(near, self.position[0], self.position[2], y)
            if self.on_ground and floor > y:
                self._rise(floor)

    def _move_upright(self, dt: float) -> None:
        x, y, z = (float(value) for value in self.position)
        near = self.colliders.near(x, z, RADIUS)
        floor = self._floor(near, x, z, y)
        if self.on_ground and self.velocity[1] <= 0.0 and y - floor <= STEP_HEIGHT:
            self.velocity[1] = 0.0
            self._rise(floor)  # down a step or a slope without falling
            return
        fall = self.velocity[1] * dt - 0.5 * GRAVITY * dt * dt
        self.velocity[1] -= GRAVITY * dt
        head = near.bottom_above(x, z, RADIUS, y + BODY_HEIGHT - 1e-6)
        if y + fall + BODY_HEIGHT > head:
            fall, self.velocity[1] = head - BODY_HEIGHT - y, min(self.velocity[1], 0.0)
        self.on_ground = y + fall <= floor
        if self.on_ground:
            fall, self.velocity[1] = floor - y, 0.0
        self.position[1] = y + fall

    def _floor(self, near: Colliders, x: float, z: float, y: float) -> float:
        floor = self.ground.floor_height(x, z, y)
        return max(floor, near.top_below(x, z, RADIUS * 0.6, y + STEP_HEIGHT))

    def _rise(self, floor: float) -> None:
        self._lag += floor - float(self.position[1])
        self.position[1] = floor

    def _move_head(self, dt: float, walked: float) -> None:
        self._lag *= math.exp(-12.0 * dt)
        self._lag = min(max(self._lag, -0.4), 0.4)
        self._walked += walked
        wanted = min(walked / dt / WALK_SPEED, 1.4) if self.on_ground else 0.0
        self._bob += (1.0 - math.exp(-7.0 * dt)) * (wanted - self._bob)
