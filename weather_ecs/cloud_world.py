"""Files of clouds into esper's current world, and out of it."""

from __future__ import annotations

from typing import TypeVar

import esper

from weather_ecs.cloud_files import CloudFile
from weather_ecs.components import Climate, Cloud, CloudModel, SkyLayer
from weather_ecs.components._base import Component
from weather_ecs.systems.queries import living

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
    rest: list[Component] = [*content.clouds, *content.layers]
    if content.climate is not None:
        rest.append(content.climate)
    entities += [esper.create_entity(component) for component in rest]
    return tuple(entities)


def gather() -> CloudFile:
    """All models, clouds and layers of the world, and the oldest climate."""
    climates = _all(Climate)
    return CloudFile(
        models=_all(CloudModel),
        clouds=_all(Cloud),
        layers=_all(SkyLayer),
        climate=climates[0] if climates else None,
    )


def _all(kind: type[C]) -> tuple[C, ...]:
    return tuple([component for _, component in living(kind)])
