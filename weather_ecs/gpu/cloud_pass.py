"""The clouds of a view: billboards for near ones, impostors for far ones, from back to front."""

from __future__ import annotations

from collections.abc import Callable

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import ViewData
from weather_ecs.gpu.cloud_groups import Group, find_groups
from weather_ecs.gpu.cloud_hidden import Window
from weather_ecs.gpu.cloud_impostors import Impostors, Plan
from weather_ecs.gpu.cloud_items import INSIDE, items_of, meeting, picture_kinds
from weather_ecs.gpu.cloud_kit import CloudSettings, make_kit
from weather_ecs.gpu.cloud_order import CloudOrder
from weather_ecs.gpu.cloud_programs import UNITS, camera_matrix
from weather_ecs.gpu.cloud_scene import (
    CloudScene,
    haze_of,
    left_by_haze,
    light_numbers,
    rows_of,
    scene_of,
    surround_of,
)
from weather_ecs.gpu.cloud_seen import Seen, SeenClouds, pictures_seen, together
from weather_ecs.gpu.cloud_sequence import BILLBOARDS, SOFT, Between, Items
from weather_ecs.gpu.cloud_shadow_pass import CloudShadowPass
from weather_ecs.gpu.cloud_store import CloudStore
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.shader_loader import ShaderLoader

STILL = 1.0 / 60.0  # s, that a draw counts for at least: a paused sky still takes over its light


