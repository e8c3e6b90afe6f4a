"""`ThingSnow`: snow on things that move, which no map of places can hold.

Kept for the occluders that the game asks about, from the first time it does: what falls on the top
of the thing while it stands upright, less what melts; it slides off what leans. Belongs to drawing,
as occluders do, and is in no snapshot.
"""

from __future__ import annotations

import math
from typing import Protocol
from weakref import WeakKeyDictionary

import numpy as np

from weather_ecs.components import Occluder
from weather_ecs.frame import FrameData
from weather_ecs.physics.snow_cover import DENSITY, STEEPEST, melt_rate, stays
from weather_ecs.physics.wetness import MM_PER_S

_ABOVE = 0.3  # m over its top, where nothing of its own shelters a thing
_SLIDING = 0.5  # s in which snow leaves what leans too much, to 1/e


class Falling(Protocol):
    """What is known of the weather at a point."""

    @property
    def snow_rate(self) -> float:
        """mm/h of water; 0 under shelter."""


class Field(Protocol):
    """What knows the weather at a point."""

    def at(self, x: float, y: float, z: float) -> Falling:
        """The weather there."""


class ThingSnow:
    """mm of water that lie as snow on every occluder that was asked about."""

    def __init__(self) -> None:
        self._things: WeakKeyDictionary[Occluder, tuple[float, float]] = WeakKeyDictionary()

    def depth(self, thing: Occluder, field: Field, frame: FrameData) -> float:
        """Depth in m on a thing's top in a frame; a clock set back begins anew."""
        time = frame.time
        snow, then = self._things.get(thing, (0.0, time))
        seconds = time - then
        if seconds < 0.0:
            snow, seconds = 0.0, 0.0
        if seconds > 0.0:
            snow = self._later(thing, snow, field, frame, seconds)
        self._things[thing] = snow, time
        return snow / DENSITY

    def _later(
        self, thing: Occluder, snow: float, field: Field, frame: FrameData, seconds: float
    ) -> float:
        (x, y, z), up = _top(thing)
        falls = field.at(x, y + _ABOVE, z).snow_rate * MM_PER_S * float(stays(up))
        falls *= frame.flakes.settling
        if up < STEEPEST:
            snow *= math.exp(-seconds / _SLIDING)
        return max(snow + (falls - float(melt_rate(frame.air.wet_bulb))) * seconds, 0.0)


def _top(thing: Occluder) -> tuple[tuple[float, float, float], float]:
    """The middle of a thing's upper side in the world, m, and how far its own up points up."""
    transform = np.eye(4) if thing.transform is None else thing.transform
    axis = transform[:3, 1]
    up = float(axis[1] / max(float(np.linalg.norm(axis)), 1e-12))
    if thing.vertices is None or not len(thing.vertices):
        x, y, z = transform[:3, 3].tolist()
        return (x, y, z), up
    low, high = thing.vertices.min(axis=0), thing.vertices.max(axis=0)
    corners = np.array([[(low, high)[i >> k & 1][k] for k in range(3)] for i in range(8)])
    world = corners @ transform[:3, :3].T + transform[:3, 3]
    (x, _, z), y = world.mean(axis=0).tolist(), float(world[:, 1].max())
    return (x, y, z), up
