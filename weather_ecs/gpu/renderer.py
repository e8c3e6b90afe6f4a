"""`Renderer`: everything that is drawn, in its order, as a guest in the host's framebuffer."""

from __future__ import annotations

from typing import Protocol, TypeVar

import moderngl
import numpy as np

from weather_ecs.errors import ContextError, InvalidValueError
from weather_ecs.frame import FrameData, GaugeReading, ViewData
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.bolt_pass import NO_RAIN, BoltPass, Rain
from weather_ecs.gpu.cloud_pass import Between, CloudPass, CloudSettings
from weather_ecs.gpu.cloud_shadow import CloudShadow
from weather_ecs.gpu.context import probe
from weather_ecs.gpu.depth import DepthCopy
from weather_ecs.gpu.fog_pass import FogPass
from weather_ecs.gpu.gauge_pass import GaugePass
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.guard import StateGuard
from weather_ecs.gpu.heightmap import Heightmap
from weather_ecs.gpu.impact_count import ImpactCount
from weather_ecs.gpu.occluder_meshes import OccluderMeshes
from weather_ecs.gpu.rain_blocks import RAIN_VIEW, SHELTER
from weather_ecs.gpu.rain_pass import SHELTER_UNIT, RainPass
from weather_ecs.gpu.ripple_pass import RipplePass
from weather_ecs.gpu.shader_loader import ShaderLoader
from weather_ecs.gpu.sky_pass import SkyPass
from weather_ecs.gpu.splash_pass import SplashPass
from weather_ecs.gpu.timer import GpuTimer, PrimitiveCounter
from weather_ecs.gpu.veil_pass import VeilPass
from weather_ecs.gpu.view_block import fill_view
from weather_ecs.gpu.weather_air import WeatherAir
from weather_ecs.gpu.weather_sky import WeatherSky
from weather_ecs.gpu.wetness_map import WetnessMap
from weather_ecs.gpu.wetness_pass import WetnessPass
from weather_ecs.physics.footprint import fall_speed_over, landing_wind


class Settings(CloudSettings, Protocol):
    """What the renderer needs of the quality settings."""

    @property
    def heightmap_size(self) -> int: ...


class Releasable(Protocol):
    """What holds OpenGL objects."""

    def release(self) -> object: ...


