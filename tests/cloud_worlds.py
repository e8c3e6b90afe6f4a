"""Small skies for the tests of clouds."""

from __future__ import annotations

from typing import Any

import esper
import numpy as np

from weather_ecs import Weather
from weather_ecs.components import CloudModel, CloudRoot, CloudSeed, Sky, SkyLayer
from weather_ecs.frame import FrameData
from weather_ecs.systems.cloud_layer import LayerClouds
from weather_ecs.systems.cloud_place import QUANTUM

ROOT = CloudRoot(reproductions_min=2, reproductions_max=2, seeds_start=3, seeds_end=2)


def model(name: str, size: float = 200.0, **fields: Any) -> CloudModel:
    """A cloud of six seeds, twelve billboards."""
    seed = CloudSeed(width=size, height=0.5 * size, depth=size, roots=(ROOT,))
    given = {"billboards_min": 2, "billboards_max": 2, "size_min": 50.0, "size_max": 90.0}
    return CloudModel(name, (seed,), **{**given, **fields})


def sky(state: float, count: int, *names: str, **fields: Any) -> Sky:
    """A sky of nested models; without names of one that is called after its state."""
    models = tuple([model(name) for name in names or (f"at {round(100 * state)}",)])
    return Sky(state, models, count=count, **{"generated": 4, **fields})


FOUR = (0.0, 0.25, 0.75, 1.0)


def four_skies(count: int = 40) -> tuple[Sky, ...]:
    """The skies of the worked example (Torchelsen 2005, 3.4), `count` clouds in each."""
    return tuple([sky(state, count) for state in FOUR])


def layer(skies: tuple[Sky, ...], **fields: Any) -> SkyLayer:
    """2 km by 1 km that clouds cross in 100 s."""
    given: dict[str, Any] = {"size": (2000.0, 1000.0), "velocity": (20.0, 0.0)}
    return SkyLayer(skies=skies, **{**given, **fields})


def record(weather: Weather, number: int = 0) -> LayerClouds:
    """The clouds of the layer that was made first, or of a later one."""
    return sorted(weather._state.clouds.layers.items())[number][1]


def drawn(weather: Weather) -> FrameData:
    """The frame as it is for somebody who draws."""
    weather._state.drawn = True
    return weather._frame()


def places(of: LayerClouds) -> np.ndarray:
    """World positions (x, z) as of the last full second, m."""
    at = np.column_stack((of.array.x, of.array.z)) * QUANTUM
    return at + np.array(of.offset)


def skies_of(of: LayerClouds) -> dict[int, float]:
    """State of the sky that each standing cloud was drawn from, by serial number."""
    array = of.array
    stands = array.dying < 0
    return {
        int(serial): array.kinds[kind].sky
        for serial, kind in zip(array.serial[stands], array.kind[stands], strict=True)
    }


def seconds(count: float, at_once: float = 1.0) -> None:
    """Let time pass."""
    for _ in range(round(count / at_once)):
        esper.process(at_once)
