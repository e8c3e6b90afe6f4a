"""`Layers`: what a view shows, drawn over the host's picture from far to near."""

from __future__ import annotations

from dataclasses import dataclass

import moderngl
import numpy as np

from weather_ecs.frame import FrameData, ViewData
from weather_ecs.gpu.bolt_pass import NO_RAIN, BoltPass, Rain
from weather_ecs.gpu.cloud_hidden import Window
from weather_ecs.gpu.cloud_pass import Between, CloudPass
from weather_ecs.gpu.collision_maps import CollisionMaps
from weather_ecs.gpu.depth import DepthCopy
from weather_ecs.gpu.depth_lent import LentDepth
from weather_ecs.gpu.fog_pass import FogPass
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.guard import StateGuard
from weather_ecs.gpu.keeper import Keeper
from weather_ecs.gpu.rain_pass import RainPass
from weather_ecs.gpu.ripple_pass import RipplePass
from weather_ecs.gpu.shader_loader import ShaderLoader
from weather_ecs.gpu.sky_pass import SkyPass
from weather_ecs.gpu.splash_pass import SplashPass
from weather_ecs.gpu.timer import PrimitiveCounter
from weather_ecs.gpu.veil_pass import VeilPass
from weather_ecs.gpu.weather_sky import WeatherSky


@dataclass(frozen=True, slots=True)
class Moved:
    """The passes whose part of a draw is done ahead of it, and the maps of what rain hits."""

    rain: RainPass
    splash: SplashPass
    ripples: RipplePass
    clouds: CloudPass
    maps: CollisionMaps


