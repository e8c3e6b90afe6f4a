"""`CloudRainSystem`: rain areas that clouds carry, as far as their models rain."""

from __future__ import annotations

import math
from collections.abc import Iterator
from typing import NamedTuple

import esper
import numpy as np

from weather_ecs.components import Climate, Cloud, CloudModel, RainArea, SkyLayer
from weather_ecs.components._base import FAR, set_unchecked
from weather_ecs.components.rain_area import FASTEST, SMALLEST_RADIUS
from weather_ecs.physics.cloud_shape import CloudShape
from weather_ecs.systems.cloud_field import Key
from weather_ecs.systems.cloud_layer import LayerClouds
from weather_ecs.systems.cloud_made import share_of
from weather_ecs.systems.cloud_place import QUANTUM
from weather_ecs.systems.cloud_view import growth, inside, lifts, scales
from weather_ecs.systems.clouds import STEPS, layer_state
from weather_ecs.systems.queries import alive
from weather_ecs.systems.state import WeatherState

MOST_FEET = 1000  # kept
MOST = 24  # areas that clouds carry at once; of more clouds the oldest rain
FOOT = 0.25  # of a cloud's height: its rain falls from what reaches below
SHRINK = 0.9  # of that foot's radii
SOFT = 0.6  # of the smaller radius
LEVELS = 8  # of a rate: changes in small steps would let the ground be computed every second
CLOSED = 0.9  # of the rectangle that all the areas of a layer cover together at most

_RAIN_FIELDS = ("center", "radii", "rain_rate", "heading", "soft_edge", "ceiling", "velocity")


class Foot(NamedTuple):
    """The lower end of a cloud's shape, m, from its centre."""

    x: float
    z: float
    half_x: float
    half_z: float


class Shaft(NamedTuple):
    """The rain under one cloud: values of the fields in _RAIN_FIELDS."""

    center: tuple[float, float]
    radii: tuple[float, float]
    rain_rate: float
    heading: float
    soft_edge: float
    ceiling: float
    velocity: tuple[float, float]


def foot_of(made: CloudShape) -> Foot:
    """Box round the seeds that reach into the lower part; rounded, the same on every machine."""
    bottom = made.centers[:, 1] - 0.5 * made.sizes[:, 1]
    low = bottom <= bottom.min() + FOOT * 2.0 * made.half[1]
    centers, sizes = made.centers[low][:, ::2], made.sizes[low][:, ::2]
    least, most = (centers - 0.5 * sizes).min(axis=0), (centers + 0.5 * sizes).max(axis=0)
    middle, half = 0.5 * (least + most), 0.5 * (most - least)
    return Foot(*[round(float(value), 1) for value in (*middle, *half)])


def shaft_of(
    foot: Foot,
    scale: float,
    heading: float,
    position: tuple[float, float, float],
    rate: float,
    velocity: tuple[float, float],
) -> Shaft:
    """The rain under a cloud with the middle of its base at `position`."""
    c, s = math.cos(heading), math.sin(heading)
    x = position[0] + scale * (foot.x * c + foot.z * s)
    z = position[2] + scale * (foot.z * c - foot.x * s)
    a, b = (max(SHRINK * scale * half, SMALLEST_RADIUS) for half in foot[2:])
    if a < b:
        a, b, heading = b, a, heading + 0.5 * math.pi
    vx, vz = (min(max(v, -FASTEST), FASTEST) for v in velocity)
    place = (min(max(x, -FAR), FAR), min(max(z, -FAR), FAR))
    return Shaft(place, (a, b), round(rate, 3), heading, SOFT * b, position[1], (vx, vz))


