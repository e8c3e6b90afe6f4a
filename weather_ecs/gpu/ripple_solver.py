"""Steps of the ripples of one water surface: craters from the impacts, the scheme, the map."""

from __future__ import annotations

import math

import moderngl

from weather_ecs.frame import RippleData, ViewData
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.impact_source import ImpactReader
from weather_ecs.gpu.rain_pass import RainPass
from weather_ecs.gpu.ripple_blocks import RIPPLE_GRID
from weather_ecs.gpu.ripple_grid import GREATEST_RISE, RippleGrid
from weather_ecs.gpu.ripple_map import RippleMap
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.physics import ripple
from weather_ecs.physics.ripple_place import GridPlace

SOURCE = ProgramKey(
    vertex="ripple_source.vert", geometry="ripple_source.geom", fragment="ripple_source.frag"
)
STEP = ProgramKey(vertex="fullscreen.vert", fragment="ripple_step.frag")
MAP = ProgramKey(vertex="fullscreen.vert", fragment="ripple_slope.frag")
AMPLITUDE_UNIT = 2  # and the next one
MOST_STEPS = 4  # in one draw


class RippleSolver:
    """Make it before the rain's first update.

    The scheme's step is fixed, so that its waves run at the surface's speed: the weather's clock
    is divided into such steps, whatever the frames are. Every impact belongs to the step in which
    it fell; what is shown lies between the last two, one step behind the clock.
    """

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader, rain: RainPass) -> None:
        self._ctx = ctx
        self._reader = ImpactReader(ctx, shaders, rain, "ripple", SOURCE)
        self._block = BlockBuffer(ctx, RIPPLE_GRID)
        step, rises = shaders.program(STEP), shaders.program(MAP)
        step["amplitude"], step["amplitude_before"] = AMPLITUDE_UNIT, AMPLITUDE_UNIT + 1
        rises["amplitude"] = AMPLITUDE_UNIT
        self._step_array = ctx.vertex_array(step, [])
        self._map_array = ctx.vertex_array(rises, [])

    def advance(
        self, view: ViewData, grid: RippleGrid, surface: RippleData, place: GridPlace,
        window: tuple[float, float, float, float], rains: bool,
    ) -> RippleMap:  # fmt: skip
        """Do the steps that are due at the view's time; the map shows that time.

        Changes framebuffer, viewport and blending.
        """
        time = view.frame.time
        dt = ripple.time_step(surface.cell, surface.speed)
        due = math.floor(time / dt)
        first = grid.begin(due, time, rains, ripple.settling_steps(surface.damping) * dt)
        first = max(first, due - MOST_STEPS + 1)
        if first <= due:
            self._block.bind()
            self._fill(surface, place, window)
            for k in range(first, due + 1):
                self._step(view, grid, surface, (time - k * dt, time - (k - 1) * dt), rains)
                if k >= due - 1:
                    self._draw_map(grid)
            grid.map.build_mipmaps()
        # Maps a metre, and the slope that the map's range is.
        along, across = (1.0 / (n * surface.cell) for n in grid.cells)
        steepness = GREATEST_RISE * 1e-3 / (2.0 * surface.cell) * surface.amplitude
        scale = (along, across, grid.later_share(time / dt - due), steepness)
        return RippleMap(grid.map, frame_of(surface), scale, window)

    def _fill(
        self, surface: RippleData, place: GridPlace, window: tuple[float, float, float, float]
    ) -> None:
        data = self._block.data
        along, across = place.held
        data["ripple_frame"] = frame_of(surface)
        data["ripple_cells"] = (*place.cells, surface.cell, surface.center[1])
        data["ripple_hold"] = (along, across, surface.ellipse and along and across, 0.0)
        half_u, half_w = 0.5 * surface.size[0], 0.5 * surface.size[1]
        data["ripple_body"] = (half_u, half_w, surface.ellipse, 0.0)
        data["ripple_window"] = window

    def _step(
        self, view: ViewData, grid: RippleGrid, surface: RippleData, ages: tuple[float, float],
        rains: bool,
    ) -> None:  # fmt: skip
        """One step; before it the craters of the impacts of these ages (from, up to; s)."""
        keep = ripple.kept_share(surface.damping)
        self._block.data["ripple_law"] = (keep, ripple.THRESHOLD, *ages)
        self._block.upload()
        if rains:
            self._ctx.enable_only(moderngl.BLEND)
            self._ctx.blend_func = moderngl.ONE, moderngl.ONE
            grid.draw_to_now()
            self._reader.run(view)
            self._ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
        self._ctx.enable_only(moderngl.NOTHING)
        grid.use_amplitudes(AMPLITUDE_UNIT)
        grid.draw_to_following()
        self._step_array.render(moderngl.TRIANGLES, vertices=3)
        grid.turn()

    def _draw_map(self, grid: RippleGrid) -> None:
        grid.use_amplitudes(AMPLITUDE_UNIT)
        grid.draw_to_map()
        self._map_array.render(moderngl.TRIANGLES, vertices=3)

    def forget(self, observer: int) -> None:
        """Give back what belongs to an observer who is gone."""
        self._reader.forget(observer)

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self._map_array.release()
        self._step_array.release()
        self._block.release()
        self._reader.release()


def frame_of(surface: RippleData) -> tuple[float, float, float, float]:
    """Middle (x, z) in m, cosine and sine of the heading."""
    x, _, z = surface.center
    return (x, z, math.cos(surface.heading), math.sin(surface.heading))
