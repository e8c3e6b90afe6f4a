"""`Renderer`: everything that is drawn, in its order, as a guest in the host's framebuffer."""

from __future__ import annotations

from typing import Protocol

import moderngl

from weather_ecs.errors import ContextError, InvalidValueError
from weather_ecs.frame import FrameData, GaugeReading, ViewData
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.cloud_pass import CloudPass, CloudSettings
from weather_ecs.gpu.cloud_shadow import CloudShadow
from weather_ecs.gpu.collision_maps import CollisionMaps
from weather_ecs.gpu.context import is_released, probe
from weather_ecs.gpu.gauge_pass import GaugePass
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.guard import StateGuard
from weather_ecs.gpu.heightmap import Heightmap
from weather_ecs.gpu.impact_count import ImpactCount
from weather_ecs.gpu.keeper import Keeper
from weather_ecs.gpu.layers import Layers, Moved
from weather_ecs.gpu.rain_blocks import RAIN_VIEW
from weather_ecs.gpu.rain_pass import RainPass
from weather_ecs.gpu.ripple_pass import RipplePass
from weather_ecs.gpu.shader_loader import ShaderLoader
from weather_ecs.gpu.splash_pass import SplashPass
from weather_ecs.gpu.timer import GpuTimer
from weather_ecs.gpu.view_block import fill_view
from weather_ecs.gpu.weather_air import WeatherAir
from weather_ecs.gpu.weather_heightmap import WeatherHeightmap
from weather_ecs.gpu.weather_sky import WeatherSky
from weather_ecs.gpu.wetness_map import WetnessMap
from weather_ecs.gpu.wetness_pass import WetnessPass


class Settings(CloudSettings, Protocol):
    """What the renderer needs of the quality settings."""

    @property
    def heightmap_size(self) -> int: ...


