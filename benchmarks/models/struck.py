"""Our rain over a scene, with or without collisions, at any number of drops."""

from __future__ import annotations

from benchmarks.models.ours import OurRain
from benchmarks.models.scene import Scene
from benchmarks.models.stage import Stage
from weather_ecs import QualitySettings
from weather_ecs.components import SplashEmitter
from weather_ecs.presets import PRESETS

RAIN_RATE = PRESETS["heavy"].rain_rate
MAP_SIZE = 1024  # texels on a side of the map of what rain hits, as quality "high" has it


def case_name(drops: int, backend: str, collisions: bool) -> str:
    return f"{drops}_{backend}_{'with' if collisions else 'without'}"


class StruckRain:
    """A frame is `move`, `draw_scene` and `draw`; the thing moves with and without collisions."""

    name = "struck"

    def __init__(
        self, stage: Stage, scene: Scene, drops: int, *, backend: str, collisions: bool
    ) -> None:
        self._scene = scene
        self._time = 0.0
        self._place = scene.place(0.0)
        occluders = scene.occluders() if collisions else []
        self._moving = occluders[-1] if collisions else None
        settings = QualitySettings(f"{drops} drops", drops, 1, MAP_SIZE, False)
        others = [*occluders, SplashEmitter()] if collisions else []
        self.rain = OurRain(stage, RAIN_RATE, quality=settings, backend=backend, others=others)
        self.drops = self.rain.drops

    def move(self, dt: float) -> None:
        """The game's part, a thing that has moved, and the weather's."""
        self._time += dt
        self._place = self._scene.place(self._time)
        if self._moving is not None:
            self._moving.transform = self._place
        self.rain.move(dt)

    def draw_scene(self) -> None:
        self._scene.draw(self._place)

    def draw(self) -> None:
        self.rain.draw()

    def release(self) -> None:
        self.rain.release()
