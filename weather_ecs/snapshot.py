"""Snapshots: the whole deterministic state of a weather in a few kilobytes, and back.

As a document of plain values here; `snapshot_file` has it as bytes.
"""

from __future__ import annotations

from dataclasses import fields
from math import inf, isfinite
from typing import Any, NamedTuple

import esper
import numpy as np

from weather_ecs.clock import Clock
from weather_ecs.components import SNAPSHOT_COMPONENTS
from weather_ecs.components._base import Component, set_unchecked
from weather_ecs.errors import InvalidValueError, SnapshotError
from weather_ecs.physics.ground_law import SnowLaw
from weather_ecs.snapshot_file import decode as decode
from weather_ecs.snapshot_file import encode as encode
from weather_ecs.systems.cloud_field import CloudField
from weather_ecs.systems.course import Course
from weather_ecs.systems.rain_fronts import RainFronts
from weather_ecs.systems.state import WeatherState
from weather_ecs.systems.strikes import StrikeField
from weather_ecs.systems.wet_ground import WetGround

MOST_UIDS = 2**53
DEEPEST = 12  # a layer's skies, their models, seeds and roots with their vectors

_NAMES = {
    name: tuple(sorted(field.name for field in fields(kind)))  # type: ignore[arg-type]
    for name, kind in SNAPSHOT_COMPONENTS.items()
}
_PARTS = {
    "clock", "clouds", "course", "entities", "fronts", "lightning", "next_uid", "rng", "seed",
    "snow", "wetness",
}  # fmt: skip


class Entity(NamedTuple):
    """One entity of a snapshot, its components built and checked."""

    uid: int
    components: dict[type[Component], Component]


class Loaded(NamedTuple):
    """A snapshot that has been read and checked from end to end."""

    seed: int
    rng: np.random.Generator
    clock: Clock
    clouds: CloudField
    course: Course | None
    fronts: RainFronts
    strikes: StrikeField
    next_uid: int
    entities: list[Entity]
    wet_ground: WetGround
    snow_ground: WetGround


def capture(state: WeatherState) -> dict[str, Any]:
    """The state and the components of esper's current world as a JSON document."""
    state.uids.commit()
    entities: dict[int, dict[str, Any]] = {}
    for name, kind in SNAPSHOT_COMPONENTS.items():
        for entity, component in esper.get_component(kind):
            if esper.entity_exists(entity):
                uid = state.uids.by_entity[entity]
                entities.setdefault(uid, {})[name] = {
                    field: _plain(getattr(component, field)) for field in _NAMES[name]
                }
    return {
        "clock": state.clock.state(),
        "clouds": state.clouds.state(),
        "course": None if state.course is None else state.course.state(),
        "entities": [[uid, entities[uid]] for uid in sorted(entities)],
        "fronts": state.fronts.state(),
        "lightning": state.strikes.state(),
        "next_uid": state.uids.next,
        "rng": state.rng.bit_generator.state,
        "seed": state.seed,
        "snow": state.snow_ground.state(),
        "wetness": state.wet_ground.state(),
    }


def load(document: dict[str, Any]) -> Loaded:
    """Read and check a document; touches nothing. Raises SnapshotError."""
    try:
        return _load(document)
    except InvalidValueError as error:
        raise SnapshotError(f"the snapshot holds a bad value: {error}") from None


def _load(document: dict[str, Any]) -> Loaded:
    if set(document) != _PARTS:
        raise SnapshotError(f"the snapshot's parts are {sorted(document)}, not {sorted(_PARTS)}")
    next_uid = _integer("next_uid", document["next_uid"], MOST_UIDS)
    entities: list[Entity] = []
    if not isinstance(document["entities"], list):
        raise SnapshotError("the snapshot's entities are not a list")
    for entry in document["entities"]:
        if not (isinstance(entry, list) and len(entry) == 2 and isinstance(entry[1], dict)):
            raise SnapshotError("the snapshot holds an entity without number and components")
        uid = _integer("uid", entry[0], next_uid - 1)
        if entities and uid <= entities[-1].uid:
            raise SnapshotError("the snapshot's entities are not in order")
        if not entry[1]:
            raise SnapshotError(f"the snapshot's entity {uid} has no components")
        built = [_component(name, values) for name, values in entry[1].items()]
        entities.append(Entity(uid, {type(component): component for component in built}))
    seed = _integer("seed", document["seed"], 2**63 - 1)
    clock, course = Clock.from_state(document["clock"]), document["course"]
    return Loaded(
        seed=seed,
        rng=_generator(document["rng"]),
        clock=clock,
        clouds=CloudField.from_state(document["clouds"], seed),
        course=None if course is None else Course.from_state(course, clock.steps),
        fronts=RainFronts.from_state(document["fronts"]),
        strikes=StrikeField.from_state(document["lightning"], clock.steps),
        next_uid=next_uid,
        entities=entities,
        wet_ground=WetGround.from_state(document["wetness"]),
        snow_ground=WetGround.from_state(document["snow"], SnowLaw),
    )


