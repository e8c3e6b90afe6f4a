"""What every model draws into: a plain picture with depth, one camera, and the share it covers."""

from __future__ import annotations

import math
import sys
from dataclasses import dataclass
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

BACKGROUND = (0.30, 0.33, 0.30)  # encoded; the dull green of a wet hillside
COVERED = 3  # of 255: a pixel that the drops change by more, in any channel, is covered


def create_context() -> moderngl.Context:
    """An OpenGL context without a window."""
    settings: dict[str, Any] = {"backend": "egl"} if sys.platform.startswith("linux") else {}
    return moderngl.create_context(standalone=True, require=330, **settings)


@dataclass(frozen=True)
class Look:
    """How rain looks: covered share of the pixels, and their mean change in [0, 1]."""

    covered: float
    strength: float


@dataclass(frozen=True)
class Camera:
    """A level camera that stands still; matrices (4, 4) for column vectors."""

    eye: tuple[float, float, float] = (0.0, 1.7, 0.0)  # m
    heading: float = 0.5 * math.pi  # rad, counter-clockwise seen from above, 0 along +x
    vertical: float = 60.0  # degrees, field of view
    aspect: float = 16.0 / 9.0

    @property
    def view(self) -> NDArray[np.float64]:
        c, s = math.cos(self.heading), math.sin(self.heading)
        rotation = np.array([[s, 0.0, c], [0.0, 1.0, 0.0], [-c, 0.0, s]])
        view = np.eye(4)
        view[:3, :3] = rotation
        view[:3, 3] = -rotation @ np.array(self.eye)
        return view

    @property
    def projection(self) -> NDArray[np.float64]:
        near, far = 0.1, 2000.0
        t = 1.0 / math.tan(math.radians(self.vertical) / 2.0)
        projection = np.zeros((4, 4))
        projection[0, 0], projection[1, 1] = t / self.aspect, t
        projection[2, 2] = -(far + near) / (far - near)
        projection[2, 3] = -2.0 * far * near / (far - near)
        projection[3, 2] = -1.0
        return projection


class Stage:
    """A framebuffer of `size` pixels with a plain background."""

    def __init__(self, ctx: moderngl.Context, size: tuple[int, int] = (1280, 720)) -> None:
        self.ctx = ctx
        self.size = size
        self.camera = Camera(aspect=size[0] / size[1])
        self._color = ctx.texture(size, 4)
        self._depth = ctx.depth_texture(size)
        self._target = ctx.framebuffer([self._color], self._depth)
        self.begin()  # even what draws nothing needs a complete framebuffer

    def begin(self) -> None:
        """Bind the picture and clear it."""
        self._target.use()
        self._target.clear(*BACKGROUND, 1.0)

    def picture(self) -> NDArray[np.uint8]:
        """(height, width, 3), top row first."""
        width, height = self.size
        data = np.frombuffer(self._target.read(components=3, alignment=1), np.uint8)
        return data.reshape(height, width, 3)[::-1]

    def look(self) -> Look:
        plain = np.round(np.array(BACKGROUND) * 255.0).astype(np.int16)
        change = np.abs(self.picture().astype(np.int16) - plain).max(axis=2)
        covered = change > COVERED
        share = float(covered.mean())
        return Look(share, float(change[covered].mean()) / 255.0 if share > 0.0 else 0.0)

    def release(self) -> None:
        for thing in (self._target, self._depth, self._color):
            thing.release()
