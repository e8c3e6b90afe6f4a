"""A weather that draws into an off-screen picture, frame by frame."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any

import esper
import moderngl
import numpy as np

from tests.views import look_from, perspective
from tests.worlds import fresh_world
from weather_ecs import Weather
from weather_ecs.components import Observer

SIZE = (160, 90)


class Stage:
    """A world of its own with a weather in it, and the picture it draws."""

    def __init__(self, ctx: moderngl.Context, size: tuple[int, int], **arguments: Any) -> None:
        self.ctx = ctx
        self.size = size
        self.color = ctx.texture(size, 4)
        self.depth = ctx.depth_texture(size)
        self.target = ctx.framebuffer([self.color], self.depth)
        self.background: tuple[float, ...] = (0.3, 0.33, 0.3, 1.0)
        self.target.use()
        self.weather = Weather(context=ctx, **{"seed": 5, "quality": "low", **arguments})

    def clear(self) -> None:
        self.target.use()
        self.target.clear(*self.background)

    def draw(
        self,
        position: tuple[float, float, float] = (0.0, 1.7, 0.0),
        heading: float = 0.0,
        pitch: float = 0.0,
        observer: Observer | None = None,
    ) -> np.ndarray:
        """The weather over a cleared picture, (height, width, 3) in 0 to 255, rows from below."""
        self.clear()
        view = look_from(position, heading, pitch)
        projection = perspective(aspect=self.size[0] / self.size[1])
        self.weather.draw(view, projection, observer=observer)
        return self.picture()

    def play(self, frames: int, dt: float = 1 / 30, **at: Any) -> np.ndarray:
        """That many frames from one place; the last picture."""
        for _ in range(frames):
            esper.process(dt)
            found = self.draw(**at)
        return found

    def picture(self) -> np.ndarray:
        width, height = self.size
        pixels = np.frombuffer(self.target.read(components=3), np.uint8)
        return pixels.reshape(height, width, 3)

    def rain(self, picture: np.ndarray) -> np.ndarray:
        """By how much each pixel differs from the background, (height, width), 0 to 255."""
        empty = np.rint(np.array(self.background[:3]) * 255.0)
        return np.abs(picture - empty).max(axis=2)

    def release(self) -> None:
        self.weather.close()
        for thing in (self.target, self.depth, self.color):
            thing.release()


@contextmanager
def stage(ctx: moderngl.Context, size: tuple[int, int] = SIZE, **arguments: Any) -> Iterator[Stage]:
    """A stage in a fresh world; everything is given back at the end."""
    with fresh_world():
        made = Stage(ctx, size, **arguments)
        try:
            yield made
        finally:
            made.release()