class Renderer:
    """Owns every OpenGL object of a weather; `backend` is asked as auto, compute or feedback.

    Raises ContextError where the asked backend is not to be had.
    """

    def __init__(self, ctx: moderngl.Context, *, backend: str = "auto", seed: int = 0) -> None:
        self._ctx = ctx
        capabilities = probe(ctx)
        if backend not in ("auto", "compute", "feedback"):
            raise InvalidValueError("backend", backend, "auto, compute, feedback")
        if backend == "compute" and not capabilities.compute:
            raise ContextError(
                "backend 'compute' needs OpenGL 4.3, this context has "
                f"{capabilities.version // 100}.{capabilities.version // 10 % 10}"
            )
        if backend == "auto":
            backend = "compute" if capabilities.compute else "feedback"
        self.backend: str = backend
        self.stats: dict[str, int | float] = {}
        self._gl = GL()
        self._guard = StateGuard(ctx, self._gl)
        self._kept = Keeper()
        self._airs: dict[int, WeatherAir] = {}
        self._released = False
        try:
            # Making objects binds them; the host must not notice that either.
            with self._guard:
                self._make(seed)
        except BaseException:
            self.release()
            raise

    def _make(self, seed: int) -> None:
        ctx, gl, keep = self._ctx, self._gl, self._kept.keep
        shaders = keep(ShaderLoader(ctx, gl=gl))
        rain = self._rain = keep(RainPass(ctx, shaders, backend=self.backend, seed=seed))
        self._splash = keep(SplashPass(ctx, gl, shaders, rain))
        self._impacts = keep(ImpactCount(ctx, gl, shaders, rain))
        self._ripples = keep(RipplePass(ctx, shaders, rain))
        self._gauges = keep(GaugePass(ctx, shaders, rain))
        self._wetness = keep(WetnessPass(ctx, gl, shaders))
        self._clouds = keep(CloudPass(ctx, gl, shaders))
        self._maps = keep(CollisionMaps(ctx, self._guard, shaders))
        moved = Moved(rain, self._splash, self._ripples, self._clouds, self._maps)
        self._layers = Layers(ctx, gl, self._guard, shaders, moved, self._kept)
        self._view_block = keep(BlockBuffer(ctx, RAIN_VIEW))
        # What the last `prepare` was for, with its viewport, and whether anything shelters there.
        self._prepared: tuple[ViewData, tuple[int, int, int, int], bool] | None = None
        self._timer = keep(GpuTimer(gl))
        self._prepare_timer = keep(GpuTimer(gl))

    @property
    def rain(self) -> RainPass:
        """The drops; for tests and benchmarks."""
        return self._rain

    @property
    def clouds(self) -> CloudPass:
        """The clouds; for tests and benchmarks."""
        return self._clouds

    @property
    def ripples(self) -> RipplePass:
        """The rings on water."""
        return self._ripples

    def wetness(self, key: int = 0) -> WetnessMap:
        """The water around an observer, for a game's own shaders."""
        known = self._wetness.known(key)
        if known is not None:
            return known
        with self._guard:
            return self._wetness.map(key)

    def weather_heightmap(self, key: int = 0) -> WeatherHeightmap:
        """What rain meets around an observer, for a game's own shaders."""
        known = self._maps.opened(key)
        if known is not None:
            return known
        with self._guard:
            return self._maps.open(key)

    def air(
        self, key: int, frame: FrameData, y: float, rate: float, place: tuple[float, float]
    ) -> WeatherAir:
        """The air round an observer at the height y, where it rains or snows at a rate (mm/h).

        place: (x, z), m.
        """
        air = self._airs.get(key)
        if air is None or air.stale(frame, y, rate, place):
            with self._guard.for_buffers():
                if air is None:
                    air = self._airs[key] = WeatherAir(self._ctx)
                air.fill(frame, y, rate, place)
        return air

    def cloud_shadow(self, key: int = 0) -> CloudShadow:
        """The clouds' shadows around an observer, for a game's own shaders."""
        known = self._clouds.shadows.known(key)
        if known is not None:
            return known
        with self._guard:
            return self._clouds.shadows.map(key)

    def sky(self, frame: FrameData) -> WeatherSky:
        """The sky's radiance in a frame, for a game's own shaders."""
        if self._layers.light_is_made(frame):
            return self._layers.light(frame)
        with self._guard:
            return self._layers.light(frame)

    def take_readings(self) -> list[GaugeReading]:
        """What the rain gauges have counted, as far as it has come back since the last call."""
        return self._gauges.take()

    def heightmap(self, key: int = 0) -> Heightmap | None:
        """The collision heightmap of an observer, if there is one yet."""
        return self._maps.of(key)

    def prepare(self, view: ViewData, settings: Settings) -> None:
        """What a view needs besides the host's picture: maps brought up to date, drops moved.

        Raises ContextError where the context is not current or the renderer was released.
        """
        if self._released:
            raise ContextError("the renderer was released")
        self.stats = {"containers": len(view.containers)}
        self._prepared = None
        if not self._draws(view):
            return
        with self._guard as guard:
            if guard.viewport[2] > 0 and guard.viewport[3] > 0:
                self._prepare(view, settings, guard.viewport)

    def draw(self, view: ViewData, settings: Settings) -> None:
        """Draws the view into what the host has bound; prepares it where that was not done.

        Raises ContextError where the context is not current or the renderer was released.
        """
        if self._released:
            raise ContextError("the renderer was released")
        if self._prepared is None or self._prepared[0] is not view:
            self._prepared = None
            self.stats = {"containers": len(view.containers)}
        if not self._draws(view):
            return
        with self._guard as guard:
            viewport = guard.viewport
            if viewport[2] <= 0 or viewport[3] <= 0:
                return
            if self._prepared is None:
                self._prepare(view, settings, viewport)
                guard.bind_framebuffer()
            assert self._prepared is not None
            _, prepared_for, sheltered = self._prepared
            self._prepared = None
            self._timer.begin()
            if viewport != prepared_for:
                fill_view(self._view_block, view, viewport)
                self._view_block.upload()
            # What was bound while preparing, the guard has taken away since.
            self._view_block.bind()
            self._maps.bind()
            self._layers.draw(view, viewport, sheltered)
            self._timer.end()

    def _draws(self, view: ViewData) -> bool:
        """Whether there is anything to do for a view."""
        wets = self._wetness.needs_map(view) or self._wetness.needs_update(view)
        return wets or self._layers.draws(view)

    def _prepare(
        self, view: ViewData, settings: Settings, viewport: tuple[int, int, int, int]
    ) -> None:
        # Before anything is drawn: a driver asked about work it has just been given starts it
        # at once, and a software driver then draws the frame in pieces.
        times = self._prepare_timer.latest_ms, self._timer.latest_ms
        self.stats["gpu_ms"] = sum(ms or 0.0 for ms in times)
        self.stats["drops_drawn"] = self._layers.drops_drawn if view.containers else 0
        self.stats["splashes"] = self._splash.drawn if view.frame.splash else 0
        self.stats["impacts"] = self._impacts.latest if view.frame.occluders else 0
        self._prepare_timer.begin()
        fill_view(self._view_block, view, viewport)
        self._view_block.upload()
        self._view_block.bind()
        wet_map = self._wetness.needs_map(view)
        sheltered = self._maps.capture(view, settings.heightmap_size, wet_map)
        self.stats["drops_moved"] = self._rain.update(view, sheltered)
        if sheltered:
            self._impacts.count(view)
        # Half as many cells on a side as the map of what the rain hits has texels.
        self._ripples.update(view, sheltered, settings.heightmap_size // 2)
        self._gauges.update(view, sheltered)
        if wet_map or self._wetness.needs_update(view):
            self._wetness.update(view, self._maps.of(view.key) if sheltered else None)
        if self._clouds.draws(view):
            self._clouds.update(view, settings, viewport[3])
            self.stats.update(self._clouds.stats)
        self._layers.update_light(view.frame)
        self._prepare_timer.end()
        self._prepared = view, viewport, sheltered

    def forget(self, key: int) -> None:
        """Give back what belongs to an observer who is gone."""
        with self._guard:
            air = self._airs.pop(key, None)
            self._splash.forget(key)
            self._rain.forget(key)
            self._ripples.forget(key)
            self._clouds.forget(key)
            self._wetness.forget(key)
            self._maps.forget(key)
            if air is not None:
                air.release()

    def reseed(self, seed: int) -> None:
        """Other chances for the drops from here on; those that are in the air are gone."""
        with self._guard:
            self._rain.reseed(seed)
        self._prepared = None

    def release(self) -> None:
        """Give back every OpenGL object, in reverse order; twice does no harm.

        Raises ContextError, and keeps all, where the context is not current; of one that was
        released nothing is left.
        """
        if self._released:
            return
        if is_released(self._ctx):
            self._released = True
            return
        with self._guard:
            self._released = True
            for air in self._airs.values():
                air.release()
            self._kept.release()
        # What the host had bound of ours, as by `air().use`, could not be put back: no error of its
        # own must come of that.
        _ = self._ctx.error
        self._guard.release()
        self._airs.clear()
