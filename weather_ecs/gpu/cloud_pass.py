"""The clouds of a view: billboards for near ones, impostors for far ones, from back to front."""

from __future__ import annotations

from collections.abc import Callable
from itertools import groupby
from typing import NamedTuple, Protocol

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import ViewData
from weather_ecs.gpu.cloud_impostors import Impostors, Plan
from weather_ecs.gpu.cloud_kit import make_kit
from weather_ecs.gpu.cloud_order import CloudOrder
from weather_ecs.gpu.cloud_programs import (
    BILLBOARDS,
    QUADS,
    SOFT,
    UNITS,
    camera_matrix,
)
from weather_ecs.gpu.cloud_scene import CloudScene, haze_of, rows_of, scene_of, surround_of
from weather_ecs.gpu.cloud_shadow_pass import CloudShadowPass
from weather_ecs.gpu.cloud_store import CloudStore
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.physics.cloud_light import Surround

SOFT_HEIGHT = 400.0  # m over the ground, below which billboards are soft where they meet the scene
INSIDE = 0.5  # of a cloud's reach: what is nearer to its middle is behind its picture
SOFT_REACH = 1500.0  # m, as far as they are
STILL = 1.0 / 60.0  # s, that a draw counts for at least: a paused sky still takes over its light


class CloudSettings(Protocol):
    """What the clouds need of the quality settings."""

    @property
    def cloud_billboards(self) -> int: ...
    @property
    def cloud_impostors(self) -> int: ...
    @property
    def cloud_tile(self) -> int: ...
    @property
    def cloud_atlas(self) -> int: ...


class Between(NamedTuple):
    """Something that is drawn among the clouds, at its distance from the camera in m."""

    distance: float
    draw: Callable[[], None]


