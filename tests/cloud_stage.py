"""Hand-made clouds and an off-screen picture of them, through the renderer."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from dataclasses import replace
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from tests.views import look_from, perspective
from weather_ecs.frame import BILLBOARD_DTYPE, CLOUD_DTYPE, CloudShapeData, FrameData, ViewData
from weather_ecs.gpu.renderer import Renderer
from weather_ecs.quality import LEVELS, QualitySettings

SIZE = (192, 108)
SETTINGS = replace(LEVELS["low"], cloud_atlas=512, cloud_tile=128)
NORTH = np.pi / 2  # heading along -z


def shape(
    key: int = 1,
    centers: Any = ((0.0, 0.0, 0.0),),
    size: Any = (200.0, 100.0, 200.0),
    absorbed: float | Any = 0.3,
    billboards: int = 6,
    width: float = 120.0,
    image: int = 0,
    seed: int = 0,
) -> CloudShapeData:
    """A cloud of boxes with so many billboards in each, placed at random."""
    rng = np.random.default_rng(seed)
    middles = np.array(centers, np.float32).reshape(-1, 3)
    sizes = np.broadcast_to(np.float32(size), middles.shape).copy()
    rows = np.zeros(billboards * len(middles), BILLBOARD_DTYPE)
    rows["seed"] = np.repeat(np.arange(len(middles)), billboards)
    spread = rng.uniform(-0.5, 0.5, (len(rows), 3)) if billboards > 1 else np.zeros((len(rows), 3))
    rows["position"] = middles[rows["seed"]] + spread * sizes[rows["seed"]]
    rows["size"] = width
    rows["turn"] = rng.uniform(-3.0, 3.0, len(rows)) if billboards > 1 else 0.0
    rows["image"], rows["opacity"] = image, 1.0
    rows["order"] = np.linspace(0.0, 1.0, len(rows)) if len(rows) > 1 else 0.5
    lost = np.broadcast_to(np.float32(absorbed), len(middles)).copy()
    corner = np.abs(middles) + 0.5 * sizes
    radius = float(np.linalg.norm(corner, axis=1).max())
    return CloudShapeData(key, middles, sizes, lost, (0.0, 1.0, 0.0), rows, radius, 400.0)


def clouds(*rows: dict[str, Any]) -> NDArray:
    """CLOUD_DTYPE rows; whole and opaque where nothing else is said, keys from 1 on."""
    made = np.zeros(len(rows), CLOUD_DTYPE)
    for name in ("scale", "mirror", "growth", "opacity"):
        made[name] = 1.0
    made["key"] = np.arange(1, len(rows) + 1)
    for entry, fields in zip(made, rows, strict=True):
        for name, value in fields.items():
            entry[name] = value
    return made


def sky_frame(rows: NDArray, *shapes: CloudShapeData, **rest: Any) -> FrameData:
    return FrameData(clouds=rows, cloud_shapes=shapes, **rest)


def view_of(
    frame: FrameData,
    position: tuple[float, float, float] = (0.0, 2.0, 0.0),
    heading: float = NORTH,
    pitch: float = 0.0,
    dt: float = 0.0,
    aspect: float = SIZE[0] / SIZE[1],
    far: float = 2000.0,
) -> ViewData:
    return ViewData(
        frame,
        0,
        look_from(position, heading, pitch),
        perspective(aspect=aspect, far=far),
        position,
        (0.0, 0.0, 0.0),
        dt,
        (),
        (),
    )


class CloudStage:
    """A renderer and a picture."""

    def __init__(self, ctx: moderngl.Context, backend: str = "auto") -> None:
        self.ctx = ctx
        self.color = ctx.texture(SIZE, 4)
        self.depth = ctx.depth_texture(SIZE)
        self.target = ctx.framebuffer([self.color], self.depth)
        self.renderer = Renderer(ctx, backend=backend)
        self.settings: QualitySettings = SETTINGS
        self.background = (0.2, 0.4, 0.8, 1.0)

    @property
    def passes(self) -> Any:
        return self.renderer.clouds

    def draw(self, frame: FrameData, depth: float = 1.0, **camera: Any) -> NDArray[np.float64]:
        """The picture in [0, 1], (height, width, 3), rows from below."""
        self.target.use()
        self.target.clear(*self.background, depth=depth)
        self.renderer.draw(view_of(frame, **camera), self.settings)
        assert self.ctx.error == "GL_NO_ERROR"
        return self.picture()

    def picture(self) -> NDArray[np.float64]:
        data = np.frombuffer(self.target.read(components=3), np.uint8)
        return data.reshape(SIZE[1], SIZE[0], 3) / 255.0

    def cover(self, picture: NDArray[np.float64]) -> NDArray[np.float64]:
        """By how much each pixel differs from the background."""
        empty = np.rint(np.array(self.background[:3]) * 255.0) / 255.0
        return np.abs(picture - empty).max(axis=2)

    def release(self) -> None:
        self.renderer.release()
        for thing in (self.target, self.depth, self.color):
            thing.release()


@contextmanager
def cloud_stage(ctx: moderngl.Context, backend: str = "auto") -> Iterator[CloudStage]:
    """A stage; everything is given back at the end."""
    made = CloudStage(ctx, backend)
    try:
        yield made
    finally:
        made.release()