class Layers:
    """Fog, sky, clouds, lightning, water, veils, splashes and drops; inside the state guard."""

    def __init__(
        self,
        ctx: moderngl.Context,
        gl: GL,
        guard: StateGuard,
        shaders: ShaderLoader,
        moved: Moved,
        keeper: Keeper,
    ) -> None:
        self._ctx, self._gl, self._guard, self._shaders = ctx, gl, guard, shaders
        self._rain, self._splash, self._ripples = moved.rain, moved.splash, moved.ripples
        self._clouds, self._maps = moved.clouds, moved.maps
        self._keep = keep = keeper.keep
        self._bolts = keep(BoltPass(ctx, shaders))
        self._fog = keep(FogPass(ctx, shaders))
        self._light: WeatherSky | None = None  # made when first asked for
        self._sky: SkyPass | None = None
        self._veil = keep(VeilPass(ctx, shaders))
        self._depth = keep(DepthCopy(ctx, gl))
        self._lent = keep(LentDepth(ctx, gl))
        # Stands for the depth of a host that has none: nothing in the way anywhere.
        nothing = np.ones(1, np.float32).tobytes()
        self._no_depth = keep(ctx.texture((1, 1), 1, data=nothing, dtype="f4"))
        self._scene_depth: moderngl.Texture | None = None  # as found in this draw
        self._counter = keep(PrimitiveCounter(gl))

    @property
    def drops_drawn(self) -> int:
        """As counted in the latest draw whose count has come back."""
        return self._counter.latest or 0

    def draws(self, view: ViewData) -> bool:
        """Whether a view shows anything, or a map of the sky is out of date."""
        if view.containers or view.veils or view.frame.ripples:
            return True
        air = self._fog.draws(view) or self._clouds.draws(view) or self._bolts.draws(view)
        return air or self._needs_sky(view)

    def draw(self, view: ViewData, viewport: tuple[int, int, int, int], sheltered: bool) -> None:
        """Draw what there is; where it is `sheltered`, the observer has a collision map."""
        self._scene_depth = None
        try:
            self._draw(view, viewport, sheltered)
        finally:
            self._lent.give_back()

    def _draw(self, view: ViewData, viewport: tuple[int, int, int, int], sheltered: bool) -> None:
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

    # The sky's light, by direction

    def light_is_made(self, frame: FrameData) -> bool:
        """Whether `light` has nothing to do."""
        return self._light is not None and not self._light.stale(frame.atmosphere, frame.sky)

    def light(self, frame: FrameData) -> WeatherSky:
        """That of a frame; may leave another framebuffer bound."""
        if self._light is None:
            self._light = self._keep(WeatherSky(self._ctx, self._shaders))
        self._light.update(frame.atmosphere, frame.sky)
        return self._light

    def update_light(self, frame: FrameData) -> None:
        """Bring it up to date where it has been asked for before."""
        if self._light is not None:
            self._light.update(frame.atmosphere, frame.sky)

    def _needs_sky(self, view: ViewData) -> bool:
        """Whether there is a sky to draw, or its map to bring up to date."""
        air, known = view.frame.atmosphere, self._light
        if air is not None and air.draw:
            return True
        return known is not None and known.stale(air, view.frame.sky)

    # One after another

    def _depth_to_read(self) -> moderngl.Texture:
        """The scene's depth, lent or copied once in a draw: nothing here writes depth."""
        if self._scene_depth is None:
            self._guard.bind_framebuffer()
            found = self._lent.take(self._guard) or self._depth.copy(self._guard)
            self._scene_depth = found or self._no_depth
        return self._scene_depth

    def _draw_sky(self, view: ViewData, height: int) -> None:
        """Where a framebuffer has no depth, nothing says where the scene is: no sky then."""
        air = view.frame.atmosphere
        if air is None or not air.draw:
            return
        if self._sky is None:
            self._sky = self._keep(SkyPass(self._ctx, self._shaders, self.light(view.frame)))
            self._guard.bind_framebuffer()
        if self._sky.draws(view) and self._depth.available(self._guard):
            self._gl.glDepthMask(0)
            window = Window(self._gl, self._clouds.sky_low(view), self._guard.viewport)
            window.on()
            self._sky.draw(view, height)
            window.off()

    def _draw_bow(self, view: ViewData) -> None:
        if self._sky is not None and self._sky.draws(view) and self._sky.has_bow:
            self._ctx.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST)
            self._gl.glDepthMask(0)
            self._sky.draw_bow(view)

    def _draw_fog(self, view: ViewData) -> None:
        if not self._fog.draws(view):
            return
        depth = self._depth_to_read()
        self._ctx.enable_only(moderngl.BLEND)
        self._gl.glDepthMask(0)
        self._fog.draw(view, depth)

    def _draw_veils(self, view: ViewData, *, below: bool) -> None:
        """Of the rain that ends below the camera, or of the rest: a cloud hides what it drops."""
        y = view.position[1]
        veils = [veil for veil in view.veils if (veil.span[1] < y) is below]
        if not veils:
            return
        depth = self._depth_to_read()
        self._ctx.enable_only(moderngl.BLEND)
        self._gl.glDepthMask(0)
        has_depth = depth is not self._no_depth
        self._veil.draw(view, veils, depth, self._guard if has_depth else None)

    def _draw_clouds(
        self, view: ViewData, viewport: tuple[int, int, int, int], bolts: bool
    ) -> None:
        parted = self._bolts.distance(view) if bolts else 0.0
        self._clouds.paint(view, self._depth_to_read, viewport, parted)
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

    def _draw_ripples(self, view: ViewData) -> None:
        if not self._ripples.draws:
            return
        depth = self._depth_to_read()
        self._ctx.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST)
        self._gl.glDepthMask(0)
        self._ripples.draw(view, depth)

    def _draw_splashes(self, view: ViewData, sheltered: bool) -> None:
        look = view.frame.splash
        if look is None or not sheltered:
            return
        self._ctx.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST)
        self._gl.glDepthMask(0)
        self._maps.use(view.key)  # other passes have used the unit
        self._splash.draw(view, look)

    def _draw_drops(self, view: ViewData) -> None:
        if not view.containers:
            return
        self._ctx.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST)
        self._gl.glDepthMask(0)
        self._rain.look(view)
        with self._counter:
            self._rain.draw(view)