class CloudPass:
    """`update` takes pictures of clouds into atlases; `draw` draws into what the host has bound."""

    def __init__(self, ctx: moderngl.Context, gl: GL, shaders: ShaderLoader) -> None:
        self._ctx, self._shaders = ctx, shaders
        self._store: CloudStore | None = None  # made with the first clouds
        self._observers: dict[int, Impostors] = {}
        self._orders: dict[int, CloudOrder] = {}
        self._groups: list[Group] = []
        self._sight = SeenClouds()
        self._window = Window(gl)
        self.stats = {"clouds_drawn": 0, "impostors_refreshed": 0, "cloud_billboards": 0}
        self.shadows = CloudShadowPass(ctx, shaders, UNITS)
        self.impostors_on = True  # False: billboards alone; for tests and comparisons
        self.canvases_on = True  # False: near ones straight into the picture; for the same

    def _make(self) -> CloudStore:
        """What fails is tried again at the next draw."""
        kit = make_kit(self._ctx, self._shaders)
        store, self._programs, self._stream, self._rows, self._quads, self._rays = kit[:6]
        self._inside, self._canvases = kit.inside, kit.canvases
        self._kit, self._store = kit, store
        return store

    @property
    def store(self) -> CloudStore | None:
        """The shapes; None before there were clouds."""
        return self._store

    def impostors(self, observer: int = 0) -> Impostors | None:
        """An observer's; for tests."""
        return self._observers.get(observer)

    def draws(self, view: ViewData) -> bool:
        """Whether there is anything to do; where the sky has emptied, the shapes go."""
        if len(view.frame.clouds):
            return True
        self.shadows.clear(view.key)
        if self._store is not None and not view.frame.cloud_shapes:
            self._store.update((), 0.0)
        return False

    def sky_low(self, view: ViewData) -> float:
        """Height in the picture, -1 to 1, below which rain hides the sky; -1: nowhere."""
        return self._window.sky_low(view)

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
        self._window.find(view, scene)
        if self._window.low >= 1.0:
            scene.hide()
        impostors = self._impostors(view.key, settings)
        impostors.follow(scene, light_numbers(view, light), dt)
        plan = self._plan(scene, impostors, settings)
        self._haze = haze_of(view, light, scene.center)
        self._arrange(view.key, scene, plan, dt)
        taken = np.array([index for index, _ in plan.take], np.intp)
        self._seen = self._sight.measure(view, scene, store, self._real)
        self._fill(scene, store, taken)
        self._is_inside = self._inside.update(view, scene, store, light)
        self._programs.light(view, light)
        self._use_textures(store, impostors)
        refreshed = self._take(scene, store, impostors, plan)
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
        versions = np.array([shape.versions for shape in store.shapes], np.int64)
        return impostors.plan(
            scene, np.stack([store.keys, versions], axis=1)[scene.shapes],
            store.counts[scene.shapes],
            settings.cloud_billboards, settings.cloud_impostors, settings.cloud_tile,
        )  # fmt: skip

    def _arrange(self, observer: int, scene: CloudScene, plan: Plan, dt: float) -> None:
        """What is drawn in which order: clouds, shares of their opacity, and rows of billboards."""
        order = self._orders.setdefault(observer, CloudOrder())
        drawn, shares = order.update(scene, dt)
        is_real = np.zeros(len(scene.clouds), bool)
        is_real[plan.real] = True
        self._drawn, self._by_billboards = drawn, is_real[drawn]
        self._shares = shares * left_by_haze(self._haze[drawn, 3])
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

    def _take(self, scene: CloudScene, store: CloudStore, impostors: Impostors, plan: Plan) -> int:
        programs = self._programs
        programs.haze(0.0)
        self._ctx.enable_only(moderngl.BLEND)
        self._ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        refreshed = 0
        for row, (index, _) in enumerate(plan.take, len(self._real)):
            shape = store.shapes[int(scene.shapes[index])]
            placed = impostors.place(scene, shape, index, plan.largest)
            if placed is None:
                plan.lost += 1
                continue
            tile, matrix = placed
            impostors.atlas.begin(tile)
            programs.aim(matrix.T.tobytes(), BILLBOARDS)
            programs.run(BILLBOARDS, int(self._begins[row]), int(self._begins[row + 1]))
            refreshed += 1
        programs.haze(1.0)
        return refreshed

    def paint(
        self,
        view: ViewData,
        depth: Callable[[], moderngl.Texture],
        viewport: tuple[int, int, int, int],
        parted: float = 0.0,
    ) -> None:
        """Before `draw`: paint near clouds on canvases. Changes what `update` changes.

        depth: copies the scene's; parted: m, where something stands among the clouds.
        """
        assert self._store is not None
        self._programs.bind()
        self._use_textures(self._store, self._observers[view.key])
        meets = meeting(view, self._scene, self._real)
        (items, seen), self._groups = self._find_items(view, meets), []
        self._matrix = camera_matrix(view)
        self._programs.aim(self._matrix)
        look = view.frame.cloud_look
        if self.canvases_on and not (look.plain or look.rays):
            tiles = self._observers[view.key].kept["tile"][self._drawn, 2]
            self._groups = find_groups(
                view, self._scene, self._store, self._drawn, items, tiles, seen, parted
            )
        for group in self._groups:
            kinds = items.kinds[group.first : group.last]
            kinds[kinds == BILLBOARDS] = SOFT
        if self._groups or meets.any():
            depth().use(UNITS["scene_depth"])
        if self._groups:
            self._canvases.paint(
                self._groups, items, self._programs, viewport[2:], self._window.low
            )
        self._programs.meet(*viewport[:2])
        self._items, self._window.viewport = items, viewport

    def draw(self, view: ViewData, between: Between | None = None) -> None:
        """Draw the visible clouds; blending, depth test and no depth writes are the caller's."""
        items = self._items
        self._ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        self._window.on()
        if between is None:
            self._sequence(items, True)
        else:
            before, after = items.parted(self._middles(between.distance))
            self._sequence(before, True)
            self._window.off()
            between.draw()
            self._window.on()
            self._ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
            self._sequence(after, False)
        if view.frame.cloud_look.rays:
            self._rays.draw(self._scene, self._store, self._real, self._matrix, self._rows)
        self._window.off()
        if self._is_inside:
            self._inside.draw(view.projection)
        self._ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA

    def _sequence(self, items: Items, beyond: bool) -> None:
        """Draw items, and the canvases that are beyond what stands among the clouds, or not."""
        first = 0
        for number, group in enumerate(self._groups):
            self._programs.draw(items.part(first, group.first))
            if group.beyond is beyond:
                self._canvases.show(number, group)
            first = group.last
        self._programs.draw(items.part(first, len(items.kinds)))

    def _middles(self, distance: float) -> NDArray[np.intp]:
        """Where in each item what is farther off than that ends, m."""
        scene, items, bills = self._scene, self._items, self._by_billboards
        middles = items.begins.copy()
        middles[bills] += self._stream.beyond(scene, self._real, distance)
        which = self._drawn[~bills]
        beyond = scene.away[which] - INSIDE * scene.reach[which] > distance
        middles[~bills] += beyond & (items.ends > items.begins)[~bills]
        return np.minimum(middles, items.ends)

    def _find_items(self, view: ViewData, meets: NDArray[np.bool_]) -> tuple[Items, Seen]:
        """All that is drawn, back to front, and how much it shows; writes the pictures' rows."""
        scene, impostors = self._scene, self._observers[view.key]
        bills, begins = self._by_billboards, self._begins[: len(self._real) + 1]
        stretches = begins[:-1], np.where(self._seen.area > 0.0, begins[1:], begins[:-1])
        pictures = ~bills & (impostors.kept["tile"][self._drawn, 2] > 0)
        which = self._drawn[pictures]
        quads = impostors.quads(scene, which, self._haze[which])
        quads[:, 0, 3] *= self._shares[pictures]
        self._quads.write(quads)
        self._quads.texture.use(UNITS["cloud_quads"])
        kinds = picture_kinds(view, scene, which, quads)
        items = items_of(bills, np.where(meets, SOFT, BILLBOARDS), stretches, pictures, kinds)
        seen = together((bills, self._seen), (pictures, pictures_seen(view, scene, quads)))
        items.ends[seen.area <= 0.0] = items.begins[seen.area <= 0.0]
        return items, seen

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
