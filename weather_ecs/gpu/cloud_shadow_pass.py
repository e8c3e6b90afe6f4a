"""Clouds' shadows: a map of how much sun comes through, seen along the sun, around each observer.

A map is painted a few clouds at a time and shown when it is whole; until the next one is, it drifts
with the clouds. Nothing is done for observers whose shadows nobody has asked for.
"""

from __future__ import annotations

import math

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import ViewData
from weather_ecs.gpu.cloud_scene import CloudScene, rows_of
from weather_ecs.gpu.cloud_shadow import CloudShadow
from weather_ecs.gpu.cloud_store import CloudStore
from weather_ecs.gpu.cloud_stream import CloudStream
from weather_ecs.gpu.row_texture import RowTexture
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.physics.cloud_billboard import smoothstep

PAINT = ProgramKey(vertex="cloud_shadow.vert", fragment="cloud_shadow.frag")
SIZE = 256  # texels on a side
SIDE = 12_000.0  # m
LOWEST_SUN = 0.12  # sine of its height; below, shadows grow no longer but fainter
BILLBOARDS = 600  # painted in one draw
REST = 0.3  # s, weather time, from one map to the next: clouds go less than a texel meanwhile
TURNED = 0.002  # of the sun's direction, and
WALKED = 0.01  # of a map's side, the camera's way: after more there is no rest


