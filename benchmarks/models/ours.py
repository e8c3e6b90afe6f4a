"""This package's rain, through its public face."""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from contextlib import contextmanager

import esper

from benchmarks.models.stage import Stage
from weather_ecs import QualitySettings, Weather
from weather_ecs.components import Observer, RainArea, RainContainer

WIDE = 1000.0  # m, radius of an area whose edge is out of the picture


class OurRain:
    """A weather in an esper world of its own; one area of rain all about the camera.

    Without `veil` the drops are drawn alone. `others` are further components, one entity each;
    the picture is drawn once for every Observer among them, once if there is none.
    """

    name = "ours"

    def __init__(
        self,
        stage: Stage,
        rain_rate: float,
        *,
        quality: str | QualitySettings = "high",
        backend: str = "auto",
        veil: bool = False,
        others: Sequence[object] = (),
    ) -> None:
        self._camera = (stage.camera.view, stage.camera.projection)
        self._world = f"benchmark {id(self)}"
        found: list[Observer | None] = [o for o in others if isinstance(o, Observer)]
        self._observers = found or [None]
        with self._in_world():
            self.weather = Weather(context=stage.ctx, quality=quality, backend=backend)
            x, _, z = stage.camera.eye
            esper.create_entity(RainArea(center=(x, z), radii=(WIDE, WIDE), rain_rate=rain_rate))
            if not veil:
                esper.create_entity(RainContainer(veil=0.0))
            for other in others:
                esper.create_entity(other)
        self.move(0.0)
        stage.begin()
        self.draw()
        self.drops = self.weather.stats.drops_moved

    @contextmanager
    def _in_world(self) -> Iterator[None]:
        before = esper.current_world
        esper.switch_world(self._world)
        try:
            yield
        finally:
            esper.switch_world(before)

    def move(self, dt: float) -> None:
        """The weather's own time; the drops follow it in `draw`."""
        with self._in_world():
            esper.process(dt)

    def draw(self) -> None:
        view, projection = self._camera
        for observer in self._observers:
            self.weather.draw(view, projection, observer=observer)

    def release(self) -> None:
        self.weather.close()
        esper.delete_world(self._world)