class CloudPass:
    """`update` takes pictures of clouds into atlases; `draw` draws into what the host has bound."""

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader) -> None:
        self._ctx, self._shaders = ctx, shaders
        self._store: CloudStore | None = None  # made with the first clouds
        self._observers: dict[int, Impostors] = {}
        self._orders: dict[int, CloudOrder] = {}
        self.stats = {"clouds_drawn": 0, "impostors_refreshed": 0, "cloud_billboards": 0}
        self.shadows = CloudShadowPass(ctx, shaders, UNITS)
        self.impostors_on = True  # False: billboards alone; for tests and comparisons

    def _make(self) -> CloudStore:
        """What fails is tried again at the next draw."""
        kit = make_kit(self._ctx, self._shaders)
        store, self._programs, self._stream, self._rows, self._quads, self._rays, self._inside = kit
        self._kit, self._store = kit, store
        return store

    @property
    def store(self) -> CloudStore | None:
        """The shapes; None before there were clouds."""
        return self._store

    def impostors(self, observer: int = 0) -> Impostors | None:
        """An observer's impostors; for tests and statistics."""
        return self._observers.get(observer)

    def draws(self, view: ViewData) -> bool:
        """Whether there is anything to do; where the sky has emptied, the shapes go."""
        if len(view.frame.clouds):
            return True
        self.shadows.clear(view.key)
        if self._store is not None and not view.frame.cloud_shapes:
            self._store.update((), 0.0)
        return False

    def update(self, view: ViewData, settings: CloudSettings, height: int) -> None:
        """Bring the shapes up to date and take the pictures that this draw may take.

        height: of the picture, pixels. Changes framebuffer, viewport and capabilities: the caller
        restores them. Blending is left on and for premultiplied colours.
        """
        store = self._store or self._make()
        dt = max(view.dt, STILL)
        store.update(view.frame.cloud_shapes, dt)
        scene = self._scene = scene_of(view, store, height)
        light = surround_of(view)
        self.shadows.update(view, scene, store, self._programs.images)
        impostors = self._impostors(view.key, settings)
        impostors.follow(scene, _numbers(view, light), dt)
        plan = self._plan_now = self._plan(scene, impostors, settings)
        self._haze = haze_of(view, light, scene.center)
        self._arrange(view.key, scene, plan, dt)
        taken = np.array([index for index, _ in plan.take], np.intp)
        self._fill(scene, store, taken)
        self._is_inside = self._inside.update(view, scene, store, light)
        self._programs.light(view, light)
        self._use_textures(store, impostors)
        refreshed = self._take(scene, store, impostors, plan, settings.cloud_tile)
        self._stream.forget_unused()
        self.stats = {
            "clouds_drawn": len(scene.order),
            "impostors_refreshed": refreshed,
            "cloud_billboards": int(self._begins[len(self._real)]),
        }

    def _impostors(self, key: int, settings: CloudSettings) -> Impostors:
        known = self._observers.get(key)
        if known is not None and known.atlas.height != settings.cloud_atlas:
            known.release()
            known = None
        if known is None:
            known = self._observers[key] = Impostors(self._ctx, settings.cloud_atlas)
        return known

    def _plan(self, scene: CloudScene, impostors: Impostors, settings: CloudSettings) -> Plan:
        store = self._store
        assert store is not None
        if not self.impostors_on:
            return Plan(np.flatnonzero(scene.visible), [])
        numbers = np.array([(s.data.key, s.versions, len(s.position)) for s in store.shapes])
        numbers = numbers.reshape(-1, 3)[scene.shapes]
        return impostors.plan(
            scene, numbers[:, :2], numbers[:, 2],
            settings.cloud_billboards, settings.cloud_impostors, settings.cloud_tile,
        )  # fmt: skip

    def _arrange(self, observer: int, scene: CloudScene, plan: Plan, dt: float) -> None:
        """What is drawn in which order: clouds, shares of their opacity, and rows of billboards."""
        order = self._orders.setdefault(observer, CloudOrder())
        drawn, shares = order.update(scene, dt)
        is_real = np.zeros(len(scene.clouds), bool)
        is_real[plan.real] = True
        self._drawn, self._shares, self._by_billboards = drawn, shares, is_real[drawn]
        self._real = drawn[self._by_billboards]  # a row each, in the order of drawing

    def _fill(self, scene: CloudScene, store: CloudStore, taken: NDArray[np.intp]) -> None:
        """Stream and rows of what is drawn with billboards, and of what a picture is taken of."""
        bills = np.concatenate([self._real, taken])
        fresh = np.array([s.fresh for s in store.shapes], np.float32)[scene.shapes[bills]]
        fresh[len(self._real) :] = 1.0  # what an impostor shows anew comes in by its own fading
        self._begins = self._stream.fill(scene, store, bills)
        rows = rows_of(scene, bills, fresh, self._haze[bills])
        # Many billboards over each other: of each less than of the whole.
        rows[: len(self._real), 0, 3] *= self._shares[self._by_billboards] ** 2
        self._rows.write(rows)

    def _take(
        self, scene: CloudScene, store: CloudStore, impostors: Impostors, plan: Plan, largest: int
    ) -> int:
        programs = self._programs
        programs.haze(BILLBOARDS, 0.0)
        self._ctx.enable_only(moderngl.BLEND)
        self._ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        refreshed = 0
        for row, (index, _) in enumerate(plan.take, len(self._real)):
            shape = store.shapes[int(scene.shapes[index])]
            placed = impostors.place(scene, shape, index, largest)
            if placed is None:
                plan.lost += 1
                continue
            tile, matrix = placed
            impostors.atlas.begin(tile)
            programs.aim(BILLBOARDS, matrix.T.tobytes())
            self._render(BILLBOARDS, row)
            refreshed += 1
        programs.haze(BILLBOARDS, 1.0)
        return refreshed

    def _render(self, key: ProgramKey, row: int) -> None:
        """Draw the billboards of a row."""
        self._programs.billboards(key, int(self._begins[row]), int(self._begins[row + 1]))

    def meets_scene(self, view: ViewData) -> bool:
        """Whether the last update has left billboards that may meet the scene."""
        scene, real = self._scene, self._real
        near = scene.away[real] - scene.reach[real] < SOFT_REACH
        height = scene.center[real, 1] + scene.base[real] + view.position[1]
        low = height < view.frame.profile.ground + SOFT_HEIGHT * view.frame.cloud_look.softness
        return bool((near & low).any())

    def draw(
        self,
        view: ViewData,
        depth: moderngl.Texture | None,
        origin: tuple[int, int],
        between: Between | None = None,
    ) -> None:
        """Draw the visible clouds. Blending, the depth test and no depth writes are the caller's.

        depth: the scene's, where billboards may meet it; origin: the viewport's, pixels; between:
        something that stands among them.
        """
        programs = self._programs
        programs.set_origin(*origin)
        self._ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        matrix = camera_matrix(view)
        key = BILLBOARDS
        if depth is not None:
            key = SOFT
            depth.use(UNITS["scene_depth"])
            programs.haze(SOFT, 1.0)
        programs.aim(key, matrix)
        programs.aim(QUADS, matrix)
        impostors = self._observers[view.key]
        has = impostors.kept["tile"][self._drawn, 2] > 0
        kinds = self._by_billboards[self._by_billboards | has]
        pictures = has & ~self._by_billboards
        which = self._drawn[pictures]
        if len(which):
            quads = impostors.quads(self._scene, which, self._haze[which])
            quads[:, 0, 3] *= self._shares[pictures]
            self._quads.write(quads)
            self._quads.texture.use(UNITS["cloud_quads"])
        begins, ends = self._begins[: len(self._real)], self._begins[1 : len(self._real) + 1]
        if between is None:
            self._sequence(key, kinds, begins, ends, np.ones(len(which), bool))
        else:
            scene = self._scene
            beyond = scene.away[which] - INSIDE * scene.reach[which] > between.distance
            middles = begins + self._stream.beyond(scene, self._real, between.distance)
            self._sequence(key, kinds, begins, middles, beyond)
            between.draw()
            self._ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
            self._sequence(key, kinds, middles, ends, ~beyond)
        if view.frame.cloud_look.rays:
            self._rays.draw(self._scene, self._store, self._real, matrix, self._rows)
        if self._is_inside:
            self._inside.draw(view.projection)
        self._ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA

    def _sequence(
        self, key: ProgramKey, kinds: NDArray, begins: NDArray, ends: NDArray, shown: NDArray
    ) -> None:
        """Draw in order: of each row a stretch of the stream, and the pictures that are shown."""
        row = quad = 0
        for billboards, group in groupby(kinds.tolist()):
            count = len(list(group))
            if billboards:
                for each in range(row, row + count):
                    self._programs.billboards(key, int(begins[each]), int(ends[each]))
                row += count
            else:
                for some, run in groupby(shown[quad : quad + count].tolist()):
                    length = len(list(run))
                    if some:
                        self._programs.quads(quad, length)
                    quad += length

    def _use_textures(self, store: CloudStore, impostors: Impostors) -> None:
        self._programs.images.use(UNITS["cloud_images"])
        self._stream.texture.use(UNITS["cloud_stream"])
        self._rows.texture.use(UNITS["cloud_rows"])
        store.billboards.texture.use(UNITS["cloud_billboards"])
        store.seeds.texture.use(UNITS["cloud_seeds"])
        impostors.atlas.texture.use(UNITS["cloud_atlas"])

    def forget(self, observer: int) -> None:
        """Give back what belongs to an observer who is gone."""
        self.shadows.forget(observer)
        self._orders.pop(observer, None)
        gone = self._observers.pop(observer, None)
        if gone is not None:
            gone.release()

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self.shadows.release()
        for impostors in self._observers.values():
            impostors.release()
        self._observers.clear()
        if self._store is not None:
            self._kit.release()
            self._store = None


def _numbers(view: ViewData, light: Surround) -> NDArray[np.float64]:
    """What all impostors are lit by; a change of 0.02 in one of them is too much."""
    look = view.frame.cloud_look
    colors = np.concatenate([light.sun, light.above, light.below, light.plain])
    strengths = (look.silver, look.base, look.ambient, float(look.plain))
    return np.concatenate([light.direction, colors, strengths])