class ShadowMap:
    """One observer's map, the one that is being painted, and what of it is left to paint."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.shown = CloudShadow(ctx)
        self.textures = [ctx.texture((SIZE, SIZE), 1) for _ in range(2)]
        for texture in self.textures:
            texture.repeat_x = texture.repeat_y = False
        self.targets = [ctx.framebuffer([texture]) for texture in self.textures]
        self.back = 0
        self.left: NDArray[np.int64] | None = None  # keys of the clouds still to be painted
        self.middle = np.zeros(3)  # m, of the map being painted
        self.sun = np.array([0.0, 1.0, 0.0])
        self.begun = 0.0  # s, the weather's clock
        self.velocity = np.zeros(2)  # m/s, of the clouds
        # The same of the map that is shown.
        self.front: tuple[NDArray, NDArray, float, NDArray] | None = None

    def release(self) -> None:
        self.shown.release()
        for target in self.targets:
            target.release()
        for texture in self.textures:
            texture.release()


class CloudShadowPass:
    """Keeps the maps that were asked for up to date."""

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader, units: dict[str, int]) -> None:
        self._ctx, self._shaders, self._units = ctx, shaders, units
        self._maps: dict[int, ShadowMap] = {}
        self._program: moderngl.Program | None = None  # made with the first map

    def known(self, observer: int) -> CloudShadow | None:
        """An observer's shadows, if they were asked for before."""
        found = self._maps.get(observer)
        return None if found is None else found.shown

    def map(self, observer: int) -> CloudShadow:
        """An observer's shadows; from now on they are kept up to date."""
        if self._program is None:
            self._program = self._shaders.program(PAINT)
            for name, unit in self._units.items():
                if name in self._program:
                    self._program[name] = unit
            self._array = self._ctx.vertex_array(self._program, [])
            self._stream = CloudStream(self._ctx)
            self._rows = RowTexture(self._ctx, 6)
        if observer not in self._maps:
            self._maps[observer] = ShadowMap(self._ctx)
        return self._maps[observer].shown

    def clear(self, observer: int) -> None:
        """There are no clouds: all is in the sun."""
        found = self._maps.get(observer)
        if found is not None and found.front is not None:
            found.front = found.left = None
            found.shown.set((0.0, 0.0, 1.0), (0.0, 0.0), 0.0, 0.0)

    def update(
        self, view: ViewData, scene: CloudScene, store: CloudStore, images: moderngl.TextureArray
    ) -> None:
        """Paint some more of the observer's map. Changes framebuffer, viewport and capabilities."""
        found = self._maps.get(view.key)
        if found is None or self._program is None:
            return
        if not view.frame.cloud_look.shadows:
            self.clear(view.key)
            return
        if found.left is None and _rests(found, view):
            self._place(found, view)
            return
        if found.left is None:
            self._begin(found, view, scene)
        keys = scene.clouds["key"]
        # As many clouds as the budget allows; at least one.
        assert found.left is not None
        wanted = set(found.left.tolist())
        places = [place for place, key in enumerate(keys.tolist()) if key in wanted]
        left = np.array(places, np.intp)
        counts = store.counts[scene.shapes[left]]
        most = max(int(np.searchsorted(np.cumsum(counts), BILLBOARDS, side="right")), 1)
        if found.front is None:
            most = len(left)  # the first map at once: nobody shall see it come
        now = left[:most]
        if len(now):
            self._paint(found, view, scene, store, now, images)
        found.left = keys[left[most:]]
        if not len(found.left):
            self._show(found)
        self._place(found, view)

    def _begin(self, found: ShadowMap, view: ViewData, scene: CloudScene) -> None:
        """A new map: what is to be in it, where it lies."""
        sun = _sun(view)
        found.sun, found.begun = sun, view.frame.time
        x, y, z = view.position
        ground = view.frame.profile.ground
        found.middle = np.array([x, ground, z])
        reach = 0.5 * SIDE + scene.reach / sun[1]
        clouds = scene.clouds
        wanted = (shadow_places(scene.center + (0.0, y - ground, 0.0), sun) ** 2).sum(
            axis=1
        ) < 2.0 * reach**2
        wanted &= (clouds["growth"] > 0.0) & (clouds["opacity"] > 0.0)
        found.left = clouds["key"][wanted]
        velocity = clouds["velocity"][wanted]
        found.velocity = velocity[:, (0, 2)].mean(0) if len(velocity) else np.zeros(2)
        found.targets[found.back].clear(1.0, 1.0, 1.0, 1.0)

    def _paint(
        self, found: ShadowMap, view: ViewData, scene: CloudScene, store: CloudStore,
        which: NDArray[np.intp], images: moderngl.TextureArray,
    ) -> None:  # fmt: skip
        program, units = self._program, self._units
        assert program is not None
        count = self._stream.fill_unsorted(scene, store, which)
        fresh = np.ones(len(which), np.float32)
        rows = rows_of(scene, which, fresh, np.zeros((len(which), 4), np.float32))
        # The map is of the moment it was begun at.
        past = view.frame.time - found.begun
        shift = np.array(view.position) - found.middle - scene.clouds["velocity"][which] * past
        rows[:, 0, :3] += shift.astype(np.float32)
        self._rows.write(rows)
        self._stream.texture.use(units["cloud_stream"])
        self._rows.texture.use(units["cloud_rows"])
        store.billboards.texture.use(units["cloud_billboards"])
        images.use(units["cloud_images"])
        program["shadow_sun"] = tuple(found.sun.tolist())
        program["shadow_scale"] = 2.0 / SIDE
        self._ctx.enable_only(moderngl.BLEND)
        self._ctx.blend_func = moderngl.ZERO, moderngl.ONE_MINUS_SRC_ALPHA
        found.targets[found.back].use()
        self._array.render(moderngl.TRIANGLE_STRIP, vertices=4, instances=count)

    def _show(self, found: ShadowMap) -> None:
        found.front = (found.middle, found.sun, found.begun, found.velocity)
        found.shown.texture = found.textures[found.back]
        found.back, found.left = 1 - found.back, None

    def _place(self, found: ShadowMap, view: ViewData) -> None:
        if found.front is None:
            return
        middle, sun, begun, velocity = found.front
        drift = velocity * (view.frame.time - begun)
        height = float(view.frame.sky.sun_direction[1])
        strength = float(smoothstep(0.02, LOWEST_SUN, height))
        slope = (float(sun[0] / sun[1]), float(sun[2] / sun[1]))
        x, z = middle[0] + drift[0], middle[2] + drift[1]
        found.shown.set((float(x), float(z), SIDE), slope, float(middle[1]), strength)

    def forget(self, observer: int) -> None:
        """Give back what belongs to an observer who is gone."""
        gone = self._maps.pop(observer, None)
        if gone is not None:
            gone.release()

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for observer in list(self._maps):
            self.forget(observer)
        if self._program is not None:
            self._program = None
            for thing in (self._array, self._stream, self._rows):
                thing.release()


def _rests(found: ShadowMap, view: ViewData) -> bool:
    """Whether the map that is shown is good for a while; while time stands still it is painted on,
    as someone may be at work on the clouds.
    """
    if found.front is None or view.dt <= 0.0:
        return False
    middle, sun, begun, _ = found.front
    turned = np.abs(_sun(view) - sun).max()
    way = math.hypot(view.position[0] - middle[0], view.position[2] - middle[2])
    rests = 0.0 <= view.frame.time - begun < REST
    return bool(rests and turned < TURNED and way < WALKED * SIDE)


def _sun(view: ViewData) -> NDArray[np.float64]:
    """Towards it, not too low."""
    sun = np.array(view.frame.sky.sun_direction, np.float64)
    sun[1] = max(sun[1], LOWEST_SUN)
    return sun


def shadow_places(center: NDArray, sun: NDArray) -> NDArray[np.float64]:
    """(n, 2) x and z where the sun's rays through places (n, 3) meet the plane of height 0."""
    places: NDArray[np.float64] = center[:, (0, 2)] - center[:, 1:2] * sun[[0, 2]] / sun[1]
    return places
