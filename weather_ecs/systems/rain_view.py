"""What one observer's camera sees of the rain: containers placed, drops shared out, veils.

Placing belongs to the view and not to the weather: nothing here reaches a snapshot, and a server
never runs it.
"""

from __future__ import annotations

import math
from collections.abc import Iterable, Sequence
from dataclasses import dataclass, field
from typing import Protocol

import numpy as np

from weather_ecs.frame import (
    SNOW,
    AreaRow,
    ContainerData,
    DropLook,
    FrameData,
    VeilData,
    ViewData,
    plain_areas,
)
from weather_ecs.physics.camera import Camera
from weather_ecs.physics.container import (
    Area,
    Container,
    ContainerSettings,
    births,
    place,
)
from weather_ecs.physics.front import NO_FRONTS, SETTLED, water_arrived
from weather_ecs.physics.rain_step import axis_of, shape_of
from weather_ecs.systems.drop_shares import importances
from weather_ecs.systems.falls import Fall, falls
from weather_ecs.systems.rain_veils import veils
from weather_ecs.systems.scene_floor import SceneFloor

# A drop count's last tenth fades in, so that a changing count never makes a drop appear at once.
COUNT_FADE = 0.1
_LONGEST_STEP = 0.1  # s; a longer pause moves no drop further: rain is alike a moment later
_FASTEST = 60.0  # m/s; an observer faster than this has been put elsewhere
_FEW = 2  # areas, so few that they need not be sorted out beforehand
_FLOOR_EVERY = 0.25  # s, between two looks at how low the scene lies


class Settings(Protocol):
    """What the placing needs of the quality settings."""

    @property
    def drops(self) -> int: ...
    @property
    def containers(self) -> int: ...
    @property
    def budget(self) -> float: ...
    @property
    def veil(self) -> bool: ...


@dataclass(slots=True)
class _Placed:
    container: Container
    importance: float  # share of the drops it would have alone; 0: no slot


@dataclass(slots=True)
class _Observed:
    """What is remembered of one observer between two views."""

    time: float
    position: tuple[float, float, float]
    velocity: tuple[float, float, float] = (0.0, 0.0, 0.0)
    placed: dict[int, _Placed] = field(default_factory=dict)
    fresh: bool = True  # not viewed yet
    air_run: tuple[float, float, float] = (0.0, 0.0, 0.0)  # m, see ViewData
    floor: float | None = None  # m, the lowest surface ahead
    floor_time: float = -math.inf  # s, when it was looked for


