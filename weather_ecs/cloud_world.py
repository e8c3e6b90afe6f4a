"""Files of clouds and weather into esper's current world, and out of it."""

from __future__ import annotations

from collections.abc import Collection
from typing import Any, TypeVar

import esper

from weather_ecs.components import Climate, CloudModel, RainArea, SkyLayer
from weather_ecs.components._base import Component
from weather_ecs.file_content import MANY, ONE, CloudFile
from weather_ecs.systems.queries import alive, living
from weather_ecs.systems.state import WeatherState

C = TypeVar("C", bound=Component)


def add(content: CloudFile) -> tuple[int, ...]:
    """Make entities of all that a file holds; returns them.

    A model takes the place of one of the same name.
    """
    known = {model.name: entity for entity, model in reversed(living(CloudModel))}
    entities = []
    for model in content.models:
        entity = known.get(model.name)
        if entity is None:
            entity = esper.create_entity(model)
        else:
            esper.add_component(entity, model)
        entities.append(entity)
    for key in MANY:
        if key == "layers":
            entities += _layers(content)
        elif key != "models":
            entities += [esper.create_entity(component) for component in getattr(content, key)]
    singles = [getattr(content, key) for key in ONE]
    entities += [esper.create_entity(single) for single in singles if single is not None]
    return tuple(entities)


def gather(state: WeatherState) -> CloudFile:
    """All of the world that a file holds; of what counts once, the oldest entity's.

    Rain that clouds bring is left out: they bring it again.
    """
    entity_of = {uid: entity for entity, uid in state.uids.current().items()}
    carried = {entity_of.get(uid) for uid in state.clouds.rain.values()}
    layers = [entity_of[uid] for uid, _ in alive(SkyLayer, state.uids)]
    found: dict[str, Any] = {}
    for key, kind in MANY.items():
        found[key] = _all(state, kind, carried if kind is RainArea else ())
    for key, kind in ONE.items():
        rest = _all(state, kind, layers if kind is Climate else ())
        found[key] = rest[0] if rest else None
    own = [esper.try_component(entity, Climate) for entity in layers]
    return CloudFile(**found, layer_climates=tuple(own) if any(own) else ())


def _layers(content: CloudFile) -> list[int]:
    own = content.layer_climates + (None,) * len(content.layers)
    return [
        esper.create_entity(layer, *([] if climate is None else [climate]))
        for layer, climate in zip(content.layers, own, strict=False)
    ]


def _all(state: WeatherState, kind: type[C], without: Collection[int | None]) -> tuple[C, ...]:
    entity_of = {uid: entity for entity, uid in state.uids.current().items()}
    pairs = alive(kind, state.uids)
    return tuple([component for uid, component in pairs if entity_of[uid] not in without])