class CloudRainSystem:
    """Keeps a `RainArea` entity under every cloud that rains, once a second of weather.

    The rate is the model's, times how whole the cloud is and how far the climate has come towards
    its sky. Clouds that close the sky overlap; their areas are smaller, so that it does not rain
    twice. An area that the game deletes stays so.
    """

    def __init__(self) -> None:
        self._feet: dict[int, Foot] = {}  # by key of the shape

    def run(self, state: WeatherState) -> None:
        """One fixed step."""
        if state.step % STEPS == 0:
            wanted = dict(_first(MOST, self._shafts(state)))
            if wanted or state.clouds.rain:
                _apply(state, wanted)

    def _shafts(self, state: WeatherState) -> Iterator[tuple[Key, Shaft]]:
        for uid, layer in alive(SkyLayer, state.uids):
            record = state.clouds.layers.get(uid)
            if record is not None and len(record.array):
                yield from self._of_layer(state, layer, record)
        for uid, cloud in alive(Cloud, state.uids):
            model = state.models.find(cloud.model, state.uids)
            if model is not None and model.rain_rate > 0.0:
                share = share_of(cloud, state.profile)
                vx = cloud.velocity[0] + share * state.wind[0]
                vz = cloud.velocity[1] + share * state.wind[2]
                foot = self._foot(state, model, cloud.number)
                rate = model.rain_rate * _level(cloud.growth * cloud.opacity)
                where = (cloud.scale, cloud.heading, cloud.position)
                yield (uid, -1), shaft_of(foot, *where, rate, (vx, vz))

    def _of_layer(
        self, state: WeatherState, layer: SkyLayer, record: LayerClouds
    ) -> Iterator[tuple[Key, Shaft]]:
        models, array = state.models.of_skies(layer.skies, state.uids), record.array
        if not any(model.rain_rate > 0.0 for model in models.values()):
            return
        of_kind = [models.get((kind.sky, kind.model)) for kind in array.kinds]
        raining = np.array([m is not None and m.rain_rate > 0.0 for m in of_kind], bool)
        rows = np.flatnonzero(raining[array.kind])[:MOST]
        x = array.x[rows] * QUANTUM + record.offset[0]
        z = array.z[rows] * QUANTUM + record.offset[1]
        whole = (growth(array, record.ticks)[rows] * inside(x, z, layer)).tolist()
        scale = scales(array.serial[rows], record.uid).tolist()
        base = (layer.base + lifts(array.serial[rows], record.uid, layer.variation)).tolist()
        climate = bool(esper.get_component(Climate))
        now = layer_state(state, record.uid) if climate else 1.0
        found: list[tuple[Key, Shaft]] = []
        for k, row in enumerate(rows.tolist()):
            kind, model = array.kinds[array.kind[row]], of_kind[array.kind[row]]
            assert model is not None
            come = min(now / kind.sky, 1.0) if kind.sky > 0.0 else 1.0
            foot = self._foot(state, model, kind.number)
            place = (float(x[k]), base[k], float(z[k]))
            rate = model.rain_rate * _level(whole[k] * come)
            shaft = shaft_of(foot, scale[k], 0.0, place, rate, record.velocity)
            found.append(((record.uid, int(array.serial[row])), shaft))
        covered = sum(math.pi * s.radii[0] * s.radii[1] for _, s in found)
        room = CLOSED * layer.size[0] * layer.size[1]
        for key, shaft in found:
            yield key, shaft if covered <= room else _smaller(shaft, math.sqrt(room / covered))

    def _foot(self, state: WeatherState, model: CloudModel, number: int) -> Foot:
        shape = state.cloud_shapes.get(model, number)
        known = self._feet.get(shape.key)
        if known is None:
            if len(self._feet) > MOST_FEET:
                self._feet.clear()
                if not state.drawn:  # else who draws forgets what is out of use
                    state.cloud_shapes.prune(set())
            known = self._feet[shape.key] = foot_of(shape.made)
        return known


def _level(share: float) -> float:
    return round(share * LEVELS) / LEVELS


def _smaller(shaft: Shaft, factor: float) -> Shaft:
    a, b = (round(max(factor * radius, SMALLEST_RADIUS), 3) for radius in shaft.radii)
    return shaft._replace(radii=(a, b), soft_edge=SOFT * b)


def _first(count: int, shafts: Iterator[tuple[Key, Shaft]]) -> Iterator[tuple[Key, Shaft]]:
    for _, each in zip(range(count), shafts, strict=False):
        yield each


def _apply(state: WeatherState, wanted: dict[Key, Shaft]) -> None:
    """Make the carried areas what is wanted."""
    rain, uids = state.clouds.rain, state.uids
    entity_of = {uid: entity for entity, uid in uids.current().items()}
    for key in [key for key in rain if key not in wanted]:
        _remove(entity_of.get(rain.pop(key)))
    new: dict[Key, int] = {}
    for key, shaft in sorted(wanted.items()):
        if key not in rain:
            new[key] = esper.create_entity(RainArea(**shaft._asdict()))
            continue
        entity = entity_of.get(rain[key])
        area = None if entity is None else esper.try_component(entity, RainArea)
        if area is not None:
            for name, value in zip(_RAIN_FIELDS, shaft, strict=True):
                if getattr(area, name) != value:
                    set_unchecked(area, name, value)
    if new:
        uids.commit()
        for key, entity in new.items():
            rain[key] = uids.by_entity[entity]


def _remove(entity: int | None) -> None:
    """Take a carried area away, and its entity, unless the game has put more on it."""
    if entity is None or not esper.entity_exists(entity):
        return
    if esper.has_component(entity, RainArea):
        esper.remove_component(entity, RainArea)
    if esper.entity_exists(entity) and not esper.components_for_entity(entity):
        esper.delete_entity(entity, immediate=True)


def remove_all(state: WeatherState) -> None:
    """Take all carried areas out of esper's current world."""
    _apply(state, {})