class RainView:
    """Turns a frame and a camera into a `ViewData`."""

    def __init__(self, seed: int = 0) -> None:
        self._seed = seed
        self._observed: dict[int, _Observed] = {}
        self._births: dict[tuple[int, int], np.ndarray] = {}
        self._floor = SceneFloor()
        self._fronts = NO_FRONTS
        self._look: DropLook | None = None
        self._size = ContainerSettings()  # of that look

    def forget(self, key: int) -> None:
        """Drop what is remembered of an observer."""
        self._observed.pop(key, None)

    def view(self, frame: FrameData, camera: Camera, key: int, settings: Settings) -> ViewData:
        """The frame as `camera` sees it."""
        self._fronts = frame.fronts
        seen = self._observed.get(key)
        if seen is None or frame.time < seen.time:
            seen = _Observed(frame.time, camera.position)
            self._observed[key] = seen
        dt = frame.time - seen.time
        if dt > 0.0:
            seen.velocity = _velocity(seen, camera.position, dt)
        # In a pause too: where the observer went then is no motion.
        seen.position, seen.time = camera.position, frame.time
        seen.air_run = _air_run(seen.air_run, frame, min(dt, 1.0))
        containers = self._containers(frame, camera, seen, settings, min(dt, 1.0))
        found: Iterable[VeilData] = ()
        if settings.veil and frame.look.veil > 0.0:
            placed = {area: each.container for area, each in seen.placed.items()}
            found = veils(frame, placed, containers, camera.position[1])
        return ViewData(
            frame=frame,
            key=key,
            view=camera.view,
            projection=camera.projection,
            position=camera.position,
            velocity=seen.velocity,
            dt=min(dt, _LONGEST_STEP),
            containers=tuple(containers),
            veils=tuple(found),
            air_run=seen.air_run,
        )

    def _containers(
        self,
        frame: FrameData,
        camera: Camera,
        seen: _Observed,
        settings: Settings,
        dt: float,
    ) -> list[ContainerData]:
        look = frame.look
        if look is not self._look:
            self._look, self._size = look, ContainerSettings(look.reach, look.height, look.margin)
        size = self._size
        first, seen.fresh = seen.fresh, False
        if first or frame.time - seen.floor_time >= _FLOOR_EVERY:
            seen.floor_time = frame.time
            seen.floor = self._floor.lowest(
                frame.occluders, camera.position, camera.heading, look.reach
            )
        rows: dict[int, AreaRow] = {}
        found: dict[int, Container] = {}
        for row in _in_view(frame.areas, camera):
            before = seen.placed.get(row.key)
            rows[row.key] = row
            found[row.key] = place(
                Area(row.center, row.radii, row.heading, row.ceiling),
                camera.position,
                camera.heading,
                camera.half_width,
                size,
                before.container if before else None,
                dt,
                seen.floor,
            )
        # What comes into the picture gets its drops little by little.
        wanted = {k: c.share for k, c in found.items() if c.visible}
        had = None if first else {k: p.importance for k, p in seen.placed.items() if p.importance}
        shown = importances(had, wanted, settings.containers, dt)
        placed = {k: _Placed(c, shown.get(k, 0.0)) for k, c in found.items()}
        seen.placed = placed
        total = max(sum(shown.values()), 1.0)
        data: list[ContainerData] = []
        for k in sorted(shown, key=lambda k: (-shown[k], k)):
            count = max(settings.drops * settings.budget * shown[k] / total, 1.0)
            for fall in falls(rows[k].rain_rate, frame.air, frame.flakes):
                part = max(count * fall.part * fall.busy, 1.0)
                data.extend(self._data(k, rows[k], placed[k].container, fall, part, settings.drops))
        return data

    def _data(
        self,
        key: int,
        row: AreaRow,
        container: Container,
        fall: Fall,
        count: float,
        capacity: int,
    ) -> list[ContainerData]:
        forward, lateral = container.reach
        load = fall.density * container.height * math.pi * forward * lateral
        dry = self._fronts.get(key, SETTLED)
        if fall.kind == SNOW and dry != SETTLED:
            # Flakes come and go together, with the water that is down.
            way = row.ceiling - (container.bottom + 0.3 * container.height)
            load *= float(water_arrived(way, dry, row.rain_rate))
            dry = SETTLED
        load /= 2.0 * (1.0 - 0.5 * COUNT_FADE)
        axis, shape = axis_of(container), shape_of(container)
        area_axis = (*row.center, math.cos(row.heading), math.sin(row.heading))
        area_shape = (*row.radii, min(row.soft_edge, row.radii[1]), row.ceiling)
        # A whole cylinder is the half and its twin, turned about; they share the drops.
        halves = [(0, axis, max(count * (1.0 - container.rear), 1.0))]
        if container.whole:
            turned = (axis[0], axis[1], -axis[2], -axis[3])
            halves.append((1, turned, max(count * container.rear, 1.0)))
        return [
            ContainerData(
                key=4 * key + 2 * fall.kind + rear,
                axis=half,
                shape=shape,
                area_axis=area_axis,
                area_shape=area_shape,
                dry=dry,
                law=fall.law,
                load=load / part,
                count=part,
                size_scale=container.size_scale,
                births=self._birth_records(capacity, fall.kind, rear),
                kind=fall.kind,
                rate=fall.rate,
                cover=fall.cover,
            )
            for rear, half, part in halves
        ]

    def _birth_records(self, capacity: int, kind: int, rear: int) -> np.ndarray:
        number = 2 * kind + rear
        record = self._births.get((capacity, number))
        if record is None:
            self._births = {k: r for k, r in self._births.items() if k[0] == capacity}
            # A rear half has half of the drops at most.
            size = capacity // 2 + 1 if rear else capacity
            record = births(size, np.random.default_rng((self._seed, capacity, number)))
            record.setflags(write=False)
            self._births[capacity, number] = record
        return record


def _velocity(
    seen: _Observed, position: tuple[float, float, float], dt: float
) -> tuple[float, float, float]:
    """The observer's velocity, smoothed over a few frames."""
    (x, y, z), (was_x, was_y, was_z), (vx, vy, vz) = position, seen.position, seen.velocity
    x, y, z = (x - was_x) / dt, (y - was_y) / dt, (z - was_z) / dt
    if math.hypot(x, y, z) > _FASTEST:
        return (0.0, 0.0, 0.0)
    blend = 1.0 - math.exp(-dt / 0.05)
    return (vx + (x - vx) * blend, vy + (y - vy) * blend, vz + (z - vz) * blend)


def _air_run(
    run: tuple[float, float, float], frame: FrameData, dt: float
) -> tuple[float, float, float]:
    """How far the air has gone and its eddies have turned, m; a sum, so that no change of the wind
    puts them elsewhere."""
    x, z, turned = run
    wind, turning = frame.wind, frame.profile.turbulence
    return x + wind[0] * dt, z + wind[2] * dt, turned + turning * dt


def _in_view(areas: np.ndarray, camera: Camera) -> Sequence[AreaRow]:
    """The areas that rain and have a bounding circle that reaches into the camera's azimuths.

    Areas out of view are many and must cost nothing; `place` is exact for the others, and quicker
    than this for a few.
    """
    if len(areas) <= _FEW:
        return [row for row in plain_areas(areas) if row.rain_rate > 0.0]
    away = areas["center"] - (camera.position[0], camera.position[2])
    far = np.hypot(away[:, 0], away[:, 1])
    reach = areas["radii"][:, 0]
    half = np.arcsin(np.minimum(reach / np.maximum(far, 1e-9), 1.0))
    off = np.arctan2(-away[:, 1], away[:, 0]) - camera.heading
    off = np.abs((off + math.pi) % (2.0 * math.pi) - math.pi)
    seen = (far <= reach) | (off - half <= camera.half_width + math.radians(3.0))
    return plain_areas(areas[(areas["rain_rate"] > 0.0) & seen])
