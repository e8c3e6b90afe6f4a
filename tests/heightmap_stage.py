"""A heightmap, captured and read back, and the rays it is compared with."""

from __future__ import annotations

import moderngl
import numpy as np

from tests.boxes import highest
from weather_ecs.frame import OccluderData
from weather_ecs.gpu.guard import StateGuard
from weather_ecs.gpu.heightmap import Heightmap
from weather_ecs.gpu.occluder_meshes import OccluderMeshes
from weather_ecs.gpu.shader_loader import ShaderLoader

SIZE = 128
REACH = 20.0  # so that a texel is 2 * 1.25 * 20 / 128 = 0.39 m
HERE = (3.0, 1.7, -5.0)


class Maps:
    """A heightmap with all it needs; captures as a renderer does, inside a guard."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.guard = StateGuard(ctx)
        self.shaders = ShaderLoader(ctx)
        self.meshes = OccluderMeshes(ctx, self.shaders)
        self.map = Heightmap(ctx, self.guard, self.meshes, SIZE)

    def capture(
        self,
        *occluders: OccluderData,
        position: tuple[float, float, float] = HERE,
        wind: tuple[float, float, float] = (0.0, 0.0, 0.0),
        fall_speed: float = 8.0,
    ) -> bool:
        with self.guard:
            return self.map.capture(occluders, position, REACH, wind, fall_speed)

    @property
    def counts(self) -> tuple[int, int]:
        """Captures of the static layer, and of all."""
        return self.map.static_captures, self.map.captures

    def depth(self) -> np.ndarray:
        """(rows along z, columns along x)."""
        return np.frombuffer(self.map.texture.read(), np.float32).reshape(SIZE, SIZE)

    def heights(self) -> np.ndarray:
        """World height of the surface, -inf where there is none."""
        place = self.map.footprint
        assert place is not None
        depth = self.depth().astype(np.float64)
        surface = place.top + depth * (place.bottom - place.top)
        return np.where(depth >= 1.0, -np.inf, surface)

    def texels(self) -> np.ndarray:
        """Where the lines of fall through the texels' middles pass height 0, (SIZE, SIZE, 2)."""
        place = self.map.footprint
        assert place is not None
        steps = ((np.arange(SIZE) + 0.5) / SIZE * 2.0 - 1.0) * place.half
        x, z = np.meshgrid(place.center[0] + steps, place.center[1] + steps)
        return np.stack([x, z], axis=-1)

    def at(self, x: float, z: float, y: float = 0.0) -> float:
        """World height of what keeps the rain off a place at height y."""
        place = self.map.footprint
        assert place is not None
        u, v, _ = (place.matrix() @ (x, y, z, 1.0))[:3]
        return round(float(self.heights()[int(v * SIZE), int(u * SIZE)]), 3)

    def release(self) -> None:
        for thing in (self.map, self.meshes, self.shaders, self.guard):
            thing.release()


def assert_as_rays(maps: Maps, transforms: list[np.ndarray]) -> None:
    """Every texel has the height that its line of fall meets; those on an edge may differ."""
    place = maps.map.footprint
    assert place is not None
    expected = highest(maps.texels().reshape(-1, 2), place.slope, transforms)
    expected = np.where(expected < place.bottom, -np.inf, np.minimum(expected, place.top))
    found = maps.heights().ravel()
    same = found == expected
    both = np.isfinite(found) & np.isfinite(expected)
    same[both] = np.abs(found[both] - expected[both]) < 0.01
    assert same.mean() > 0.995
    assert np.isfinite(expected).mean() > 0.005
