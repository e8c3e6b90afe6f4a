"""A sky, drawn and read back."""

from __future__ import annotations

import math

import esper
import moderngl
import numpy as np
from numpy.typing import NDArray

from tests.views import look_from, perspective
from weather_ecs import Weather
from weather_ecs.components import Atmosphere

SIZE = (480, 270)


class Stage:
    """A host's framebuffer and a weather with an atmosphere that stands still."""

    def __init__(self, ctx: moderngl.Context, **fields: object) -> None:
        self.ctx = ctx
        self.color, self.depth = ctx.texture(SIZE, 4), ctx.depth_texture(SIZE)
        self.target = ctx.framebuffer([self.color], self.depth)
        self.weather = Weather(context=ctx, quality="low")
        self.air = Atmosphere(**{"speed": 0.0, "draw": True, **fields})  # type: ignore[arg-type]
        self.entity = esper.create_entity(self.air)

    def picture(
        self, heading: float, pitch: float, field: float = 60.0, depth: float = 1.0,
        height: float = 2.0,
    ) -> NDArray[np.float64]:  # fmt: skip
        """(height, width, 3), 0 to 1, lowest row first; height: of the eye, m."""
        esper.process(0.0)
        self.target.use()
        self.target.clear(0.25, 0.5, 0.75, 1.0, depth=depth)
        self.camera = look_from((0, height, 0), heading, pitch), perspective(field)
        self.weather.draw(*self.camera)
        assert self.ctx.error == "GL_NO_ERROR"
        raw = np.frombuffer(self.target.read(components=3), np.uint8)
        return raw.reshape(SIZE[1], SIZE[0], 3) / 255.0

    def directions(self) -> NDArray[np.float64]:
        """Through the middles of the pixels, unit, world axes."""
        view, p = self.camera
        x = (np.arange(SIZE[0]) + 0.5) / SIZE[0] * 2.0 - 1.0
        y = (np.arange(SIZE[1]) + 0.5) / SIZE[1] * 2.0 - 1.0
        ex, ey = np.meshgrid(x / p[0, 0], y / p[1, 1])
        rays = np.stack([ex, ey, -np.ones_like(ex)], -1) @ view[:3, :3]
        return np.asarray(rays / np.linalg.norm(rays, axis=-1, keepdims=True))

    def toward(self, direction: tuple[float, ...], field: float) -> NDArray[np.float64]:
        """A picture with a direction in its middle."""
        x, y, z = direction
        return self.picture(math.atan2(-z, x), math.asin(y), field)

    def release(self) -> None:
        self.weather.close()
        for thing in (self.target, self.color, self.depth):
            thing.release()


def profile(picture: NDArray, apart: NDArray, angles: NDArray) -> NDArray:
    """Mean light on rings round a direction, (n, 3)."""
    step = angles[1] - angles[0]
    rings = [picture[np.abs(apart - angle) < 0.5 * step] for angle in angles]
    return np.array([ring.mean(0) for ring in rings])
