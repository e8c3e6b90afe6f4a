"""`CloudSystem`: carries on all clouds, those of the layers and the game's own, once a second."""

from __future__ import annotations

from typing import Any

import esper

from weather_ecs.clock import STEP
from weather_ecs.components import Climate, Cloud, SkyLayer
from weather_ecs.components._base import FAR, set_unchecked
from weather_ecs.components.cloud_model import CloudModel
from weather_ecs.physics.wind import height_share
from weather_ecs.systems.climate import oldest_state, state_of
from weather_ecs.systems.cloud_layer import TICK, Box, LayerClouds
from weather_ecs.systems.cloud_made import share_of
from weather_ecs.systems.cloud_mix import Mix, mix_at, nearest_mix
from weather_ecs.systems.queries import alive
from weather_ecs.systems.state import WeatherState

STEPS = round(TICK / STEP)
FOLLOWING = 30.0  # s in which clouds come to follow a wind that has changed

_EASE = 1.0 - TICK / FOLLOWING


def start_layer(state: WeatherState, uid: int, layer: SkyLayer) -> LayerClouds:
    """A layer's clouds at their start: the sky nearest to the state fills the rectangle."""
    box = _box(layer)
    record = LayerClouds(state.seed, uid, box, (0.0, 0.0))
    record.wind = (state.wind[0], state.wind[2])
    record.velocity = _velocity(state, layer, record.wind)
    record.known = known_of(layer)
    record.fill(nearest_mix(layer.skies, layer_state(state, uid)))
    return record


def layer_state(state: WeatherState, uid: int) -> float:
    """The state that the skies of a layer are at: of its own climate, or everybody's."""
    for owner, climate in alive(Climate, state.uids):
        if owner == uid:
            return state_of(climate)
    return oldest_state(state) or 0.0


class CloudSystem:
    """Starts the layers that are new and carries on all clouds at every full second."""

    def __init__(self) -> None:
        self._list: list[Any] | None = None
        self._field: object = None
        self._mixes: dict[int, tuple[tuple[Any, ...], Mix, frozenset[tuple[float, str]]]] = {}

    def run(self, state: WeatherState) -> None:
        """One fixed step."""
        full = state.step % STEPS == 0
        layers = esper.get_component(SkyLayer)
        if full or layers is not self._list or state.clouds is not self._field:
            self._list, self._field = layers, state.clouds
            self._carry_on(state, full)
        if full and esper.get_component(Cloud):
            _move_clouds(state)

    def _carry_on(self, state: WeatherState, full: bool) -> None:
        found, records = alive(SkyLayer, state.uids), state.clouds.layers
        living = {uid for uid, _ in found}
        for uid in [uid for uid in records if uid not in living]:
            del records[uid]
        self._mixes = {uid: mix for uid, mix in self._mixes.items() if uid in records}
        for uid, layer in found:
            record = records.get(uid)
            if record is None:
                records[uid] = start_layer(state, uid, layer)
                continue
            if full:
                mix, known = self._mix(state, uid, layer)
                if known != record.known:
                    record.renew(known, mix)
                x, z = record.wind
                record.wind = (
                    state.wind[0] + (x - state.wind[0]) * _EASE,
                    state.wind[2] + (z - state.wind[2]) * _EASE,
                )
                velocity = _velocity(state, layer, record.wind)
                record.tick(velocity, _box(layer), mix, layer.turnover)

    def _mix(
        self, state: WeatherState, uid: int, layer: SkyLayer
    ) -> tuple[Mix, frozenset[tuple[float, str]]]:
        """What comes in now, and the names of the layer's models; kept while nothing changes."""
        now = (layer.skies, layer_state(state, uid), CloudModel.revision())
        known = self._mixes.get(uid)
        if known is None or known[0] != now:
            mix = mix_at(layer.skies, now[1])
            known = self._mixes[uid] = (now, mix, known_of(layer))
        return known[1], known[2]


def known_of(layer: SkyLayer) -> frozenset[tuple[float, str]]:
    """State of the sky and name of each model of a layer."""
    return frozenset(
        (sky.state, model if isinstance(model, str) else model.name)
        for sky in layer.skies
        for model in sky.models
    )


def _box(layer: SkyLayer) -> Box:
    return Box(*layer.center, *layer.size)


def _velocity(
    state: WeatherState, layer: SkyLayer, wind: tuple[float, float]
) -> tuple[float, float]:
    """The layer's own velocity and its share of the wind at its height, m/s."""
    x, z = layer.velocity
    if layer.drift > 0.0:
        profile = state.profile
        height = layer.base - profile.ground
        share = layer.drift * height_share(height, profile.reference, profile.exponent)
        x, z = x + share * wind[0], z + share * wind[1]
    return x, z


def _move_clouds(state: WeatherState) -> None:
    """Carry the game's own clouds on by a second; at the end of the world they stop."""
    for _, cloud in alive(Cloud, state.uids):
        share = share_of(cloud, state.profile)
        vx = cloud.velocity[0] + share * state.wind[0]
        vz = cloud.velocity[1] + share * state.wind[2]
        if vx or vz:
            x, y, z = cloud.position
            x = min(max(x + vx * TICK, -FAR), FAR)
            z = min(max(z + vz * TICK, -FAR), FAR)
            set_unchecked(cloud, "position", (x, y, z))
