"""`LightningSystem`: lets clouds flash, and thunder come to the observers."""

from __future__ import annotations

import heapq
import math
from collections.abc import Iterator
from typing import NamedTuple

import esper
import numpy as np
from numpy.typing import NDArray

from weather_ecs.clock import MOST_STEPS, STEP
from weather_ecs.components import Climate, Cloud, CloudModel, Lightning, Observer, SkyLayer
from weather_ecs.physics import lightning
from weather_ecs.physics.chance import scramble, uniform
from weather_ecs.systems.cloud_layer import LayerClouds
from weather_ecs.systems.cloud_place import QUANTUM
from weather_ecs.systems.cloud_view import growth, inside, lifts, scales
from weather_ecs.systems.clouds import STEPS, layer_state
from weather_ecs.systems.queries import alive, living
from weather_ecs.systems.state import WeatherState
from weather_ecs.systems.strike_place import tips_near
from weather_ecs.systems.strikes import STRIKE, THUNDER, Heard, Strike, StrikeField, Vector

WORD = 2**63 - 1
BELOW, ABOVE = (0.0, 0.45), (0.25, 0.85)  # of a cloud's height: where the two kinds begin
ASIDE = 0.3  # of the height over the ground, how far from below its beginning a flash comes down
HEIGHT = 1500.0  # m over its target, where a called strike begins that is not told where

_NO_LIGHTNING = Lightning()


class Charged(NamedTuple):
    """A cloud that may flash."""

    uid: int  # of its layer or its own
    serial: int  # in the layer, or -1
    rate: float  # flashes a minute
    model: CloudModel
    number: int
    base: Vector  # m, the middle of its base
    scale: float
    heading: float  # rad


def settings_of(state: WeatherState) -> Lightning:
    """The lightning's fields: the oldest entity's component, or the defaults."""
    for _, found in alive(Lightning, state.uids):
        return found
    return _NO_LIGHTNING


class LightningSystem:
    """Plans the flashes of every second from the clouds as they are, and tells of them.

    A cloud's flashes are a Poisson process at the rate of its model, times the square of how
    whole the cloud is and how far the climate has come towards its sky: a cloud that builds up
    flashes late. Its chance is a function of the seed, the cloud and the second.
    """

    def __init__(self) -> None:
        self._field: StrikeField | None = None
        self._thunder: list[tuple[int, int, int, float, Strike]] = []  # a heap, by step and order

    def run(self, state: WeatherState) -> None:
        """One fixed step."""
        field = state.strikes
        if field is not self._field:  # the first step, or a snapshot was restored
            self._field, self._thunder = field, []
            for strike in field.struck:
                self._listen(state, strike)
        if field.due or field.struck:
            self._strike(state)
        if state.step % STEPS == 0:
            self._plan(state)

    def _strike(self, state: WeatherState) -> None:
        field = state.strikes
        for planned, drawn in field.take(state.step):
            strike = _resolved(state, planned) if drawn else planned
            field.struck.append(strike)
            state.events.append((STRIKE, (strike, self._listen(state, strike))))
        thunder = self._thunder
        while thunder and thunder[0][0] <= state.step:
            _, _, observer, distance, strike = heapq.heappop(thunder)
            if esper.entity_exists(observer):
                state.events.append((THUNDER, (observer, strike, distance)))
        field.forget(state.step, max(settings_of(state).audible / lightning.SOUND, 2.0))

    def _listen(self, state: WeatherState, strike: Strike) -> tuple[Heard, ...]:
        """The observers as they are now; those who will hear it are remembered."""
        heard: list[Heard] = []
        audible = settings_of(state).audible
        for entity, observer in living(Observer):
            distance = strike.distance(observer.position)
            delay = lightning.thunder_delay(distance)
            heard.append(Heard(entity, distance, delay))
            due = strike.step + math.ceil(delay / STEP - 1e-9)
            if distance <= audible and due >= state.step:
                row = (due, strike.number, entity, distance, strike)
                heapq.heappush(self._thunder, row)
        return tuple(heard)

    def _plan(self, state: WeatherState) -> None:
        """Flashes of the second that begins."""
        own = settings_of(state)
        if own.rate <= 0.0 or own.most <= 0.0:
            return
        clouds = list(_charged(state))
        total = own.rate * sum(cloud.rate for cloud in clouds)
        if total <= 0.0:
            return
        factor = own.rate * min(own.most / total, 1.0) / 60.0
        for cloud in clouds:
            chance = scramble(state.seed, cloud.uid, cloud.serial, state.step, 71)
            for k in range(lightning.poisson(factor * cloud.rate, uniform(chance, 1))):
                strike = _flash(state, cloud, own.ground_share, scramble(chance, 2, k) & WORD)
                if strike is not None:
                    state.strikes.add(strike, drawn=strike.ground)


def _charged(state: WeatherState) -> Iterator[Charged]:
    """The clouds that may flash, in a fixed order."""
    for uid, layer in alive(SkyLayer, state.uids):
        record = state.clouds.layers.get(uid)
        if record is not None and len(record.array):
            yield from _of_layer(state, layer, record)
    for uid, cloud in alive(Cloud, state.uids):
        model = state.models.find(cloud.model, state.uids)
        rate = 0.0 if model is None else model.lightning * (cloud.growth * cloud.opacity) ** 2
        if model is not None and rate > 0.0:
            place = cloud.position
            yield Charged(uid, -1, rate, model, cloud.number, place, cloud.scale, cloud.heading)


