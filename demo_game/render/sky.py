"""The sky: painted into a map a few rows a frame, shown by blending the last two maps.

On a dome, whose corners read the maps; pixel for pixel only round the sun.
"""

from __future__ import annotations

import math

import moderngl
import numpy as np
from numpy.typing import NDArray

from .environment import Environment
from .frame_block import FrameBlock
from .programs import compile_program, release_all, scissor, set_matrix, set_uniforms
from .sky_dome import dome, first_index, glare_frame

SKY_UNIT = 12  # of the weather's map
JUMP = 25.0  # m the camera moves in one map's time that calls for a fresh one at once
CHANGE = 0.12  # likewise for colours and cover
MIRRORED = 16.0  # times as much may change where the map is seen in water alone
HASTE = 3  # times as many rows a frame are painted then


class Sky:
    """Three maps in turn: shown before, shown after, being painted."""

    def __init__(self, ctx: moderngl.Context, block: FrameBlock, size: int, rows: int) -> None:
        self.ctx, self.size, self.rows = ctx, size, rows
        self.maps = [ctx.texture((size, size), 4) for _ in range(3)]
        for texture in self.maps:
            texture.filter = (moderngl.LINEAR, moderngl.LINEAR)
            texture.repeat_x = texture.repeat_y = False
        self._targets = [ctx.framebuffer([texture]) for texture in self.maps]
        self._bake = compile_program(ctx, "sky_bake.vert", "sky_bake.frag")
        self._show = compile_program(ctx, "sky.vert", "sky.frag")
        self._far = compile_program(ctx, "sky_dome.vert", "sky_dome.frag")
        block.attach(self._bake, self._show, self._far)
        block.attach(self._bake, name="WeatherSkyLight")
        set_uniforms(self._bake, weather_sky_map=SKY_UNIT)
        for program in self.programs:
            block.attach(program, name="WeatherAir")
        self._quad = ctx.buffer(np.array([-1, -1, 3, -1, -1, 3], "f4"))
        self._grid = ctx.buffer(_grid())
        shape = [(self._quad, "2f4", "in_position")]
        self._bake_array = ctx.vertex_array(self._bake, shape)
        self._show_array = ctx.vertex_array(self._show, [(self._grid, "2f4", "in_position")])
        self._dome = [ctx.buffer(part.tobytes()) for part in dome()]
        far = [(self._dome[0], "3f4", "in_direction")]
        self._far_array = ctx.vertex_array(self._far, far, self._dome[1])
        self._row = 0
        self._painted: NDArray | None = None  # state of the map now shown
        self._shown = True  # as the sky itself, and not only in water
        self._state: NDArray = np.zeros(0)

    @property
    def programs(self) -> tuple[moderngl.Program, ...]:
        """What show the map."""
        return self._show, self._far

    @property
    def map(self) -> moderngl.Texture:
        """The newest whole map, for reflections."""
        return self.maps[1]

    def paint(self, camera: NDArray, environment: Environment) -> None:
        """Paint this frame's rows, or all of them where the world has jumped."""
        self._state = _state(camera, environment)
        set_uniforms(self._bake, has_sky=float(environment.sky is not None))
        if environment.sky is not None:
            environment.sky.use(self._bake, SKY_UNIT)
        self.ctx.enable_only(moderngl.NOTHING)
        shown = environment.draws_sky
        fresh = shown and not self._shown
        self._shown = shown
        if fresh or _jumped(self._painted, self._state, 1.0 if shown else MIRRORED):
            self._rows(1, 0, self.size)
            if shown:
                self._rows(0, 0, self.size)
            self._row = 0
            self._painted = self._state
            return
        if self._row >= self.size:
            # Not at once: a map is read by the dome's corners, and they would wait for its rows.
            self.maps.append(self.maps.pop(0))
            self._targets.append(self._targets.pop(0))
            self._row = 0
            self._painted = self._state
        rows = self.rows if shown else HASTE * self.rows
        rows = min(rows, self.size - self._row)
        self._rows(2, self._row, rows)
        self._row += rows

    def _rows(self, target: int, first: int, count: int) -> None:
        framebuffer = self._targets[target]
        framebuffer.use()
        scissor(framebuffer, (0, first, self.size, count))
        self._bake_array.render()
        scissor(framebuffer, None)

    def draw(self, view: NDArray, projection: NDArray, sun: NDArray, height: float) -> None:
        """Fill what nothing has covered; depth test on, at the far end.

        sun: unit direction. height: of the eye, m.
        """
        turn = view.copy()
        turn[:3, 3] = 0.0
        to_clip = projection @ turn
        set_matrix(self._far, "to_clip", to_clip)
        self.maps[0].use(0)
        self.maps[1].use(1)
        for program in self.programs:
            set_uniforms(program, share=self._row / self.size, sky_before=0, sky_after=1)
        first = first_index(height)
        self._far_array.render(vertices=self._far_array.vertices - first, first=first)
        near = glare_frame(to_clip, sun)
        if near is not None:
            set_matrix(self._show, "to_world", np.linalg.inv(to_clip))
            set_uniforms(self._show, part=near)
            self._show_array.render()

    def release(self) -> None:
        """Give everything back."""
        release_all((self._far_array, self._show_array, self._bake_array))
        release_all((*self._dome, self._quad, self._grid))
        release_all((*self.programs, self._bake))
        release_all(self._targets)
        release_all(self.maps)


def _grid(columns: int = 24, rows: int = 16) -> NDArray:
    """Two triangles a cell of the picture, in clip space."""
    i, j = np.meshgrid(np.arange(columns), np.arange(rows))
    cell = np.stack([i, j], -1).reshape(-1, 1, 2)
    corner = np.array([[0, 0], [1, 0], [1, 1], [0, 0], [1, 1], [0, 1]])
    return ((cell + corner) * (2.0 / columns, 2.0 / rows) - 1.0).astype("f4")


def _state(camera: NDArray, env: Environment) -> NDArray:
    colors = (*env.sun_color, *env.zenith_color, *env.horizon_color, *env.fog_color)
    rain = [value for a in list(env.rain_areas)[:4] for value in (*a[0], 6.0 * min(a[3], 10.0))]
    rain += [0.0] * (12 - len(rain))
    left = math.exp(-env.fog_overhead)
    scaled = np.array([*colors, env.overcast, left, *env.sun_direction]) / CHANGE
    return np.concatenate([scaled, np.array([*camera, *rain]) / JUMP])


def _jumped(before: NDArray | None, now: NDArray, most: float) -> bool:
    return before is None or bool(np.abs(before - now).max() > most)
