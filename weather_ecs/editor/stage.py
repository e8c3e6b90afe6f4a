"""The parts of a document as entities of a weather's world, kept up with it while it changes."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, fields, replace
from typing import TypeVar

import esper

from weather_ecs import CloudFile
from weather_ecs.components import Atmosphere, SplashEmitter
from weather_ecs.components._agreeing import Agreeing
from weather_ecs.components._base import Component
from weather_ecs.file_content import MANY, ONE

C = TypeVar("C", bound=Component)

Bundle = tuple[Component, ...]  # components of one entity
Groups = dict[str, tuple[Bundle, ...]]  # by the field of the content that they are in

_OWN = "the view's own"


def groups_of(content: CloudFile) -> Groups:
    """What a document's entities consist of, in the order in which a game that loads it has them.

    A layer has its own climate with it.
    """
    found: Groups = {}
    own = content.layer_climates + (None,) * len(content.layers)
    for name in MANY:
        bundles: list[Bundle] = []
        for k, part in enumerate(getattr(content, name)):
            climate = own[k] if name == "layers" else None
            bundles.append((part,) if climate is None else (part, climate))
        found[name] = tuple(bundles)
    for name in ONE:
        part = getattr(content, name)
        found[name] = () if part is None else ((part,),)
    return found


def with_extras(groups: Groups) -> Groups:
    """The same with what a view of the world needs besides: a sky that is drawn, splashes."""
    more: list[Bundle] = []
    if not groups["atmosphere"] and not groups["sun"]:
        more.append((Atmosphere(),))
    if not groups["splash_emitter"]:
        more.append((SplashEmitter(),))
    return {**groups, _OWN: tuple(more)}


def copy_of(part: C) -> C:
    """A component of the same values: the running weather changes its own, never the document's."""
    if isinstance(part, Atmosphere):
        return replace(part, draw=True)
    return replace(part)  # type: ignore[type-var]


@dataclass(slots=True)
class _Placed:
    bundle: Bundle  # of the document
    entity: int


class Stage:
    """Which entity of the current world stands for which part of a document."""

    def __init__(self) -> None:
        self._placed: dict[str, list[_Placed]] = {}

    def build(self, groups: Groups) -> None:
        """Make entities of all parts, in order; uids of a new weather follow that order."""
        self._placed = {
            name: [_made(bundle) for bundle in bundles] for name, bundles in groups.items()
        }

    def adopt(self, groups: Groups, entities: Mapping[int, int]) -> None:
        """Take over entities by uid, as they are after a snapshot of `build` was restored."""
        self._placed, uid = {}, 0
        for name, bundles in groups.items():
            row = self._placed[name] = []
            for bundle in bundles:
                row.append(_Placed(bundle, entities.get(uid, 0)))
                uid += 1

    def change(self, groups: Groups) -> bool:
        """Bring the entities up to a document that has changed; True if any came or went.

        What is the same object is left alone, with all that the weather has made of it. Of what
        was edited only the fields are set whose values the document has changed.
        """
        moved = False
        placed: dict[str, list[_Placed]] = {}
        for name in {**self._placed, **groups}:
            old, new = self._placed.get(name, []), groups.get(name, ())
            known = {_ids(each.bundle): each for each in old}
            kept = {_ids(bundle) for bundle in new} & known.keys()
            spare = [each for each in old if _ids(each.bundle) not in kept]
            row = placed[name] = []
            for bundle in new:
                if _ids(bundle) in kept:
                    row.append(known[_ids(bundle)])
                elif spare and type(spare[0].bundle[0]) is type(bundle[0]):
                    each = spare.pop(0)
                    _edit(each, bundle)
                    row.append(each)
                else:
                    row.append(_made(bundle))
                    moved = True
            moved = moved or bool(spare)
            for each in spare:
                if esper.entity_exists(each.entity):
                    esper.delete_entity(each.entity, immediate=True)
        self._placed = placed
        return moved

    def live(self, part: C) -> C | None:
        """A part as the running weather has it: where an area has drifted to, and so on."""
        for row in self._placed.values():
            for each in row:
                if any(own is part for own in each.bundle) and esper.entity_exists(each.entity):
                    return esper.try_component(each.entity, type(part))
        return None


def _ids(bundle: Bundle) -> tuple[int, ...]:
    return tuple(map(id, bundle))


def _made(bundle: Bundle) -> _Placed:
    return _Placed(bundle, esper.create_entity(*map(copy_of, bundle)))


def _edit(each: _Placed, bundle: Bundle) -> None:
    """Let an entity be another bundle of the same kind."""
    before = {type(part): part for part in each.bundle}
    now = {type(part): part for part in bundle}
    each.bundle = bundle
    if not esper.entity_exists(each.entity):
        each.entity = esper.create_entity(*map(copy_of, bundle))
        return
    for kind in before.keys() - now.keys():
        if esper.has_component(each.entity, kind):
            esper.remove_component(each.entity, kind)
    for kind, part in now.items():
        live = esper.try_component(each.entity, kind)
        known = before.get(kind)
        if live is None or known is None:
            esper.add_component(each.entity, copy_of(part))
        elif known is not part:
            _set_changed(live, known, part)


def _set_changed(live: Component, before: Component, part: Component) -> None:
    changed = {}
    for entry in fields(part):  # type: ignore[arg-type]
        old, new = getattr(before, entry.name), getattr(part, entry.name)
        if old is not new and old != new:
            changed[entry.name] = new
    if isinstance(part, Atmosphere):
        changed.pop("draw", None)  # the view draws it in any case
    if isinstance(live, Agreeing):
        live.change(**changed)
        return
    for name, value in changed.items():
        setattr(live, name, value)
