"""`RainAreaSystem`: moves the rain areas."""

from __future__ import annotations

from collections.abc import Callable

import esper
import numpy as np
from numpy.typing import NDArray

from weather_ecs.clock import STEP
from weather_ecs.components import RainArea
from weather_ecs.components._base import FAR, count_assignment
from weather_ecs.frame import AREA_DTYPE, WindProfile
from weather_ecs.physics.front import SETTLED, Dry
from weather_ecs.physics.wind import height_share
from weather_ecs.systems.queries import alive
from weather_ecs.systems.rain_fronts import RainFronts
from weather_ecs.systems.state import WeatherState

# Twice as fast as by its name; whoever moves an area counts the revision himself.
_put_center: Callable[[RainArea, tuple[float, float]], None] = vars(RainArea)["center"].__set__


def drift_velocity(
    area: RainArea, wind: tuple[float, float, float], profile: WindProfile
) -> tuple[float, float]:
    """Velocity of an area over the ground, (x, z), m/s: its own and its share of the wind at its
    ceiling, where its cloud is."""
    x, z = area.velocity
    drift = area.drift
    if drift > 0.0:
        drift *= height_share(area.ceiling - profile.ground, profile.reference, profile.exponent)
    return x + drift * wind[0], z + drift * wind[2]


def area_rows(found: list[tuple[int, RainArea]], fronts: RainFronts) -> NDArray:
    """Areas by uid as read-only rows of AREA_DTYPE, with the rain that is in the air."""
    rows = [
        (
            uid,
            area.center,
            area.radii,
            area.heading,
            fronts.rate(uid, area),
            min(area.soft_edge, area.radii[1]),
            area.ceiling,
        )
        for uid, area in found
    ]
    array = np.array(rows, AREA_DTYPE)
    array.setflags(write=False)
    return array


def dry_spells(
    found: list[tuple[int, RainArea]], fronts: RainFronts, remainder: float
) -> dict[int, Dry]:
    """By uid the spells of `physics.front`, of areas whose rain has begun or ended of late."""
    spells = {uid: fronts.dry(uid, area, remainder) for uid, area in found}
    return {uid: dry for uid, dry in spells.items() if dry != SETTLED}


class RainAreaSystem:
    """Carries every rain area by its velocity and its share of the wind, and watches its rain."""

    def __init__(self) -> None:
        self._pairs: object = None
        self._known = (-1, -1)  # revision of the areas and number of the fronts, as it left them
        self._found: list[tuple[int, RainArea]] = []
        self._uids: object = None
        self._moving: list[tuple[RainArea, float, float]] = []  # m in a step
        self._drifts = False
        self._free = 0  # steps that lead none of them to the end of the world

    def run(self, state: WeatherState) -> None:
        """Move the areas by one fixed step; at the end of the world they stop."""
        pairs, revision = esper.get_component(RainArea), RainArea.revisions
        uids = state.uids.current()
        same = pairs is self._pairs and uids is self._uids
        same = same and self._known == (revision[0], state.fronts.number)
        if not same:
            self._pairs, self._uids = pairs, uids
            self._found = alive(RainArea, state.uids)
            self._drifts = any(area.drift > 0.0 for _, area in self._found)
        state.fronts.step(self._found, same=same)
        if self._drifts or not same:
            wind, profile = state.wind, state.profile
            self._moving = []
            for _, area in self._found:
                vx, vz = drift_velocity(area, wind, profile) if area.drift > 0.0 else area.velocity
                if vx or vz:
                    self._moving.append((area, vx * STEP, vz * STEP))
            self._free = 0
        if self._free == 0 and not self._drifts:
            self._free = _free_steps(self._moving)
        far, put = FAR, _put_center
        if self._free > 0:
            self._free -= 1
            for area, dx, dz in self._moving:
                x, z = area.center
                put(area, (x + dx, z + dz))
        else:
            for area, dx, dz in self._moving:
                x, z = area.center
                put(area, (min(max(x + dx, -far), far), min(max(z + dz, -far), far)))
        if self._moving:
            count_assignment(self._moving[0][0])
        self._known = (revision[0], state.fronts.number)


def _free_steps(moving: list[tuple[RainArea, float, float]]) -> int:
    """How many steps lead none of the areas to the end of the world; 1000 are enough to ask for."""
    steps = 1000.0
    for area, dx, dz in moving:
        x, z = area.center
        steps = min(steps, (FAR - max(abs(x), abs(z))) / max(abs(dx), abs(dz)) - 1.0)
    return max(int(steps), 0)
