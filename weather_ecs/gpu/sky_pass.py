"""The sky behind the scene: its light, sun, moon, stars and halo; a rainbow before the clouds."""

from __future__ import annotations

import math

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import AtmosphereData, ViewData
from weather_ecs.gpu.blocks import BlockBuffer, UniformBlock
from weather_ecs.gpu.flash import HAZE, flash_of
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.gpu.sky_floor import SkyFloor
from weather_ecs.gpu.sky_ring import SkyRings, sun_light
from weather_ecs.gpu.weather_sky import WeatherSky
from weather_ecs.physics.optics import CLEAR
from weather_ecs.physics.stars import stars
from weather_ecs.physics.vectors import cross

SKY_VIEW = UniformBlock(
    "SkyView",
    ("sky_turn", "mat4"),  # projection after the camera's turn
    ("sky_frustum", "vec4"),  # 1 / the projection's diagonal, and its off-centre shares
    ("sky_right", "vec4"),  # the camera's axes in the world
    ("sky_up", "vec4"),
    ("sky_back", "vec4"),
    ("sky_fog", "vec4"),  # rgb; m of it overhead
    ("sky_law", "vec4"),  # its extinction, 1/m, 0 where another pass draws it; scale of points;
    # where the horizon is, in clip space; optical depth of the air straight down
    ("sky_flash", "vec4"),  # rgb: what deep air shows of lightning; optical depth of that overhead
    ("sky_floor", "vec4"),  # rgb: of clouds below; share of them
)
GRID = ProgramKey(vertex="sky.vert", fragment="sky.frag")
SUN = ProgramKey(vertex="sky_disc.vert", fragment="sky_disc.frag")
MOON = ProgramKey(vertex="sky_disc.vert", fragment="sky_disc.frag", defines=("MOON",))
STARS = ProgramKey(vertex="sky_stars.vert", fragment="sky_stars.frag")
COLUMNS, ROWS = 30, 28  # cells of the grid; each costs as much as 100 pixels
SUN_RADIUS, MOON_RADIUS = math.radians(0.2666), math.radians(0.259)
GLARE = 20.0  # radii of the sun
MAP_UNIT = 0
AIR = 0.12  # optical depth overhead of the air that a flash lights, haze and all