Thing = TypeVar("Thing", bound=Releasable)


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
        self._largest = int(ctx.info["GL_MAX_TEXTURE_SIZE"])
        self._gl = GL()
        self._guard = StateGuard(ctx, self._gl)
        self._made: list[Releasable] = []  # oldest first
        self._maps: dict[int, Heightmap] = {}
        self._airs: dict[int, WeatherAir] = {}
        self._released = False
        try:
            # Making objects binds them; the host must not notice that either.
            with self._guard:
                self._make(seed)
        except BaseException:
            self.release()
            raise

    def _keep(self, thing: Thing) -> Thing:
        self._made.append(thing)
        return thing

    def _make(self, seed: int) -> None:
        ctx, gl, keep = self._ctx, self._gl, self._keep
        shaders = keep(ShaderLoader(ctx, gl=gl))
        rain = self._rain = keep(RainPass(ctx, shaders, backend=self.backend, seed=seed))
        self._splash = keep(SplashPass(ctx, gl, shaders, rain))
        self._impacts = keep(ImpactCount(ctx, gl, shaders, rain))
        self._ripples = keep(RipplePass(ctx, shaders, rain))
        self._gauges = keep(GaugePass(ctx, shaders, rain))
        self._wetness = keep(WetnessPass(ctx, gl, shaders))
        self._clouds = keep(CloudPass(ctx, shaders))
        self._bolts = keep(BoltPass(ctx, shaders))
        self._fog = keep(FogPass(ctx, shaders))
        self._weather_sky: WeatherSky | None = None  # made when first asked for
        self._sky: SkyPass | None = None
        self._shaders = shaders
        self._veil = keep(VeilPass(ctx, shaders))
        self._view_block = keep(BlockBuffer(ctx, RAIN_VIEW))
        self._shelter_block = keep(BlockBuffer(ctx, SHELTER))
        self._depth = keep(DepthCopy(ctx, gl))
        # Stands for the depth of a host that has none: nothing in the way anywhere.
        nothing = np.ones(1, np.float32).tobytes()
        self._no_depth = keep(ctx.texture((1, 1), 1, data=nothing, dtype="f4"))
        self._scene_depth: moderngl.Texture | None = None  # as copied in this draw
        # What the last `prepare` was for, with its viewport, and whether anything shelters there.
        self._prepared: tuple[ViewData, tuple[int, int, int, int], bool] | None = None
        self._meshes = keep(OccluderMeshes(ctx, shaders))
        self._timer = keep(GpuTimer(gl))
        self._prepare_timer = keep(GpuTimer(gl))
        self._counter = keep(PrimitiveCounter(gl))

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

    def air(
        self, key: int, frame: FrameData, y: float, rate: float, place: tuple[float, float]
    ) -> WeatherAir:
        """The air round an observer at the height y, where it rains or snows at a rate (mm/h).

        place: (x, z), m.
        """
        air = self._airs.get(key)
        if air is None or air.stale(frame, y, rate):
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

    def take_readings(self) -> list[GaugeReading]:
        """What the rain gauges have counted, as far as it has come back since the last call."""
        return self._gauges.take()

    def heightmap(self, key: int = 0) -> Heightmap | None:
        """The collision heightmap of an observer, if there is one yet."""
        return self._maps.get(key)

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
            self._shelter_block.bind()
            self._scene_depth = None
            clouds, bolts = self._clouds.draws(view), self._bolts.draws(view)
            self._draw_sky(view, viewport[3])
            self._draw_fog(view)
            self._draw_veils(view, below=True)
            if clouds:
                self._draw_clouds(view, viewport, bolts)
            elif bolts:
                self._draw_bolts(view, NO_RAIN)
            self._draw_ripples(view)
            self._draw_veils(view, below=False)
            if bolts and view.veils:
                self._draw_bolts(view, self._bolts.rain(view))
            self._draw_bow(view)
            self._draw_splashes(view, sheltered)
            self._draw_drops(view)
            self._timer.end()

    def _draws(self, view: ViewData) -> bool:
        """Whether there is anything to do for a view."""
        wets = self._wetness.needs_map(view) or self._wetness.needs_update(view)
        if view.containers or view.veils or view.frame.ripples or wets:
            return True
        air = self._fog.draws(view) or self._clouds.draws(view) or self._bolts.draws(view)
        return air or self._needs_sky(view)

    def _prepare(
        self, view: ViewData, settings: Settings, viewport: tuple[int, int, int, int]
    ) -> None:
        # Before anything is drawn: a driver asked about work it has just been given starts it
        # at once, and a software driver then draws the frame in pieces.
        times = self._prepare_timer.latest_ms, self._timer.latest_ms
        self.stats["gpu_ms"] = sum(ms or 0.0 for ms in times)
        self.stats["drops_drawn"] = self._counter.latest or 0 if view.containers else 0
        self.stats["splashes"] = self._splash.drawn if view.frame.splash else 0
        self.stats["impacts"] = self._impacts.latest if view.frame.occluders else 0
        self._prepare_timer.begin()
        fill_view(self._view_block, view, viewport)
        self._view_block.upload()
        self._view_block.bind()
        wet_map = self._wetness.needs_map(view)
        sheltered = self._capture(view, settings, wet_map)
        self.stats["drops_moved"] = self._rain.update(view, sheltered)
        if sheltered:
            self._impacts.count(view)
        # Half as many cells on a side as the map of what the rain hits has texels.
        self._ripples.update(view, sheltered, settings.heightmap_size // 2)
        self._gauges.update(view, sheltered)
        if wet_map or self._wetness.needs_update(view):
            self._wetness.update(view, self._maps.get(view.key) if sheltered else None)
        if self._clouds.draws(view):
            self._clouds.update(view, settings, viewport[3])
            self.stats.update(self._clouds.stats)
        if self._weather_sky is not None:
            self._weather_sky.update(view.frame.atmosphere, view.frame.sky)
        self._prepare_timer.end()
        self._prepared = view, viewport, sheltered

    def _capture(self, view: ViewData, settings: Settings, wet: bool) -> bool:
        """Brings the collision heightmap up to date; False where nothing shelters."""
        occluders = view.frame.occluders
        if not occluders or not (view.containers or wet):
            return False
        heightmap = self._maps.get(view.key)
        look = view.frame.heightmap
        size = min(settings.heightmap_size * look.resolution, self._largest)
        size = 4 * max(round(size / 4.0), 4)
        if heightmap is None or heightmap.size != size:
            if heightmap is not None:
                heightmap.release()
            heightmap = Heightmap(self._ctx, self._guard, self._meshes, size)
            self._maps[view.key] = heightmap
        wind, reach = landing_wind(view.frame.wind, view.frame.profile), view.frame.look.reach
        speed = fall_speed_over(view.frame.areas["rain_rate"], view.frame.air.snow_share)
        if heightmap.footprint is not None and not view.frame.areas["rain_rate"].any():
            # Nothing falls: the map stays as it was, for what is still wet.
            (x, z), speed = heightmap.footprint.slope, 1.0
            wind = (x, 0.0, z)
        if heightmap.capture(occluders, view.position, reach, wind, speed, look.extent):
            self._meshes.keep(occluders)
        heightmap.fill(self._shelter_block)
        self._shelter_block.upload()
        self._shelter_block.bind()
        heightmap.texture.use(SHELTER_UNIT)
        return True

    def _copy_depth(self) -> moderngl.Texture:
        """The scene's depth, copied once in a draw: nothing here writes depth."""
        if self._scene_depth is None:
            self._scene_depth = self._depth.copy(self._guard) or self._no_depth
        return self._scene_depth

    def _draw_ripples(self, view: ViewData) -> None:
        if not self._ripples.draws:
            return
        depth = self._copy_depth()
        self._ctx.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST)
        self._gl.glDepthMask(0)
        self._ripples.draw(view, depth)

    def _draw_clouds(
        self, view: ViewData, viewport: tuple[int, int, int, int], bolts: bool
    ) -> None:
        parted = self._bolts.distance(view) if bolts else 0.0
        self._clouds.paint(view, self._copy_depth, viewport, parted)
        self._guard.bind_framebuffer()
        self._ctx.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST)
        self._gl.glDepthMask(0)
        among = None
        if bolts:
            among = Between(parted, lambda: self._bolts.draw(view))
        self._clouds.draw(view, among)

    def _draw_bolts(self, view: ViewData, rain: Rain | None) -> None:
        if rain is None:
            return
        self._ctx.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST)
        self._gl.glDepthMask(0)
        self._bolts.draw(view, rain)

    def sky(self, frame: FrameData) -> WeatherSky:
        """The sky's radiance in a frame, for a game's own shaders."""
        sky = self._weather_sky
        if sky is None or sky.stale(frame.atmosphere, frame.sky):
            with self._guard:
                if sky is None:
                    sky = self._weather_sky = self._keep(WeatherSky(self._ctx, self._shaders))
                sky.update(frame.atmosphere, frame.sky)
        return sky

    def _needs_sky(self, view: ViewData) -> bool:
        """Whether there is a sky to draw, or its map to bring up to date."""
        air, known = view.frame.atmosphere, self._weather_sky
        if air is not None and air.draw:
            return True
        return known is not None and known.stale(air, view.frame.sky)

    def _draw_sky(self, view: ViewData, height: int) -> None:
        """Where a framebuffer has no depth, nothing says where the scene is: no sky then."""
        air = view.frame.atmosphere
        if air is None or not air.draw:
            return
        if self._sky is None:
            self._sky = self._keep(SkyPass(self._ctx, self._shaders, self.sky(view.frame)))
            self._guard.bind_framebuffer()
        if self._sky.draws(view) and self._depth.available(self._guard):
            self._gl.glDepthMask(0)
            self._sky.draw(view, height)

    def _draw_bow(self, view: ViewData) -> None:
        if self._sky is not None and self._sky.draws(view) and self._sky.has_bow:
            self._ctx.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST)
            self._gl.glDepthMask(0)
            self._sky.draw_bow(view)

    def _draw_fog(self, view: ViewData) -> None:
        if not self._fog.draws(view):
            return
        depth = self._copy_depth()
        self._ctx.enable_only(moderngl.BLEND)
        self._gl.glDepthMask(0)
        self._fog.draw(view, depth)

    def _draw_veils(self, view: ViewData, *, below: bool) -> None:
        """Of the rain that ends below the camera, or of the rest: a cloud hides what it drops."""
        y = view.position[1]
        veils = [veil for veil in view.veils if (veil.span[1] < y) is below]
        if not veils:
            return
        depth = self._copy_depth()
        self._ctx.enable_only(moderngl.BLEND)
        self._gl.glDepthMask(0)
        has_depth = depth is not self._no_depth
        self._veil.draw(view, veils, depth, self._guard if has_depth else None)

    def _draw_splashes(self, view: ViewData, sheltered: bool) -> None:
        look = view.frame.splash
        if look is None or not sheltered:
            return
        self._ctx.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST)
        self._gl.glDepthMask(0)
        self._maps[view.key].texture.use(SHELTER_UNIT)  # other passes have used the unit
        self._splash.draw(view, look)

    def _draw_drops(self, view: ViewData) -> None:
        if not view.containers:
            return
        self._ctx.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST)
        self._gl.glDepthMask(0)
        with self._counter:
            self._rain.draw(view)

    def forget(self, key: int) -> None:
        """Give back what belongs to an observer who is gone."""
        heightmap, air = self._maps.pop(key, None), self._airs.pop(key, None)
        with self._guard:
            self._splash.forget(key)
            self._rain.forget(key)
            self._ripples.forget(key)
            self._clouds.forget(key)
            self._wetness.forget(key)
            if heightmap is not None:
                heightmap.release()
            if air is not None:
                air.release()

    def release(self) -> None:
        """Give back every OpenGL object, in reverse order; twice does no harm."""
        if self._released:
            return
        self._released = True
        with self._guard:
            held: list[Releasable] = [*self._airs.values(), *self._maps.values()]
            for thing in held + self._made[::-1]:
                thing.release()
        # What the host had bound of ours, as by `air().use`, could not be put back: no error of its
        # own must come of that.
        _ = self._ctx.error
        self._guard.release()
        self._maps.clear()
        self._airs.clear()
        self._made.clear()
