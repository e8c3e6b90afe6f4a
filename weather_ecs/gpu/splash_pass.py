"""The splashes: crowns wherever rain has hit something, films and droplets close by."""

from __future__ import annotations

import math

import moderngl

from weather_ecs.frame import RippleData, SplashLook, ViewData
from weather_ecs.gpu.blocks import BlockBuffer, UniformBlock
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.impact_source import ImpactReader
from weather_ecs.gpu.rain_pass import SHELTER_UNIT, RainPass
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.gpu.splash_list import SplashList
from weather_ecs.gpu.splash_texture import splash_texture
from weather_ecs.gpu.timer import PrimitiveCounter
from weather_ecs.physics.splash import RESPONSE, acceleration

MAX_WATERS = 8
FRAMES_UNIT = 2
# Drops of one container that are looked at on the feedback backend: all of them, hit or not.
MOST_DROPS = 65_536

SPLASH = UniformBlock(
    "Splash",
    ("splash_look", "vec4"),  # size, largest radius in m, duration in s, opacity
    ("splash_spray", "vec4"),  # share, droplets, their share of the speed, spread in rad
    ("splash_pull", "vec4"),  # m/s2, of the droplets; m, distance of detail
    ("splash_grain", "vec4"),  # m, diameter of a droplet as it is drawn; 1/s, pull of the air
    ("water_axis", "vec4", MAX_WATERS),  # centre x, centre z, cos heading, sin heading
    ("water_shape", "vec4", MAX_WATERS),  # half-sizes u and w, level, m; 1 for an ellipse
    ("water_count", "int"),
)
DRAW = ProgramKey(vertex="splash.vert", geometry="splash.geom", fragment="splash.frag")
SMALL = ProgramKey(
    vertex="splash.vert",
    geometry="splash.geom",
    fragment="splash.frag",
    defines=("IMPACT_LIST", "SMALL"),
)
COUNT = ProgramKey(vertex="splash.vert", geometry="splash_count.geom")
# Splashes are counted in one draw out of so many: it takes a pass of its own.
COUNT_EVERY = 8


class SplashPass:
    """Draws the splashes of a view's impacts; make it before the rain's first update."""

    def __init__(
        self, ctx: moderngl.Context, gl: GL, shaders: ShaderLoader, rain: RainPass
    ) -> None:
        self._ctx = ctx
        self._texture = splash_texture(ctx)
        self._block = BlockBuffer(ctx, SPLASH)
        self._rain = rain
        self._splashes = ImpactReader(ctx, shaders, rain, "splash", DRAW)
        self._splashes.program["splash_frames"] = FRAMES_UNIT
        self._counted = ImpactReader(ctx, shaders, rain, "splash count", COUNT)
        self._counter = PrimitiveCounter(gl)
        self._lists: SplashList | None = None
        if rain.has_lists:
            small = shaders.program(SMALL)
            small["splash_frames"], small["shelter_map"] = FRAMES_UNIT, SHELTER_UNIT
            large, counted = self._splashes.program, self._counted.program
            self._lists = SplashList(ctx, shaders, small, large, counted)
        self._draws = 0

    @property
    def drawn(self) -> int:
        """Splashes of the latest draw that was counted; asked before a frame is drawn."""
        return self._counter.latest or 0

    def draw(self, view: ViewData, look: SplashLook) -> None:
        """Blending, the depth test and a depth mask that is off are the caller's.

        Needs the blocks RainView and Shelter bound, and the heightmap at its unit.
        """
        fill_splash(self._block, view, look)
        self._block.upload()
        self._block.bind()
        self._texture.use(FRAMES_UNIT)
        impacts = self._rain.impacts(view.key)
        if self._lists is None:
            self._splashes.run(view, _points)
        elif impacts is not None:
            self._lists.find(view.key, impacts)
            # Those far off first.
            self._lists.draw(view.key, 0, large=False)
            self._lists.draw(view.key, 1, large=True)
        if self._draws % COUNT_EVERY == 0:
            self._ctx.enable(moderngl.RASTERIZER_DISCARD)
            with self._counter:
                if self._lists is None:
                    self._counted.run(view, _points)
                elif impacts is not None:
                    self._lists.draw(view.key, 2, large=False)
                    self._lists.draw(view.key, 2, large=True)
            self._ctx.disable(moderngl.RASTERIZER_DISCARD)
        self._draws += 1

    def forget(self, key: int) -> None:
        """Give back what belongs to an observer who is gone."""
        if self._lists is not None:
            self._lists.forget(key)

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        things = (self._counter, self._counted, self._splashes, self._block, self._texture)
        for thing in (self._lists, *things):
            if thing is not None:
                thing.release()


def fill_splash(block: BlockBuffer, view: ViewData, look: SplashLook) -> None:
    """Write the looks of the splashes, what carries their droplets, and where there is water."""
    waters = nearest_waters(view)
    if block.holds == (look, view.frame.wind, waters):
        return
    block.holds = look, view.frame.wind, waters
    data = block.data
    data["splash_look"] = (look.size, look.largest, look.duration, look.opacity)
    data["splash_spray"] = (look.share, look.droplets, look.droplet_speed, look.spread)
    detail = max(look.detail, 1e-3)
    data["splash_pull"] = (*acceleration(view.frame.wind, look.drift), detail)
    data["splash_grain"] = (look.droplet_size * 1e-3, look.drift / RESPONSE, 0.0, 0.0)
    for k, water in enumerate(waters):
        x, y, z = water.center
        u, w = water.size
        data["water_axis"][k] = (x, z, math.cos(water.heading), math.sin(water.heading))
        data["water_shape"][k] = (0.5 * u, 0.5 * w, y, water.ellipse)
    data["water_count"] = len(waters)


def nearest_waters(view: ViewData) -> tuple[RippleData, ...]:
    """The waters that splashes can tell from ground: MAX_WATERS of them."""
    waters = view.frame.ripples
    if len(waters) <= MAX_WATERS:
        return waters

    def away(water: RippleData) -> float:
        return math.dist(water.center, view.position) - 0.5 * max(water.size)

    return tuple(sorted(waters, key=away)[:MAX_WATERS])


def _points(array: moderngl.VertexArray, count: int) -> None:
    array.render(moderngl.POINTS, vertices=min(count, MOST_DROPS))
