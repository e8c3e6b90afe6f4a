"""The clouds over the place: four layers, a climate, and a cloud over each of the game's rains."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

import esper

from demo_game.rain_cloud import place_over, rain_cloud_model
from weather_ecs import presets
from weather_ecs.components import Climate, Cloud, RainArea, Sky, SkyLayer

DURATION = 150.0  # s from clear to storm and back again
SETTLING = 14.0  # s in which the clouds come to be those of another state
SETTLED = 60.0  # s after a change by which they are
CHANGED = 0.004  # of the state, that calls for other clouds
FAIR_BASE = 600.0, 2000.0  # m, between which the bases of cumulus are
STEADY = (5.2, 2.1)  # (x, z), m/s, of clouds that the wind of a preset does not carry
FEW = 0.6  # of the cumulus of a fair sky
RAINY = ("nimbostratus", "cumulonimbus", "stratus")


class Cloudscape:
    """Makes the entities in esper's current world and keeps them in step with the game's mood."""

    def __init__(
        self,
        state: float,
        areas: Sequence[RainArea],
        layers: Sequence[SkyLayer],
    ) -> None:
        self.layers = list(layers)
        self.climate = Climate(duration=DURATION, elapsed=state * DURATION, running=False)
        for layer in self.layers:
            esper.create_entity(layer)
        self._climate_entity = esper.create_entity(self.climate)
        self._rates: dict[str, float] = {}
        self._models = [presets.cloud_model(name) for name in RAINY]
        for model in self._models:
            # The walk's rain falls where the game has put it, and the sky's only in a climate run.
            self._rates[model.name] = model.rain_rate
            model.rain_rate = 0.0
            esper.create_entity(model)
        self.clouds = []
        for number, area in enumerate(areas):
            model = rain_cloud_model(f"rain cloud {number}", area.radii)
            esper.create_entity(model)
            cloud = Cloud(model.name, (0.0, 0.0, 0.0), number=number, drift=0.0)
            esper.create_entity(cloud)
            self.clouds.append((cloud, area))
        self._last = state
        self._rains = False
        self._skies = [layer.skies for layer in self.layers]
        self._is_shown = True
        self._left = 0.0  # s for which the clouds go on changing where they stand

    @property
    def state(self) -> float:
        """Of the climate, 0 clear to 1 storm."""
        c = self.climate
        done = min(c.elapsed / c.duration, 1.0)
        return c.initial + (c.final - c.initial) * done

    @property
    def is_running(self) -> bool:
        """Whether the climate is on its way by itself."""
        return self.climate.running

    def run(self) -> bool:
        """Let the climate run, the other way each time; whether it is on its way to the storm."""
        onwards = self.climate.speed < 0.0 if self.climate.running else self.state < 0.9
        self._be_at(self.state)
        self.climate.speed = 1.0 if onwards else -1.0
        if not self.climate.running:
            self.climate.running = True
        self.let_rain(True)
        return onwards

    def follow(self, climate: Climate | None) -> None:
        """Another climate counts: that of a file; without one the game's own, where it was."""
        own = esper.entity_exists(self._climate_entity)
        if climate is not None and climate is not self.climate:
            if own:
                esper.delete_entity(self._climate_entity, immediate=True)
            self.climate, self._last = climate, 0.0
        elif climate is None and not own:
            self.climate = Climate(duration=DURATION, elapsed=self.state * DURATION, running=False)
            self._climate_entity = esper.create_entity(self.climate)

    def stop(self) -> None:
        """The mood says what the state is."""
        if self.climate.running:
            self.climate.running = False
        self.let_rain(False)

    def update(self, dt: float, state: float, rates: Sequence[float]) -> None:
        """Let dt seconds pass; the mood's `state` counts while the climate does not run.

        rates: mm/h, of the game's areas.
        """
        if not self.climate.running and abs(state - self.state) > 1e-9:
            self._be_at(state)
        if abs(self.state - self._last) > CHANGED:
            self._last, self._left = self.state, SETTLED
        self._left = max(self._left - dt, 0.0)
        turnover = SETTLING if self._left > 0.0 else 0.0
        for layer in self.layers:
            if layer.turnover != turnover:
                layer.turnover = turnover
        for (cloud, area), rate in zip(self.clouds, rates, strict=True):
            place_over(cloud, area, rate)

    def _be_at(self, state: float) -> None:
        climate = self.climate
        if (climate.initial, climate.final) != (0.0, 1.0):
            climate.initial, climate.final = 0.0, 1.0
        climate.elapsed = state * climate.duration

    def show(self, shown: bool) -> None:
        """Fill the layers as they were, or empty them: a whole weather has clouds of its own."""
        if shown is self._is_shown:
            return
        self._is_shown, self._left = shown, SETTLED
        for layer, skies in zip(self.layers, self._skies, strict=True):
            layer.skies = skies if shown else (Sky(0.0),)

    def let_rain(self, rains: bool) -> None:
        """Whether the clouds of the sky bring their own rain."""
        if rains is self._rains:
            return
        self._rains = rains
        for model in self._models:
            model.rain_rate = self._rates[model.name] if rains else 0.0


def all_layers() -> list[SkyLayer]:
    """The package's skies."""
    return list(presets.sky("clear").layers)


def steady_layers() -> list[SkyLayer]:
    """The package's skies, which drift the same whatever the wind."""
    layers = all_layers()
    for layer in layers:
        (x, z), share = layer.velocity, layer.drift
        layer.velocity = (x + share * STEADY[0], z + share * STEADY[1])
        layer.drift = 0.0
    return layers


def light_layers() -> list[SkyLayer]:
    """Some cumulus, few enough that a machine without a GPU draws them beside all the rest.

    They drift the same whatever the wind.
    """
    low = next(layer for layer in all_layers() if FAIR_BASE[0] < layer.base < FAIR_BASE[1])
    fair = next(sky for sky in low.skies if sky.state == presets.SKIES["fair"])
    low.drift, low.velocity = 0.0, STEADY
    low.skies = (replace(fair, count=round(FEW * fair.count)),)
    return [low]
