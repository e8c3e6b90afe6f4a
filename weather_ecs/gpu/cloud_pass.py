"""The clouds of a view: billboards for near ones, impostors for far ones, from back to front."""

from __future__ import annotations

from itertools import groupby
from typing import Protocol

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import ViewData
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.cloud_blocks import CLOUD_VIEW
from weather_ecs.gpu.cloud_images import hulls, image_array
from weather_ecs.gpu.cloud_impostors import Impostors, Plan
from weather_ecs.gpu.cloud_inside import CloudInside
from weather_ecs.gpu.cloud_rays import CloudRays
from weather_ecs.gpu.cloud_scene import CloudScene, haze_of, rows_of, scene_of, surround_of
from weather_ecs.gpu.cloud_shadow_pass import CloudShadowPass
from weather_ecs.gpu.cloud_store import CloudStore
from weather_ecs.gpu.cloud_stream import CloudStream
from weather_ecs.gpu.row_texture import RowTexture
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.physics.cloud_images import CLOUD_IMAGES
from weather_ecs.physics.cloud_light import Surround

IMAGES = ("IMAGES", len(CLOUD_IMAGES))
BILLBOARDS = ProgramKey(vertex="cloud.vert", fragment="cloud.frag", defines=(IMAGES,))
SOFT = ProgramKey(vertex="cloud.vert", fragment="cloud.frag", defines=(IMAGES, "SOFT"))
QUADS = ProgramKey(vertex="cloud_quad.vert", fragment="cloud_quad.frag")
# Units of the samplers; the same in all programs.
UNITS = {
    "cloud_images": 0,
    "cloud_stream": 1,
    "cloud_rows": 2,
    "cloud_billboards": 3,
    "cloud_seeds": 4,
    "cloud_atlas": 5,
    "cloud_quads": 6,
    "scene_depth": 7,
}
SOFT_HEIGHT = 400.0  # m over the ground, below which billboards are soft where they meet the scene
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


