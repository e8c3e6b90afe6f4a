"""`TransitionSystem`: leads the weather's own entities from one whole weather to another."""

from __future__ import annotations

import math
from typing import NamedTuple

import esper

from weather_ecs.clock import STEP
from weather_ecs.components import Air, Climate, Fog, Lightning, RainArea, Sky, SkyLayer, Wind
from weather_ecs.components._base import Component, set_unchecked
from weather_ecs.physics.haze import haze_visibility
from weather_ecs.systems.cloud_mix import mix_at
from weather_ecs.systems.clouds import known_of
from weather_ecs.systems.course import CLEARED, FINISHED, UNDER_WAY, Conditions, Course, LayerWay
from weather_ecs.systems.state import WeatherState

TRANSITION_FINISHED = "transition_finished"
SOFT = 0.25  # of an area's radius
NEAR = 0.3  # of a base's height: a layer so near becomes the new one
APART = 1.0e-4  # between the states of a layer's skies
AFTER = 30.0  # s in which clouds that are no more wanted dissolve, after a transition
_KINDS: dict[str, type[Component]] = {
    "air": Air, "fog": Fog, "lightning": Lightning, "rain": RainArea, "wind": Wind,
}  # fmt: skip


class Bank(NamedTuple):
    """The clouds of one height, as a layer is to have them."""

    models: tuple[str, ...]
    weights: tuple[float, ...]
    base: float  # m
    clouds: int
    side: float  # m of the square they stand in
    variation: float = 0.0  # m


def begin(
    state: WeatherState,
    name: str,
    end: Conditions,
    banks: tuple[Bank, ...],
    seconds: float,
    center: tuple[float, float],
) -> None:
    """Set out for another weather; where none is there yet, put it up."""
    state.uids.commit()  # what is about to be deleted is led nowhere
    before, now = state.course, state.clock.steps
    steps = 0 if before is None else round(seconds / STEP)
    start = end if before is None else before.at(now)
    turned = math.remainder(end.wind_heading - start.wind_heading, math.tau)
    end = end._replace(wind_heading=start.wind_heading + turned)
    # Where nothing falls, an area has the size of the other's: it neither spreads nor draws in.
    begins, ends = not start.rain_rate and end.rain_rate, start.rain_rate and not end.rain_rate
    if begins:
        start = start._replace(rain_radius=end.rain_radius)
    elif ends:
        end = end._replace(rain_radius=start.rain_radius)
    course = Course(name, start, end, now, steps)
    entities: dict[str, int] = {}
    if before is None:
        course.stage = CLEARED
    else:
        rates = Conditions(*before.rates_at(now))
        course.rates = rates._replace(rain_radius=0.0) if begins else rates
        known = {uid: entity for entity, uid in state.uids.current().items()}
        for what, uid in before.owned.items():
            entity = known.get(uid)
            if entity is not None and esper.has_component(entity, _KINDS[what]):
                entities[what] = entity
    for what in _KINDS:
        if what not in entities:
            entities[what] = esper.create_entity(_made(what, start, center))
    layers = _layers(state, before, start.state, end, banks, seconds if steps else 0.0, center)
    state.uids.commit()
    uid_of = state.uids.by_entity
    course.owned = {what: uid_of[entity] for what, entity in entities.items()}
    course.layers = [way._replace(uid=uid_of[way.uid]) for way in layers]
    state.course = course
    TransitionSystem().show(state, now)


def remove_all(state: WeatherState) -> None:
    """Take the weather's own entities out of esper's current world."""
    if state.course is None:
        return
    known = {uid: entity for entity, uid in state.uids.current().items()}
    uids = [*state.course.owned.values(), *[way.uid for way in state.course.layers]]
    for entity in [known[uid] for uid in uids if uid in known]:
        if esper.entity_exists(entity):
            esper.delete_entity(entity, immediate=True)
    state.course = None


class TransitionSystem:
    """Gives the weather's own entities, at every fixed step, what the course has for it."""

    def run(self, state: WeatherState) -> None:
        """One fixed step; a course that has come to its end costs nothing."""
        course = state.course
        if course is None or course.stage == CLEARED:
            return
        if course.stage == UNDER_WAY:
            self.show(state, state.step)
            if state.step >= course.began + course.steps:
                course.stage = FINISHED
                _settle(state, course)
                state.events.append((TRANSITION_FINISHED, (course.name,)))
        elif state.step >= course.began + course.steps + round(AFTER / STEP):
            _clear(state, course)

    def show(self, state: WeatherState, step: int) -> None:
        """Set the fields of the owned entities."""
        course = state.course
        if course is None:
            return
        now, u = course.at(step), course.progress(step)
        known = {uid: entity for entity, uid in state.uids.current().items()}
        for what, uid in course.owned.items():
            entity = known.get(uid)
            component = None if entity is None else esper.try_component(entity, _KINDS[what])
            if component is not None:
                for name, value in _fields(what, now):
                    if getattr(component, name) != value:
                        set_unchecked(component, name, value)
        part = u * u * (3.0 - 2.0 * u)
        for uid, base, last_base, aside, last_aside in course.layers:
            entity = known.get(uid)
            if entity is None:
                continue
            climate = esper.try_component(entity, Climate)
            there = now.state + aside + (last_aside - aside) * part
            there = min(max(there, 0.0), 1.0)
            if climate is not None and climate.final != there:
                set_unchecked(climate, "initial", there)
                set_unchecked(climate, "final", there)
            layer = esper.try_component(entity, SkyLayer)
            height = base + (last_base - base) * part
            if layer is not None and layer.base != height:
                set_unchecked(layer, "base", height)


