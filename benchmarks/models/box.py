"""Drops spread evenly in a box around the observer, moved on the GPU: what both rivals share."""

from __future__ import annotations

from collections.abc import Sequence

import moderngl
import numpy as np
from numpy.typing import NDArray

from benchmarks.models.glsl import program, put
from benchmarks.models.stage import Stage
from weather_ecs.components import RainContainer

BELOW = 0.3  # share of the box's height that lies below the eye, as in the container of ours
SMALLEST, LARGEST = 0.5, 6.0  # mm


def diameters(n: int, rain_rate: float, rng: np.random.Generator) -> NDArray[np.float64]:
    """n drop diameters, mm: Marshall and Palmer (1948) between 0.5 and 6 mm."""
    slope = 4.1 * rain_rate**-0.21
    whole = 1.0 - np.exp(-slope * (LARGEST - SMALLEST))
    return SMALLEST - np.log1p(-rng.random(n) * whole) / slope


def fall_speed(diameter: NDArray[np.float64]) -> NDArray[np.float64]:
    """Terminal speed, m/s, of diameters in mm (Atlas et al. 1973)."""
    return 9.65 - 10.3 * np.exp(-0.6 * diameter)


class BoxRain:
    """`drops` drops in a box of the reach and height that the container of ours has.

    A drop is a position, which transform feedback moves between two buffers, and four constants
    (speed, diameter, brightness, kind) in a third. A subclass draws
    it. The streaks begin with the width and exposure of ours; `size` is a factor on both.
    """

    name = "box"
    kinds = 1  # drops of different appearance

    def __init__(
        self,
        stage: Stage,
        drops: int,
        rain_rate: float,
        *,
        geometry: str,
        fragment: str,
        defines: Sequence[str] = (),
        seed: int = 0,
    ) -> None:
        ctx = self.ctx = stage.ctx
        self.drops = drops
        self.size = 1.0
        self.opacity = 0.5
        look = RainContainer()
        eye = np.array(stage.camera.eye)
        self.box = np.array([2.0 * look.reach, look.height, 2.0 * look.reach])
        self.low = eye - self.box * (0.5, BELOW, 0.5)
        rng = np.random.default_rng(seed)
        self._first = (self.low + rng.random((drops, 3)) * self.box).astype("f4")
        diameter = diameters(drops, rain_rate, rng)
        constants = np.empty((drops, 4), "f4")
        constants[:, 0] = fall_speed(diameter)
        constants[:, 1] = diameter * 1e-3
        constants[:, 2] = rng.uniform(0.6, 1.0, drops)
        constants[:, 3] = rng.integers(0, self.kinds, drops)
        self._constants = ctx.buffer(constants)
        self._positions = [ctx.buffer(self._first) for _ in range(2)]
        self._step = program(ctx, "box_step.vert", varyings=["out_position"])
        self._program = program(ctx, "box.vert", geometry, fragment, defines=defines)
        self._steps = [self._array(self._step, side) for side in self._positions]
        self._draws = [self._array(self._program, side) for side in self._positions]
        self._current = 0
        view_projection = stage.camera.projection @ stage.camera.view
        put(self._step, box_low=tuple(self.low), box_size=tuple(self.box), wind=(0.0, 0.0, 0.0))
        put(
            self._program,
            view_projection=tuple(view_projection.T.ravel()),
            eye=stage.camera.eye,
            wind=(0.0, 0.0, 0.0),
            exposure=look.exposure,
            width=look.width,
        )

    def _array(self, owner: moderngl.Program, positions: moderngl.Buffer) -> moderngl.VertexArray:
        content = [(positions, "3f", "in_position"), (self._constants, "4f", "in_drop")]
        return self.ctx.vertex_array(owner, content)

    def positions(self) -> NDArray[np.float32]:
        """(drops, 3), m, as they stand on the GPU."""
        return np.frombuffer(self._positions[self._current].read(), "f4").reshape(-1, 3)

    def rewind(self) -> None:
        """Put the drops back to where they began."""
        self._positions[self._current].write(self._first)

    def move(self, dt: float) -> None:
        self._step["dt"] = dt
        following = 1 - self._current
        self._steps[self._current].transform(self._positions[following], moderngl.POINTS)
        self._current = following

    def draw(self) -> None:
        """As ours is drawn: blended, tested against the depth, which stays as it is."""
        ctx = self.ctx
        ctx.enable_only(moderngl.BLEND | moderngl.DEPTH_TEST)
        ctx.blend_func = moderngl.SRC_ALPHA, moderngl.ONE_MINUS_SRC_ALPHA
        ctx.fbo.depth_mask = False
        put(self._program, size=self.size, opacity=self.opacity)
        self._bind()
        self._draws[self._current].render(moderngl.POINTS)
        ctx.fbo.depth_mask = True

    def _bind(self) -> None:
        """Textures of the subclass."""

    def release(self) -> None:
        for array in (*self._draws, *self._steps):
            array.release()
        for owner in (self._program, self._step):
            owner.release()
        for buffer in (*self._positions, self._constants):
            buffer.release()