class CloudPass:
    """`update` takes pictures of clouds into atlases; `draw` draws into what the host has bound."""

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader) -> None:
        self._ctx, self._shaders = ctx, shaders
        self._store: CloudStore | None = None  # made with the first clouds
        self._observers: dict[int, Impostors] = {}
        self.stats = {"clouds_drawn": 0, "impostors_refreshed": 0, "cloud_billboards": 0}
        self.shadows = CloudShadowPass(ctx, shaders, UNITS)
        self.impostors_on = True  # False: billboards alone; for tests and comparisons

    def _make(self) -> CloudStore:
        ctx = self._ctx
        self._store = CloudStore(ctx)
        self._images = image_array(ctx)
        self._stream = CloudStream(ctx)
        self._rows = RowTexture(ctx, 6)
        self._quads = RowTexture(ctx, 8)
        self._block = BlockBuffer(ctx, CLOUD_VIEW)
        self._programs = {key: self._shaders.program(key) for key in (BILLBOARDS, SOFT, QUADS)}
        self._arrays = {key: ctx.vertex_array(p, []) for key, p in self._programs.items()}
        for program in self._programs.values():
            for name, unit in UNITS.items():
                if name in program:
                    program[name] = unit
            if "cloud_hulls" in program:
                program["cloud_hulls"].write(hulls().tobytes())
        self._rays = CloudRays(ctx, self._shaders, UNITS)
        self._inside = CloudInside(ctx, self._shaders)
        return self._store

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
        self.shadows.update(view, scene, store, self._images)
        impostors = self._impostors(view.key, settings)
        impostors.follow(scene, _numbers(view, light), dt)
        plan = self._plan(scene, impostors, settings)
        self._largest = settings.cloud_tile
        haze = haze_of(view, light, scene.center)
        taken = np.array([index for index, _ in plan.take], np.intp)
        bills = np.concatenate([plan.real, taken])
        fresh = np.array([s.fresh for s in store.shapes], np.float32)[scene.shapes[bills]]
        fresh[len(plan.real) :] = 1.0  # what an impostor shows anew comes in by its own fading
        self._begins = self._stream.fill(scene, store, bills)
        self._rows.write(rows_of(scene, bills, fresh, haze[bills]))
        self._plan_now, self._haze = plan, haze
        self._is_inside = self._inside.update(view, scene, store, light)
        self._fill_block(view, light)
        self._use_textures(impostors)
        refreshed = self._take(scene, impostors, plan)
        self._stream.forget_unused()
        self.stats = {
            "clouds_drawn": len(scene.order),
            "impostors_refreshed": refreshed,
            "cloud_billboards": int(self._begins[len(plan.real)]),
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

    def _take(self, scene: CloudScene, impostors: Impostors, plan: Plan) -> int:
        program = self._programs[BILLBOARDS]
        program["cloud_hazed"] = 0.0
        store, first = self._store, len(plan.real)
        assert store is not None
        self._ctx.enable_only(moderngl.BLEND)
        self._ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        refreshed = 0
        for row, (index, _) in enumerate(plan.take, first):
            shape = store.shapes[int(scene.shapes[index])]
            placed = impostors.place(scene, shape, index, self._largest)
            if placed is None:
                plan.lost += 1
                continue
            tile, matrix = placed
            impostors.kept["version"][index] = shape.versions
            impostors.kept["shape"][index] = shape.data.key
            impostors.atlas.begin(tile)
            program["cloud_matrix"].write(matrix.T.tobytes())
            self._render(BILLBOARDS, row, row + 1)
            refreshed += 1
        program["cloud_hazed"] = 1.0
        return refreshed

    def _render(self, key: ProgramKey, first: int, last: int) -> None:
        """Draw the billboards of the rows from `first` to before `last`."""
        begin, end = int(self._begins[first]), int(self._begins[last])
        if end > begin:
            self._programs[key]["cloud_first"] = begin
            self._arrays[key].render(moderngl.TRIANGLE_STRIP, vertices=8, instances=end - begin)

    def meets_scene(self, view: ViewData) -> bool:
        """Whether the last update has left billboards that may meet the scene."""
        scene, real = self._scene, self._plan_now.real
        near = scene.away[real] - scene.reach[real] < SOFT_REACH
        height = scene.center[real, 1] + scene.base[real] + view.position[1]
        low = height < view.frame.profile.ground + SOFT_HEIGHT * view.frame.cloud_look.softness
        return bool((near & low).any())

    def draw(self, view: ViewData, depth: moderngl.Texture | None) -> None:
        """Draw the visible clouds. Blending, the depth test and no depth writes are the caller's.

        depth: the scene's, where billboards may meet it.
        """
        scene, plan = self._scene, self._plan_now
        self._ctx.blend_func = moderngl.ONE, moderngl.ONE_MINUS_SRC_ALPHA
        rotation = np.eye(4)
        rotation[:3, :3] = view.view[:3, :3]
        matrix = (view.projection @ rotation).astype(np.float32).T.tobytes()
        key = BILLBOARDS
        if depth is not None:
            key = SOFT
            depth.use(UNITS["scene_depth"])
            self._programs[SOFT]["cloud_hazed"] = 1.0
        for used in (key, QUADS):
            self._programs[used]["cloud_matrix"].write(matrix)
        rows = np.full(len(scene.clouds), -1)
        rows[plan.real] = np.arange(len(plan.real))
        impostors = self._observers[view.key]
        has = impostors.kept["tile"][:, 2] > 0
        order = scene.order[(rows[scene.order] >= 0) | has[scene.order]]
        pictures = order[rows[order] < 0]
        if len(pictures):
            self._quads.write(impostors.quads(scene, pictures, self._haze[pictures]))
            self._quads.texture.use(UNITS["cloud_quads"])
        done = 0
        for billboards, group in groupby(rows[order].tolist(), key=lambda row: row >= 0):
            run = list(group)
            if billboards:
                for row in run:
                    self._render(key, row, row + 1)
            else:
                self._programs[QUADS]["cloud_first"] = done
                self._arrays[QUADS].render(moderngl.TRIANGLE_STRIP, vertices=4, instances=len(run))
                done += len(run)
        if view.frame.cloud_look.rays:
            self._rays.draw(scene, self._store, plan.real, matrix, self._rows)
        if self._is_inside:
            self._inside.draw(view.projection)
        self._ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA

    def _fill_block(self, view: ViewData, light: Surround) -> None:
        data, look = self._block.data, view.frame.cloud_look
        data["cloud_sun"][:3], data["cloud_sun_color"][:3] = light.direction, light.sun
        data["cloud_above"][:3], data["cloud_below"][:3] = light.above, light.below
        data["cloud_ambient"][:3] = look.ambient * light.plain
        data["cloud_look"] = (look.silver, look.base, look.ambient, float(look.plain))
        data["cloud_depth"][:2] = view.projection[2, 2], view.projection[2, 3]
        self._softness = look.softness
        self._block.upload()
        self._block.bind()

    def set_origin(self, x: int, y: int) -> None:
        """Lower left corner of the viewport that `draw` draws to, pixels."""
        self._block.data["cloud_origin"] = (x, y, max(self._softness, 1e-3), 0.0)
        self._block.upload()
        self._block.bind()

    def _use_textures(self, impostors: Impostors) -> None:
        store = self._store
        assert store is not None
        self._images.use(UNITS["cloud_images"])
        self._stream.texture.use(UNITS["cloud_stream"])
        self._rows.texture.use(UNITS["cloud_rows"])
        store.billboards.texture.use(UNITS["cloud_billboards"])
        store.seeds.texture.use(UNITS["cloud_seeds"])
        impostors.atlas.texture.use(UNITS["cloud_atlas"])

    def forget(self, observer: int) -> None:
        """Give back what belongs to an observer who is gone."""
        self.shadows.forget(observer)
        gone = self._observers.pop(observer, None)
        if gone is not None:
            gone.release()

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self.shadows.release()
        for impostors in self._observers.values():
            impostors.release()
        self._observers.clear()
        if self._store is None:
            return
        self._inside.release()
        self._rays.release()
        for array in self._arrays.values():
            array.release()
        self._block.release()
        for thing in (self._quads, self._rows, self._stream, self._images, self._store):
            thing.release()
        self._store = None


def _numbers(view: ViewData, light: Surround) -> NDArray[np.float64]:
    """What all impostors are lit by; a change of 0.02 in one of them is too much."""
    look = view.frame.cloud_look
    colors = np.concatenate([light.sun, light.above, light.below, light.plain])
    strengths = (look.silver, look.base, look.ambient, float(look.plain))
    return np.concatenate([light.direction, colors, strengths])
