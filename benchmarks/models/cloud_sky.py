"""A sky of drifting clouds over a plain picture, with a climate running: what `clouds` measures."""

from __future__ import annotations

import math
from time import thread_time

import esper
import numpy as np
from numpy.typing import NDArray

from benchmarks.models.stage import Camera, Stage
from weather_ecs import Weather
from weather_ecs.components import Climate, Sky, SkyLayer, Sun

PITCH = 0.28  # rad, that the camera looks up by: the horizon is in the lower third
BASE = 1000.0  # m, of the clouds
WIND = (9.0, 4.0)  # m/s
DURATION = 120.0  # s of the climate from clear to storm


class CloudSky:
    """`count` clouds in a square of `side` metres about the observer, in a world of its own."""

    def __init__(
        self, stage: Stage, name: str, count: int, side: float, generated: int, quality: str
    ) -> None:
        self.name, self.count, self._stage = name, count, stage
        self._world = f"benchmark {name}"
        self._angle = 0.6  # rad, height of the sun
        eye = Camera(aspect=stage.size[0] / stage.size[1])
        self._view, self._projection = pitched(eye.view, PITCH), eye.projection
        esper.switch_world(self._world)
        self.weather = Weather(context=stage.ctx, seed=4, quality=quality)
        skies = (
            Sky(0.0, ("cumulus",), generated=generated, count=count),
            Sky(1.0, ("cumulus", "stratocumulus"), generated=generated, count=count),
        )
        self._sun = Sun(direction=(0.5, math.sin(self._angle), 0.6))
        esper.create_entity(self._sun)
        esper.create_entity(SkyLayer(base=BASE, size=(side, side), skies=skies, velocity=WIND))
        esper.create_entity(Climate(duration=DURATION))

    def move(self, dt: float) -> None:
        esper.switch_world(self._world)
        esper.process(dt)

    def draw(self) -> None:
        self.weather.draw(self._view, self._projection)

    def turn_sun(self) -> None:
        """So far that the light of every cloud has to be computed again."""
        self._angle = 0.3 + (self._angle + 0.2) % 0.9
        self._sun.direction = (0.5, math.sin(self._angle), 0.6)

    def process_ms(self, dt: float) -> float:
        """CPU milliseconds of this thread that one `esper.process` takes."""
        esper.switch_world(self._world)
        start = thread_time()
        esper.process(dt)
        return (thread_time() - start) * 1e3

    def release(self) -> None:
        esper.switch_world(self._world)
        self.weather.close()
        esper.switch_world("default")
        esper.delete_world(self._world)


def pitched(view: NDArray[np.float64], angle: float) -> NDArray[np.float64]:
    """The view of a camera that looks up by an angle more."""
    c, s = math.cos(angle), math.sin(angle)
    turn = np.eye(4)
    turn[1:3, 1:3] = [[c, s], [-s, c]]
    pitched_view: NDArray[np.float64] = turn @ view
    return pitched_view
