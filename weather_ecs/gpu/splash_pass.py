"""The splashes: crowns wherever rain has hit something, films and droplets close by."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
import math

import moderngl

from weather_ecs.frame import SplashLook, ViewData
from weather_ecs.gpu.blocks import BlockBuffer, UniformBlock
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.impact_source import ImpactReader
from weather_ecs.gpu.rain_pass import RainPass
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.gpu.splash_texture import splash_texture
from weather_ecs.gpu.timer import PrimitiveCounter
from weather_ecs.physics.splash import acceleration

MAX_WATERS = 8
FRAMES_UNIT = 2
# Drops of one container that are looked at on the feedback backend, as the list is bounded too.
MOST_DROPS = 65_536

SPLASH = UniformBlock(
    "Splash",
    ("splash_look", "vec4"),  # size, largest radius in m, duration in s, opacity
    ("splash_spray", "vec4"),  # share, droplets, their share of the speed, spread in rad
    ("splash_pull", "vec4"),  # m/s2, of the droplets; m, distance of detail
    ("splash_grain", "vec4"),  # m, diameter of a droplet as it is drawn
    ("water_axis", "vec4", MAX_WATERS),  # centre x, centre z, cos heading, sin heading
    ("water_shape", "vec4", MAX_WATERS),  # half-sizes along the heading and across, level, m
    ("water_count", "int"),
)
CROWN = ProgramKey(vertex="splash.vert", geometry="splash.geom", fragment="splash.frag")
DETAIL = ProgramKey(
    vertex="splash.vert",
    geometry="splash_detail.geom",
    fragment="splash.frag",
    defines=("DETAIL",),
)


@dataclass(frozen=True, slots=True)
class WaterRectangle:
    """Where splashes are those of water."""

    center: tuple[float, float]  # (x, z), m
    half: tuple[float, float]  # m, along the heading and across
    heading: float  # rad
    level: float  # m


class SplashPass:
    """Draws the splashes of a view's impacts; make it before the rain's first update."""

    def __init__(
        self, ctx: moderngl.Context, gl: GL, shaders: ShaderLoader, rain: RainPass
    ) -> None:
        self._texture = splash_texture(ctx)
        self._block = BlockBuffer(ctx, SPLASH)
        self._crowns = ImpactReader(ctx, shaders, rain, "crown", CROWN)
        self._details = ImpactReader(ctx, shaders, rain, "splash detail", DETAIL)
        for reader in (self._crowns, self._details):
            reader.program["splash_frames"] = FRAMES_UNIT
        self._counter = PrimitiveCounter(gl)

    @property
    def drawn(self) -> int:
        """Splashes of the latest frame that the GPU has done; asked before a frame is drawn."""
        return (self._counter.latest or 0) // 2

    def draw(
        self, view: ViewData, look: SplashLook, waters: Sequence[WaterRectangle] = ()
    ) -> None:
        """Blending, the depth test and a depth mask that is off are the caller's.

        Needs the blocks RainView and Shelter bound, and the heightmap at its unit.
        """
        self._fill(view, look, waters)
        self._texture.use(FRAMES_UNIT)
        if look.detail > 0.0:
            self._details.run(view, _points)
        self._counter.begin()
        self._crowns.run(view, _points)
        self._counter.end()

    def _fill(
        self, view: ViewData, look: SplashLook, waters: Sequence[WaterRectangle]
    ) -> None:
        data = self._block.data
        data["splash_look"] = (look.size, look.largest, look.duration, look.opacity)
        data["splash_spray"] = (look.share, look.droplets, look.droplet_speed, look.spread)
        data["splash_pull"] = (*acceleration(view.frame.wind, look.drift), look.detail)
        data["splash_grain"] = (look.droplet_size * 1e-3, 0.0, 0.0, 0.0)
        count = min(len(waters), MAX_WATERS)
        for k in range(count):
            water = waters[k]
            turn = math.cos(water.heading), math.sin(water.heading)
            data["water_axis"][k] = (*water.center, *turn)
            data["water_shape"][k] = (*water.half, water.level, 0.0)
        data["water_count"] = count
        self._block.upload()
        self._block.bind()

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for thing in (
            self._counter, self._details, self._crowns, self._block, self._texture
        ):  # fmt: skip
            thing.release()


def _points(array: moderngl.VertexArray, count: int) -> None:
    array.render(moderngl.POINTS, vertices=min(count, MOST_DROPS))
