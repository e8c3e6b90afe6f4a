"""A way over the ground and where one looks on it: the parts a tour is made of."""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from demo_game.camera import yaw_pitch
from demo_game.curve import Path, rounded
from demo_game.player import EYE_HEIGHT, Ground

LOOK_AHEAD = 5.0  # m along the way that a walker's eyes are
STEP_SMOOTHING = 1.0  # m over which the eye follows a step
LOOK_SAMPLES = 1001
LOOK_SMOOTHING = 43  # samples over which a turn of the head is eased
PITCH_AHEAD = math.radians(-1.0)


@dataclass(frozen=True)
class Key:
    """A moment of a tour: at the share `u` of its time be at a corner of the way."""

    u: float  # 0..1
    corner: int  # index of the way's point
    stage: str = ""  # the stage that begins here, if one does


@dataclass(frozen=True)
class Glance:
    """At the share `u` of a tour's time look at a point, or along the way."""

    u: float  # 0..1
    point: tuple[float, float, float] | None = None  # m, world axes


def stage_at(keys: Sequence[Key], u: float) -> str:
    """Name of the stage at the share `u`."""
    current = keys[0].stage
    for key in keys:
        if key.stage and key.u <= u + 1e-9:
            current = key.stage
    return current


class Route:
    """A path over the ground, with the eye's height along it; at `turns` (corners) it goes back."""

    def __init__(
        self,
        ground: Ground,
        points: Sequence[tuple[float, float]],
        rounding: float,
        turns: Sequence[int] = (),
    ) -> None:
        self.path = Path(points, rounding)
        self._turns = [float(self.path.corner_lengths[index]) for index in turns]
        heights, y = [], math.inf
        for _, x, z in self.path.table.tolist():
            y = ground.floor_height(x, z, y)
            heights.append(y)
        self._at = self.path.table[:, 0]
        self._eye = rounded(np.array(heights), STEP_SMOOTHING) + EYE_HEIGHT

    def eye(self, along: float) -> tuple[float, float, float]:
        """The eye after `along` metres, without the head's bob."""
        x, z = self.path(along)
        return x, float(np.interp(along, self._at, self._eye)), z

    def heading(self, along: float) -> float:
        """Yaw of a walker who looks a few metres ahead, but not past a turn back."""
        end = min([turn for turn in self._turns if turn >= along] + [self.path.length])
        start = min(along, end - LOOK_AHEAD / 4)
        (x0, z0), (x1, z1) = self.path(start), self.path(min(start + LOOK_AHEAD, end))
        return yaw_pitch(np.array((x1 - x0, 0.0, z1 - z0)))[0]


class Look:
    """Yaw and pitch over the share 0..1 of a tour, from a table."""

    def __init__(self, yaw: NDArray[np.float64], pitch: NDArray[np.float64]) -> None:
        self._at = np.linspace(0.0, 1.0, len(yaw))
        self._yaw = _eased(np.unwrap(yaw))
        self._pitch = _eased(pitch)

    def __call__(self, u: float) -> tuple[float, float]:
        """Yaw and pitch at the share u."""
        yaw = float(np.interp(u, self._at, self._yaw))
        return yaw, float(np.interp(u, self._at, self._pitch))

    @classmethod
    def towards(cls, direction: NDArray[np.float64]) -> Look:
        """Always the same way."""
        yaw, pitch = yaw_pitch(direction)
        return cls(np.full(2, yaw), np.full(2, pitch))

    @classmethod
    def ahead(cls, route: Route) -> Look:
        """Along the way; the share is that of the path's length."""
        along = np.linspace(0.0, route.path.length, LOOK_SAMPLES)
        yaw = np.array([route.heading(float(at)) for at in along])
        return cls(yaw, np.full(LOOK_SAMPLES, PITCH_AHEAD))

    @classmethod
    def between(
        cls, route: Route, along: Callable[[float], float], glances: Sequence[Glance]
    ) -> Look:
        """Along the way, except where there are glances, and gently in between."""
        yaws, pitches = [], []
        for u in np.linspace(0.0, 1.0, LOOK_SAMPLES).tolist():
            base = route.heading(along(u))
            point, weight = _watched(glances, u)
            aim, rise = base, PITCH_AHEAD
            if point is not None:
                aim, rise = yaw_pitch(point - np.array(route.eye(along(u))))
            turn = (aim - base + math.pi) % math.tau - math.pi
            yaws.append(base + weight * turn)
            pitches.append(PITCH_AHEAD + weight * (rise - PITCH_AHEAD))
        return cls(np.array(yaws), np.array(pitches))


def _watched(glances: Sequence[Glance], u: float) -> tuple[NDArray[np.float64] | None, float]:
    """The point that is looked at and how much it draws the look (0..1)."""
    for before, after in zip(glances, glances[1:], strict=False):
        if before.u <= u <= after.u:
            break
    t = min(max((u - before.u) / (after.u - before.u), 0.0), 1.0)
    t = t * t * (3.0 - 2.0 * t)
    if before.point is None and after.point is None:
        return None, 0.0
    if before.point is None:
        return np.array(after.point), t
    if after.point is None:
        return np.array(before.point), 1.0 - t
    return (1.0 - t) * np.array(before.point) + t * np.array(after.point), 1.0


def _eased(values: NDArray[np.float64]) -> NDArray[np.float64]:
    if len(values) <= 2 * LOOK_SMOOTHING:
        return values
    kernel = np.hanning(2 * LOOK_SMOOTHING + 1)[1:-1]
    kernel /= kernel.sum()
    return np.convolve(np.pad(values, LOOK_SMOOTHING - 1, mode="edge"), kernel, "valid")