def apply(state: WeatherState, loaded: Loaded) -> None:
    """Make esper's current world and the state what the snapshot says; nothing here can fail.

    Entities that live under the same uid keep their components, whose fields are set; others are
    created. Weather components that the snapshot does not know go, and with its last component
    the entity. Everything else in the world belongs to the game and stays.
    """
    current = state.uids.current()
    exists = esper.entity_exists
    by_uid = {uid: entity for entity, uid in current.items() if exists(entity)}
    wanted = {entity.uid: entity.components for entity in loaded.entities}
    for uid, entity in by_uid.items():
        keep = wanted.get(uid, {})
        for kind in SNAPSHOT_COMPONENTS.values():
            if kind not in keep and esper.has_component(entity, kind):
                esper.remove_component(entity, kind)
        if not keep and not esper.components_for_entity(entity):
            esper.delete_entity(entity, immediate=True)
    assigned: dict[int, int] = {}
    for uid, components in wanted.items():
        known = by_uid.get(uid)
        if known is None:
            known = esper.create_entity()
        for kind, component in components.items():
            present = esper.try_component(known, kind)
            if present is None:
                esper.add_component(known, component)
            else:
                for name in _NAMES[kind.__name__]:
                    set_unchecked(present, name, getattr(component, name))
        assigned[known] = uid
    state.seed = loaded.seed
    state.rng = loaded.rng
    state.clock = loaded.clock
    state.clouds = loaded.clouds
    state.course = loaded.course
    state.fronts = loaded.fronts
    state.strikes = loaded.strikes
    state.wet_ground = loaded.wet_ground
    state.snow_ground = loaded.snow_ground
    state.uids.assign(assigned, loaded.next_uid)


def _component(name: str, values: Any) -> Component:
    kind = SNAPSHOT_COMPONENTS.get(name)
    if kind is None:
        raise SnapshotError(f"the snapshot holds a component {name!r} that is unknown here")
    if not isinstance(values, dict) or tuple(sorted(values)) != _NAMES[name]:
        raise SnapshotError(f"the snapshot's {name} has other fields than {_NAMES[name]}")
    return kind(**{field: _restored(value) for field, value in values.items()})


def _plain(value: Any) -> Any:
    """A field's value as JSON has it: nested components as objects, infinity as one too."""
    if type(value) is float:
        return value if isfinite(value) else {"float": repr(value)}
    if isinstance(value, Component):
        return {f.name: _plain(getattr(value, f.name)) for f in fields(value)}  # type: ignore[arg-type]
    if isinstance(value, tuple):
        return [_plain(item) for item in value]
    return value


def _restored(value: Any, depth: int = 0) -> Any:
    """The inverse of `_plain`; objects stay mappings, which the components' checks take."""
    if depth > DEEPEST:
        raise SnapshotError("the snapshot holds values nested too deeply")
    if isinstance(value, list):
        return [_restored(item, depth + 1) for item in value]
    if isinstance(value, dict):
        if value == {"float": "inf"}:
            return inf
        return {name: _restored(item, depth + 1) for name, item in value.items()}
    return value


def _generator(state: Any) -> np.random.Generator:
    """A PCG64 generator in the given state."""
    limits = {"has_uint32": 1, "uinteger": 2**32 - 1}
    if not isinstance(state, dict) or set(state) != {"bit_generator", "state", *limits}:
        raise SnapshotError("the snapshot's generator state has other parts than PCG64's")
    inner = state["state"]
    if state["bit_generator"] != "PCG64" or not isinstance(inner, dict):
        raise SnapshotError("the snapshot's generator is not PCG64")
    if set(inner) != {"inc", "state"}:
        raise SnapshotError("the snapshot's generator state has other parts than PCG64's")
    for name, most in limits.items():
        _integer(f"rng.{name}", state[name], most)
    for name in inner:
        _integer(f"rng.state.{name}", inner[name], 2**128 - 1)
    if inner["inc"] % 2 == 0:
        raise SnapshotError("the snapshot's generator has an even increment")
    bits = np.random.PCG64(0)
    bits.state = state  # type: ignore[assignment]
    return np.random.Generator(bits)


def _integer(field: str, value: Any, most: int) -> int:
    if type(value) is not int or not 0 <= value <= most:
        raise InvalidValueError(field, value, f"a whole number in [0, {most}]")
    return value