def _fields(what: str, now: Conditions) -> tuple[tuple[str, object], ...]:
    """Fields of an owned component and their values."""
    if what == "air":
        return ("temperature", now.temperature), ("humidity", now.humidity)
    if what == "fog":
        return (("visibility", min(now.visibility, haze_visibility(now.haze))),)
    if what == "lightning":
        return (("rate", now.lightning),)
    if what == "rain":
        radius = now.rain_radius
        return (
            ("rain_rate", now.rain_rate),
            ("radii", (radius, radius)),
            ("soft_edge", SOFT * radius),
        )
    direction = math.cos(now.wind_heading), math.sin(now.wind_heading)
    return (
        ("speed", now.wind_speed),
        ("direction", direction),
        ("gustiness", now.gustiness),
        ("veer", now.veer),
    )


def _made(what: str, now: Conditions, center: tuple[float, float]) -> Component:
    values = dict(_fields(what, now))
    if what == "rain":
        values["center"] = center
    return _KINDS[what](**values)


def _layers(
    state: WeatherState,
    before: Course | None,
    now: float,
    end: Conditions,
    banks: tuple[Bank, ...],
    seconds: float,
    center: tuple[float, float],
) -> list[LayerWay]:
    """The layers that stand and come, by entity."""
    standing: list[tuple[int, SkyLayer, float]] = []
    if before is not None:
        known = {uid: entity for entity, uid in state.uids.current().items()}
        for way in before.layers:
            entity = known.get(way.uid)
            layer = None if entity is None else esper.try_component(entity, SkyLayer)
            if entity is not None and layer is not None:
                climate = esper.try_component(entity, Climate)
                standing.append((entity, layer, now if climate is None else climate.final))
    found: list[LayerWay] = []
    turnover = min(max(seconds / 3.0, 5.0), 1.0e5) if seconds > 0.0 else 0.0
    for bank in banks:
        near = [
            (abs(layer.base - bank.base), entity, layer, own)
            for entity, layer, own in standing
            if abs(layer.base - bank.base) <= NEAR * max(bank.base, 300.0)
        ]
        size = (bank.side, bank.side)
        if near:
            _, entity, layer, own = min(near, key=lambda each: (each[0], each[1]))
            standing = [each for each in standing if each[0] != entity]
            layer.skies = _skies(layer.skies, own, end.state, bank)
            layer.size, layer.variation = size, bank.variation
        else:
            own = now
            empty = (Sky(now),) if before is not None else ()
            skies = _skies(empty, now, end.state, bank)
            layer = SkyLayer(bank.base, center, size, skies, bank.variation)
            entity = esper.create_entity(layer, Climate(now, now, 1.0, running=False))
        layer.turnover = turnover
        aside = layer.skies[-1].state - end.state
        found.append(LayerWay(entity, layer.base, bank.base, own - now, aside))
    for entity, layer, own in standing:
        layer.skies = _skies(layer.skies, own, end.state, None)
        layer.turnover = turnover
        aside = layer.skies[-1].state - end.state
        found.append(LayerWay(entity, layer.base, layer.base, own - now, aside))
    return found


def _skies(before: tuple[Sky, ...], now: float, end: float, bank: Bank | None) -> tuple[Sky, ...]:
    """The skies between which a layer's state stands, and last the one it goes to."""
    below = [sky for sky in before if sky.state <= now]
    above = [sky for sky in before if sky.state > now]
    kept = [max(below, key=_state)] if below else []
    kept += [min(above, key=_state)] if above else []
    target = end
    while any(abs(sky.state - target) < 0.5 * APART for sky in kept):
        target += APART if target < 0.5 else -APART
    if bank is None or not bank.clouds:
        return (*kept, Sky(target))
    return (*kept, Sky(target, bank.models, 6, bank.clouds, bank.weights))


def _state(sky: Sky) -> float:
    return sky.state


def _settle(state: WeatherState, course: Course) -> None:
    """At the end of the way: of each layer's skies only the last one stays."""
    for uid, layer in _owned_layers(state, course).items():
        if layer.skies:
            layer.skies = layer.skies[-1:]
            layer.turnover = 0.0
            record = state.clouds.layers.get(uid)
            if record is not None:
                mix = mix_at(layer.skies, layer.skies[0].state)
                record.renew(known_of(layer), mix)
                record.complete(mix)


def _clear(state: WeatherState, course: Course) -> None:
    """When the last clouds have dissolved: layers that hold nothing go."""
    left = []
    layers = _owned_layers(state, course)
    entity_of = {uid: entity for entity, uid in state.uids.current().items()}
    for way in course.layers:
        layer = layers.get(way.uid)
        if layer is not None and not any(sky.count for sky in layer.skies):
            esper.delete_entity(entity_of[way.uid], immediate=True)
        elif layer is not None:
            left.append(way)
    state.uids.commit()
    course.layers, course.stage = left, CLEARED


def _owned_layers(state: WeatherState, course: Course) -> dict[int, SkyLayer]:
    known = {uid: entity for entity, uid in state.uids.current().items()}
    found = {}
    for way in course.layers:
        entity = known.get(way.uid)
        layer = None if entity is None else esper.try_component(entity, SkyLayer)
        if layer is not None:
            found[way.uid] = layer
    return found