def _of_layer(state: WeatherState, layer: SkyLayer, record: LayerClouds) -> Iterator[Charged]:
    models, array = state.models.of_skies(layer.skies, state.uids), record.array
    if not any(model.lightning > 0.0 for model in models.values()):
        return
    of_kind = [models.get((kind.sky, kind.model)) for kind in array.kinds]
    able = np.array([model is not None and model.lightning > 0.0 for model in of_kind], bool)
    rows = np.flatnonzero(able[array.kind])
    x = array.x[rows] * QUANTUM + record.offset[0]
    z = array.z[rows] * QUANTUM + record.offset[1]
    whole = growth(array, record.ticks)[rows] * inside(x, z, layer)
    scale = scales(array.serial[rows], record.uid)
    base = layer.base + lifts(array.serial[rows], record.uid, layer.variation)
    now = layer_state(state, record.uid) if esper.get_component(Climate) else 1.0
    for k, row in enumerate(rows.tolist()):
        kind, model = array.kinds[array.kind[row]], of_kind[array.kind[row]]
        assert model is not None
        come = min(now / kind.sky, 1.0) if kind.sky > 0.0 else 1.0
        rate = model.lightning * (float(whole[k]) * come) ** 2
        if rate > 0.0:
            place = (float(x[k]), float(base[k]), float(z[k]))
            serial = int(array.serial[row])
            yield Charged(record.uid, serial, rate, model, kind.number, place, float(scale[k]), 0.0)


def _flash(state: WeatherState, cloud: Charged, ground_share: float, word: int) -> Strike | None:
    """One flash of a cloud, some time in the second that begins."""
    step = state.step + 1 + int(uniform(word, 11) * STEPS)
    if step > MOST_STEPS:
        return None
    ground = uniform(word, 12) < ground_share
    made = state.cloud_shapes.get(cloud.model, cloud.number).made
    origin = _place_in(made.centers, made.half[1], cloud, BELOW if ground else ABOVE, word, 13)
    if ground:
        floor = min(state.profile.ground, origin[1])
        aside = ASIDE * (origin[1] - floor) * math.sqrt(uniform(word, 14))
        turn = 2.0 * math.pi * uniform(word, 15)
        x, z = origin[0] + aside * math.cos(turn), origin[2] + aside * math.sin(turn)
        target = (round(x, 1), floor, round(z, 1))
    else:
        places = [
            _place_in(made.centers, made.half[1], cloud, ABOVE, word, salt) for salt in (16, 17, 18)
        ]
        target = max(places, key=lambda place: math.dist(place, origin))
    return Strike(0, step, origin, target, lightning.peak_current(word), ground, word)


def _place_in(
    centers: NDArray, half: float, cloud: Charged, part: tuple[float, float], word: int, salt: int
) -> Vector:
    """The middle of one of a cloud's seeds in a part of its height; any where there is none."""
    rise = 0.5 + 0.5 * centers[:, 1] / max(half, 1e-9)
    fits = np.flatnonzero((rise >= part[0]) & (rise <= part[1]))
    pick = uniform(word, salt)
    row = int(fits[int(pick * len(fits))]) if len(fits) else int(pick * len(centers))
    x, y, z = (cloud.scale * float(value) for value in centers[row])
    c, s = math.cos(cloud.heading), math.sin(cloud.heading)
    bx, by, bz = cloud.base
    at = (bx + x * c + z * s, by + y + cloud.scale * half, bz + z * c - x * s)
    return round(at[0], 1), round(at[1], 1), round(at[2], 1)


def _resolved(state: WeatherState, strike: Strike) -> Strike:
    """The strike with the end that the ground and the things on it give it."""
    x, _, z = strike.target
    ground = min(state.profile.ground, strike.origin[1])
    tips = tips_near(x, z, lightning.striking_distance(strike.current))
    target = lightning.attached(x, z, ground, strike.current, tips[tips[:, 1] < strike.origin[1]])
    return strike._replace(target=target)


def called(
    state: WeatherState, target: Vector | None, origin: Vector | None, current: float | None
) -> None:
    """A strike that the game calls, due in the next fixed step."""
    step = min(state.clock.steps + 1, MOST_STEPS)
    word = scramble(state.seed, state.strikes.following, step, 72) & WORD
    aimed = target is not None
    if target is None:
        assert origin is not None
        target = (origin[0], min(state.profile.ground, origin[1]), origin[2])
    if origin is None:
        aside, turn = 0.25 * HEIGHT * uniform(word, 14), 2.0 * math.pi * uniform(word, 15)
        x, z = target[0] + aside * math.cos(turn), target[2] + aside * math.sin(turn)
        origin = (x, target[1] + HEIGHT, z)
    amount = lightning.peak_current(word) if current is None else current
    strike = Strike(0, step, origin, target, amount, True, word)
    state.strikes.add(strike, drawn=not aimed)