class SkyPass:
    """Draws an atmosphere's sky where nothing has been drawn."""

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader, sky: WeatherSky) -> None:
        self._ctx, self._sky = ctx, sky
        self._block = BlockBuffer(ctx, SKY_VIEW)
        self._grid, self._stars = shaders.program(GRID), shaders.program(STARS)
        self._sun, self._moon = shaders.program(SUN), shaders.program(MOON)
        corners, cells = _grid()
        self._corners, self._cells = ctx.buffer(corners), ctx.buffer(cells)
        content = [(self._corners, "2f4", "in_place")]
        self._grid_array = ctx.vertex_array(self._grid, content, self._cells)
        self._sun_array = ctx.vertex_array(self._sun, [])
        self._moon_array = ctx.vertex_array(self._moon, [])
        self._star_rows = ctx.buffer(_star_rows())
        self._star_array = ctx.vertex_array(
            self._stars, [(self._star_rows, "4f4 3f4", "in_star", "in_tint")]
        )
        self._rings, self._floor = SkyRings(ctx, shaders), SkyFloor()
        self._bow: NDArray | None = None

    def draws(self, view: ViewData) -> bool:
        """Whether there is a sky to draw; a picture without perspective has no directions."""
        air = view.frame.atmosphere
        return air is not None and air.draw and bool(view.projection[3, 2])

    def draw(self, view: ViewData, height: int) -> None:
        """Into a framebuffer with a depth, `height` pixels high. Leaves alpha blending on."""
        air = view.frame.atmosphere
        assert air is not None
        ctx = self._ctx
        self._fill(view, height)
        self._bow = self._rings.rain(view, air)
        ctx.enable_only(moderngl.DEPTH_TEST)
        self._sky.use(self._grid, MAP_UNIT)
        self._grid_array.render(moderngl.TRIANGLES)
        if air.faintest > -1.5 and air.stars > 0.0:
            self._draw_stars(air, view.frame.time)
        ctx.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST)
        ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
        self._draw_disc(air, sun=True)
        self._draw_disc(air, sun=False)
        if air.halo > 0.0:
            ctx.blend_func = moderngl.ONE, moderngl.ONE
            self._rings.draw_halo(air, sun_light(air))
            ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA

    @property
    def has_bow(self) -> bool:
        """Whether the last `draw` has found rain for a rainbow."""
        return self._bow is not None

    def draw_bow(self, view: ViewData) -> None:
        """The rainbow, in front of clouds and rain. Depth test and blending are the caller's."""
        air, ctx = view.frame.atmosphere, self._ctx
        if air is None or self._bow is None:
            return
        self._block.bind()
        ctx.blend_func = moderngl.ONE, moderngl.ONE
        self._rings.draw_bow(air, sun_light(air), self._bow)
        ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA

    def _draw_stars(self, air: AtmosphereData, time: float) -> None:
        ctx = self._ctx
        ctx.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST | moderngl.PROGRAM_POINT_SIZE)
        ctx.blend_func = moderngl.ONE, moderngl.ONE
        program = self._stars
        program["star_axes"] = tuple(air.star_axes.T.ravel())
        program["star_law"] = (air.faintest, air.stars, time % 3600.0)
        self._star_array.render(moderngl.POINTS)

    def _draw_disc(self, air: AtmosphereData, *, sun: bool) -> None:
        program = self._sun if sun else self._moon
        array = self._sun_array if sun else self._moon_array
        direction = air.sun_direction if sun else air.moon_direction
        if direction[1] < -0.3:
            return
        self._sky.use(program, MAP_UNIT)
        right, up = _north_up(np.array(direction), air.star_axes)
        wide = math.tan((SUN_RADIUS if sun else MOON_RADIUS) * air.disc)
        values: dict[str, tuple[float, ...]] = {
            "disc_direction": direction,
            "disc_right": tuple(right),
            "disc_up": tuple(up),
            "disc_size": (wide, GLARE / air.disc**0.5 if sun else 1.0 + 0.004 / wide),
            "disc_light": tuple(air.sun_disc if sun else air.moon_disc),
            "disc_sun": air.sun_direction,
        }
        for name, value in values.items():
            if name in program:
                program[name] = value
        array.render(moderngl.TRIANGLE_STRIP, vertices=4)

    def _fill(self, view: ViewData, height: int) -> None:
        p, turn, fog = view.projection, view.view[:3, :3], view.frame.fog
        whole = np.eye(4)
        whole[:3, :3] = turn
        block, data = self._block, self._block.data
        block["sky_turn"] = p @ whole
        data["sky_frustum"] = (1.0 / p[0, 0], 1.0 / p[1, 1], p[0, 2], p[1, 2])
        for name, row in zip(("sky_right", "sky_up", "sky_back"), turn, strict=True):
            data[name] = (*row, 0.0)
        flash = flash_of(view.frame, view.position)
        lit = np.zeros(3) if flash is None else HAZE * flash.here
        data["sky_flash"] = (*lit, AIR)
        data["sky_fog"] = (*(lit + fog.color), fog.depth)
        thick = 0.0 if fog.draw else max(fog.extinction - CLEAR, 0.0)
        # Where the horizon is in the picture's middle, in clip space.
        up, back = float(turn[1, 1]), float(turn[2, 1])
        horizon = p[1, 1] * back / max(abs(up), 1e-6) - p[1, 2]
        level = min(max(float(horizon), -1.0), 1.0)
        floor = self._floor.of(view)
        data["sky_law"] = (thick, max(height / 720.0, 0.6), level, floor.depth)
        data["sky_floor"] = (*floor.color, floor.share)
        block.upload()
        block.bind()

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self._rings.release()
        for array in (self._grid_array, self._sun_array, self._moon_array, self._star_array):
            array.release()
        for buffer in (self._corners, self._cells, self._star_rows):
            buffer.release()
        self._block.release()


def _north_up(direction: NDArray, axes: NDArray) -> tuple[NDArray, NDArray]:
    """(right, up) of somebody who looks along a direction with the celestial pole upwards."""
    right = cross(direction, axes[:, 2])
    long = float(np.linalg.norm(right))
    right = right / long if long > 1e-6 else np.array([1.0, 0.0, 0.0])
    return right, cross(right, direction)


def _grid() -> tuple[bytes, bytes]:
    """Corners over the picture, 0 to 1, and two triangles a cell."""
    y, x = np.meshgrid(np.arange(ROWS + 1), np.arange(COLUMNS + 1), indexing="ij")
    corners = np.stack([x / COLUMNS, y / ROWS], -1)
    i, j = np.meshgrid(np.arange(ROWS), np.arange(COLUMNS), indexing="ij")
    first = i * (COLUMNS + 1) + j
    above = first + COLUMNS + 1
    cells = np.stack([first, first + 1, above, above, first + 1, above + 1], -1)
    return corners.astype("f4").tobytes(), cells.astype("i4").tobytes()


def _star_rows() -> bytes:
    them = stars()
    rows = np.concatenate([them.directions, them.magnitudes[:, None], them.colors], axis=1)
    return rows.astype("f4").tobytes()
