"""`CollisionMaps`: what of each observer's surroundings the rain hits, and what it shelters."""

from __future__ import annotations

import moderngl

from weather_ecs.frame import ViewData, plain_areas
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.guard import StateGuard
from weather_ecs.gpu.heightmap import Heightmap
from weather_ecs.gpu.occluder_meshes import OccluderMeshes
from weather_ecs.gpu.rain_blocks import SHELTER
from weather_ecs.gpu.rain_pass import MOTION_UNIT, SHELTER_UNIT
from weather_ecs.gpu.shader_loader import ShaderLoader
from weather_ecs.gpu.weather_heightmap import WeatherHeightmap
from weather_ecs.physics.footprint import landing_wind, mean_fall_speed


class CollisionMaps:
    """A heightmap for every observer, and the block that tells shaders how the last one lies."""

    def __init__(self, ctx: moderngl.Context, guard: StateGuard, shaders: ShaderLoader) -> None:
        self._ctx, self._guard = ctx, guard
        self._largest = int(ctx.info["GL_MAX_TEXTURE_SIZE"])
        self._maps: dict[int, Heightmap] = {}
        self._opened: dict[int, WeatherHeightmap] = {}  # to the game
        self._meshes = OccluderMeshes(ctx, shaders)
        self._block = BlockBuffer(ctx, SHELTER)

    def of(self, key: int) -> Heightmap | None:
        """The map of an observer, if there is one yet."""
        return self._maps.get(key)

    def opened(self, key: int) -> WeatherHeightmap | None:
        """What a game's shaders read of an observer's map, if they have asked before."""
        return self._opened.get(key)

    def open(self, key: int) -> WeatherHeightmap:
        """What a game's shaders read of an observer's map from now on."""
        made = self._opened[key] = WeatherHeightmap(self._ctx, lambda: self._maps.get(key))
        return made

    def capture(self, view: ViewData, wanted: int, wet: bool) -> bool:
        """Bring an observer's map up to date; False where nothing shelters.

        wanted: texels on a side by the quality. wet: whether the ground's water needs the map.
        """
        occluders = view.frame.occluders
        if not occluders or not (view.containers or wet):
            return False
        heightmap = self._maps.get(view.key)
        look = view.frame.heightmap
        size = min(wanted * look.resolution, self._largest)
        size = 4 * max(round(size / 4.0), 4)
        if heightmap is None or heightmap.size != size:
            if heightmap is not None:
                heightmap.release()
            heightmap = Heightmap(self._ctx, self._guard, self._meshes, size)
            self._maps[view.key] = heightmap
        wind, reach = landing_wind(view.frame.wind, view.frame.profile), view.frame.look.reach
        rate = max([area.rain_rate for area in plain_areas(view.frame.areas)], default=0.0)
        speed = mean_fall_speed(rate, view.frame.air.snow_share)
        if heightmap.footprint is not None and rate == 0.0:
            # Nothing falls: the map stays as it was, for what is still wet.
            (x, z), speed = heightmap.footprint.slope, 1.0
            wind = (x, 0.0, z)
        time = view.frame.time
        place = view.position, reach, wind, speed, look.extent
        if heightmap.capture(occluders, *place, time) and heightmap.others:
            self._meshes.keep(occluders)
        heightmap.fill(self._block)
        self._block.upload()
        self._block.bind()
        self.use(view.key)
        return True

    def bind(self) -> None:
        """Bind the block again."""
        self._block.bind()

    def use(self, key: int) -> None:
        """Bind an observer's map."""
        self._maps[key].texture.use(SHELTER_UNIT)
        self._maps[key].motion.use(MOTION_UNIT)

    def forget(self, key: int) -> None:
        """Give back the map of an observer who is gone."""
        for thing in (self._maps.pop(key, None), self._opened.pop(key, None)):
            if thing is not None:
                thing.release()

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for key in {*self._maps, *self._opened}:
            self.forget(key)
        self._meshes.release()
        self._block.release()
