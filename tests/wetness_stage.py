"""A map of wetness over a ground with a roof, moved on and read back."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import moderngl
import numpy as np

from tests.boxes import box, placed
from tests.rain_frames import area, camera, frame, quality
from weather_ecs.frame import FrameData, OccluderData, ViewData, WetnessData
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.guard import StateGuard
from weather_ecs.gpu.heightmap import Heightmap
from weather_ecs.gpu.occluder_meshes import OccluderMeshes
from weather_ecs.gpu.rain_blocks import SHELTER
from weather_ecs.gpu.shader_loader import ShaderLoader
from weather_ecs.gpu.wetness_far import HALF
from weather_ecs.gpu.wetness_pass import WetnessPass
from weather_ecs.physics import wet_map
from weather_ecs.physics.ellipse import edge_factor
from weather_ecs.physics.footprint import fall_speed_over
from weather_ecs.physics.front import SETTLED, water_arrived
from weather_ecs.physics.snow_cover import melt_rate
from weather_ecs.systems.rain_view import RainView

SIZE = 128
Point = tuple[float, float, float]

LEVEL = box(0, placed((0, -1, 0), (200, 1, 200)))


class Maps:
    """A wetness pass and what it needs, driven as a renderer does."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.guard, self.shaders = StateGuard(ctx), ShaderLoader(ctx)
        self.meshes = OccluderMeshes(ctx, self.shaders)
        self.heightmap = Heightmap(ctx, self.guard, self.meshes, SIZE)
        self.block = BlockBuffer(ctx, SHELTER)
        self.wetness = WetnessPass(ctx, GL(), self.shaders)
        self.view_of = RainView()

    def view(self, frame: FrameData, position: Point) -> ViewData:
        return self.view_of.view(frame, camera(position), 0, quality())

    def update(self, frame: FrameData, position: Point = (0.0, 1.7, 0.0)) -> None:
        view = self.view(frame, position)
        speed = fall_speed_over(frame.areas["rain_rate"])
        with self.guard:
            if frame.occluders:
                self.heightmap.capture(frame.occluders, position, 15.0, frame.wind, speed)
                self.heightmap.fill(self.block)
                self.block.upload()
                self.block.bind()
            self.wetness.update(view, self.heightmap if frame.occluders else None)

    @property
    def seen(self) -> Any:
        return self.wetness._observed[0]

    def read(self) -> np.ndarray:
        """(rows along z, columns along x, mm of water, height and mm of snow)."""
        texture = self.seen.textures[self.seen.current]
        raw = np.frombuffer(texture.read(), np.float32).reshape(*texture.size, 4)
        return raw[..., :3].copy()

    def at(self, x: float, y: float, z: float, what: int = 0) -> float:
        """mm of water at the texel over a point; with 2, of snow."""
        place = self.seen.place
        u = (x + y * place.slope[0] - place.center[0]) / place.texel + 0.5 * place.size
        w = (z + y * place.slope[1] - place.center[1]) / place.texel + 0.5 * place.size
        return float(self.read()[int(w), int(u), what])

    def expected(self, frame: FrameData, before: np.ndarray | None, old: Any, ages: Any) -> Any:
        """What the oracle makes of the map before."""
        depths = [
            np.frombuffer(texture.read(), np.float32).reshape(SIZE, SIZE)
            for texture in (self.heightmap.static_texture, self.heightmap.texture)
        ]
        footprint, place = self.heightmap.footprint, self.seen.place
        assert footprint is not None
        found = wet_map.surface(place, footprint, *depths)
        points = found.position.reshape(-1, 3)
        rate = np.zeros(len(points))
        for key, center, radii, heading, full, edge, ceiling in frame.areas.tolist():
            share = edge_factor(points[:, [0, 2]], center, radii, heading, edge)
            share *= water_arrived(ceiling - points[:, 1], frame.fronts.get(key, SETTLED), full)
            rate += np.where(points[:, 1] < ceiling, full * share, 0.0)
        far = self.far(points[:, [0, 2]]).reshape(place.size, place.size, 2)
        water, seconds = wet_map.carried(found, far, before, old, ages)
        rate = rate.reshape(place.size, place.size)
        air = frame.air
        melt = float(melt_rate(air.wet_bulb))
        collects = air.snow_share * frame.flakes.settling
        return found, wet_map.step(found, water, seconds, rate, air.snow_share, melt, collects)

    def far(self, points: np.ndarray) -> np.ndarray:
        texture = self.seen.far.texture
        n = texture.width
        table = np.frombuffer(texture.read(), np.float32).reshape(n, n, 2)
        at = (points - self.seen.far.middle) / (2.0 * HALF) * n + 0.5 * n - 0.5
        low = np.floor(at).astype(int)
        part = at - low
        total = np.zeros((len(points), 2))
        for i in (0, 1):
            for j in (0, 1):
                x, z = np.clip(low + (i, j), 0, n - 1).T
                weight = np.abs(1 - i - part[:, 0]) * np.abs(1 - j - part[:, 1])
                total += weight[:, None] * table[z, x]
        return total

    def release(self) -> None:
        for thing in (self.wetness, self.block, self.heightmap, self.meshes, self.shaders):
            thing.release()
        self.guard.release()


def dry_ground(time: float, number: int = 1) -> WetnessData:
    """Ground that has been dry up to a time."""
    return WetnessData(number, int(time), ())


def scene(time: float, *occluders: OccluderData, **rest: Any) -> FrameData:
    """Rain of 40 mm/h over half of what there is, on ground that was dry."""
    ground = rest.pop("wetness", dry_ground(time))
    rows = rest.pop("rows", [area(0, (8.0, 0.0), (25.0, 20.0), 40.0, 0.3, 6.0)])
    return frame(*rows, time=time, occluders=occluders, wetness=ground, **rest)


# What it does


def walk(
    maps: Maps, seconds: float, data: Callable[[float], FrameData], step: float = 0.25,
    start: float = 0.0, x: Callable[[float], float] = lambda t: 0.0,
) -> None:  # fmt: skip
    for k in range(round(seconds / step) + 1):
        time = start + k * step
        maps.update(data(time), (x(time), 1.7, 0.0))
