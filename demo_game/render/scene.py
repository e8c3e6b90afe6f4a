"""`SceneRenderer`: draws the place and its sky into a framebuffer."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from demo_game.place import Place, paint

from . import geometry, sunlight
from .drips import Drips, PuddleRings
from .environment import Air, Environment
from .flag import Flag
from .frame_block import FrameBlock, as_matrix, unit
from .ground import Ground
from .ground_shadow import GroundShadow
from .meadow import Meadow
from .openings import NOTHING, WHOLE, Frame, Openings
from .programs import release_all, scissor, set_uniforms
from .quality import level
from .shadows import Shadows
from .sky import Sky
from .statics import Actors, Statics
from .trees import Trees
from .water import Halos, LampPools, Water

SHADOW_UNIT, DETAIL_UNIT, MEADOW_UNIT, SKY_UNIT, LEAF_UNIT = range(5)
WATER_UNIT = 6  # and the one after; 5 has the ripples
CLOUD_UNIT = 8
MOVING_SHADOWS = 140.0  # m from the camera


class SceneRenderer:
    """The game's own renderer: one pass, near to far, the sky last, then what is blended."""

    def __init__(self, ctx: moderngl.Context, place: Place, quality: str = "medium") -> None:
        self.ctx, self.place = ctx, place
        self._quality_name, self._quality = quality, level(quality)
        self._block = FrameBlock(ctx)
        self._ground = Ground(ctx, self._block, place)
        self._ground_shadow = GroundShadow(ctx, place, self._ground.map)
        self._statics = Statics(ctx, self._block, place)
        self._actors = Actors(ctx, self._block, place)
        self._trees = Trees(ctx, self._block, place)
        self._meadow = Meadow(ctx, self._block, place)
        self._flag = Flag(ctx, self._block, place)
        self._water = Water(ctx, self._block, place)
        self._drips = Drips(ctx, self._block, place)
        self._rings = PuddleRings(ctx, self._block, place)
        self._pools = LampPools(ctx, self._block, place)
        self._halos = Halos(ctx, self._block, place)
        self._openings = Openings(place)
        table = paint.detail()
        self._detail = ctx.texture((table.shape[1], table.shape[0]), 4, table.tobytes())
        self._detail.build_mipmaps()
        self._detail.filter = (moderngl.LINEAR_MIPMAP_NEAREST, moderngl.LINEAR)
        solid = (self._actors, self._trees, self._meadow, self._flag, self._ground)
        blended = (self._water, self._drips, self._rings)
        self._looks = [look for part in (*solid, *blended) for look in part.looks]
        self._prepared: set[moderngl.Program] = set()
        self._defines: tuple[str, ...] | None = None
        self._casting: list[tuple[NDArray, float]] = []  # what moves and throws its shadow
        self._flashes = False
        self._make_sized()
        self._released = False

    @property
    def quality(self) -> str:
        """Name of the level; assigning another takes effect at the next frame."""
        return self._quality_name

    @quality.setter
    def quality(self, name: str) -> None:
        before, self._quality, self._quality_name = self._quality, level(name), name
        if self._quality != before:
            self._shadows.release()
            self._sky.release()
            self._make_sized()

    def _make_sized(self) -> None:
        self._shadows = Shadows(self.ctx, self._quality.shadow_size)
        q = self._quality
        self._sky = Sky(self.ctx, self._block, q.sky_size, q.sky_rows)

    def draw(
        self,
        framebuffer: moderngl.Framebuffer | None,
        view: Any,
        projection: Any,
        time: float,
        environment: Environment,
    ) -> None:
        """Clear and draw the whole picture; None draws into the framebuffer now bound.

        Matrices are 16 column-major floats or (4, 4) arrays that act on columns; time in s.
        """
        target = self.ctx.detect_framebuffer() if framebuffer is None else framebuffer
        viewport = target.viewport
        v, p = as_matrix(view), as_matrix(projection)
        camera = self._block.camera(v, p)
        frame = self._openings.frame(camera, p @ v)
        planes = geometry.frustum_planes(p @ v)
        outside = geometry.frustum_planes(p @ v, frame)
        sun = unit(environment.sun_direction)
        self.ctx.wireframe = False
        self._statics.soft = sunlight.is_dull(environment)
        lit = self._choose(environment.defines)
        self._actors.pose(time, environment.actor_snow)
        self._update_shadows(sun, camera, environment)
        self._block.fill(time, environment, self._shadows.lookup)
        self._block.upload()
        full = tuple(sunlight.SUN_STRENGTH * c for c in environment.sun_color)
        for program in lit:
            set_uniforms(program, sun_full=full)
        if environment.water is not None:
            for program in lit:
                environment.water.use(program, WATER_UNIT)
        if environment.cloud_shadow is not None:
            for program in lit:
                environment.cloud_shadow.use(program, CLOUD_UNIT)
        self._light_up(lit, environment.air)
        self._sky.paint(camera, environment)
        target.use()
        target.viewport = viewport
        scissor(target, None)
        target.depth_mask = True
        target.clear(0.0, 0.0, 0.0, 1.0, viewport=viewport)
        self._bind_maps()
        self.ctx.enable_only(moderngl.DEPTH_TEST | moderngl.CULL_FACE)
        self.ctx.depth_func, self.ctx.front_face, self.ctx.cull_face = "<=", "ccw", "back"
        self._statics.draw(planes, outside, camera)
        self._actors.draw(planes, camera)
        if frame != NOTHING:
            if frame != WHOLE:  # llvmpipe pays for what is hidden too
                scissor(target, _pixels(frame, viewport))
            self._draw_open(outside, camera, environment)
            if environment.draws_sky:
                self._sky.draw(v, p, sun, float(camera[1]))
            scissor(target, None)
        self._draw_blended(target, v, p, planes, camera, environment)

    def _choose(self, defines: tuple[str, ...]) -> list[moderngl.Program]:
        """The programs of what is lit, as the weather is now."""
        looks = [*self._statics.looks, *self._looks]
        chosen = (*defines, str(self._statics.soft))
        if chosen != self._defines:
            self._defines, self._flashes = chosen, True  # those chosen may still have its block
        for look in looks:
            look.choose(defines)
            if look.program not in self._prepared:
                self._prepared.add(look.program)
                self._prepare(look.program)
        return [look.program for look in looks]

    def _prepare(self, program: moderngl.Program) -> None:
        """Maps and blocks; until the weather's are there, anything of the right kind."""
        units = {"shadow_map": SHADOW_UNIT, "detail_map": DETAIL_UNIT, "leaf_map": LEAF_UNIT}
        for name in ("weather_wet_map", "weather_wet_far", "weather_shadow_map"):
            units[name] = DETAIL_UNIT
        set_uniforms(program, **units)
        for name in ("WeatherWetness", "WeatherCloudShadow", "WeatherAir"):
            self._block.attach(program, name=name)

    def _light_up(self, lit: list[moderngl.Program], air: Air | None) -> None:
        """Let lightning light everything; when it is over, nothing reads the weather's block."""
        for program in (*lit, *self._sky.programs) if air is not None or self._flashes else ():
            if air is not None:
                air.use(program)
            else:
                self._block.attach(program, name="WeatherAir")
        self._flashes = air is not None

    def show(self, name: str, shown: bool) -> None:
        """Show one of the place's still meshes or leave it out."""
        self._statics.show(name, shown)

    def _bind_maps(self) -> None:
        self._shadows.live.use(SHADOW_UNIT)
        self._detail.use(DETAIL_UNIT)
        self._ground.map.use(MEADOW_UNIT)
        self._sky.map.use(SKY_UNIT)

    def _draw_open(self, planes: NDArray, camera: NDArray, environment: Environment) -> None:
        """What grows, and the ground."""
        ctx, quality = self.ctx, self._quality
        ctx.disable(moderngl.CULL_FACE)
        self._meadow.draw(planes, camera, quality)
        self._flag.draw(planes, camera)
        self._trees.leaves.use(LEAF_UNIT)
        self._trees.draw(planes, camera, quality)
        ctx.enable(moderngl.CULL_FACE)
        sun = unit(environment.sun_direction)
        self._ground.draw(planes, camera, environment, sun, self._casting)
        ctx.disable(moderngl.CULL_FACE)

    def _draw_blended(
        self, target: moderngl.Framebuffer, view: NDArray, projection: NDArray, planes: NDArray,
        camera: NDArray, environment: Environment,
    ) -> None:  # fmt: skip
        target.depth_mask = False
        self.ctx.blend_equation = moderngl.FUNC_ADD, moderngl.FUNC_ADD
        self._bind_maps()
        if self._water.seen(planes, camera) < np.inf:
            self._water.draw(environment.ripples)
        self._pools.draw(planes, camera)
        size = target.viewport[2], target.viewport[3]
        self._rings.draw(planes, camera, environment, projection, size)
        self._drips.draw(planes, camera, environment, projection, size)
        self._halos.draw(view)
        target.depth_mask = True
        self.ctx.enable_only(moderngl.NOTHING)

    def _update_shadows(self, sun: NDArray, camera: NDArray, environment: Environment) -> None:
        shadows = self._shadows
        if shadows.needs(sun):
            shadows.draw_still(sun, self._draw_still_shadows)
            self._ground_shadow.update(shadows.live, shadows.lookup)
        contrast = sunlight.contrast(environment)
        self._casting = []
        for center, radius in self._actors.spheres:
            if np.linalg.norm(center - camera) < MOVING_SHADOWS:
                left = sunlight.share(environment, float(center[0]), float(center[2]))
                if contrast * left > sunlight.FAINT:
                    self._casting.append((center, radius))
        shadows.draw_moving(self._casting, self._actors.draw_shadow)

    def _draw_still_shadows(self, matrix: NDArray) -> None:
        self._statics.draw_shadow(matrix)
        self._trees.draw_shadow(matrix)

    def release(self) -> None:
        """Give everything back; a second call does nothing."""
        if self._released:
            return
        self._released = True
        release_all((self._halos, self._rings, self._drips, self._pools, self._water))
        release_all((self._flag, self._meadow))
        release_all((self._trees, self._actors, self._statics))
        release_all((self._ground_shadow, self._ground))
        release_all((self._shadows, self._sky, self._detail, self._block))


def _pixels(frame: Frame, viewport: tuple[int, int, int, int]) -> tuple[int, int, int, int]:
    """(x, y, width, height) of a part of a picture, rounded outwards."""
    x, y, width, height = viewport
    scale = 0.5 * np.array([width, height])
    low = np.floor((np.array(frame[:2]) + 1.0) * scale).astype(int)
    size = np.ceil((np.array(frame[2:]) + 1.0) * scale).astype(int) - low
    return x + int(low[0]), y + int(low[1]), int(size[0]), int(size[1])
