"""Ripples in NumPy beside those of a renderer: the same impacts, the same steps."""

from __future__ import annotations

import math
import shutil
from pathlib import Path
from typing import Any

import moderngl
import numpy as np

from weather_ecs.frame import RippleData, ViewData
from weather_ecs.gpu.impact_source import ImpactReader
from weather_ecs.gpu.renderer import Renderer
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.physics import ripple, ripple_place

SHADERS = Path(ripple.__file__).parent.parent / "shaders"
CAPTURE = """
#include "impact.glsl"
out vec4 vs_hit;
out vec4 vs_fall;
void main()
{
    Impact i;
    bool there = read_impact(i);
    vs_hit = vec4(i.position, there ? i.age : -1.0);
    vs_fall = vec4(i.diameter, i.speed, i.weight, there);
    gl_Position = vec4(0.0);
}
"""


class ImpactCapture:
    """The impacts that a program with `impact.glsl` is given, (n, 8), after each update."""

    def __init__(self, ctx: moderngl.Context, renderer: Renderer, folder: Path) -> None:
        self._ctx = ctx
        shutil.copytree(SHADERS, folder, dirs_exist_ok=True)
        (folder / "capture.vert").write_text(CAPTURE, encoding="utf-8")
        self._shaders = ShaderLoader(ctx, root=folder)
        key = ProgramKey(vertex="capture.vert", varyings=("vs_hit", "vs_fall"))
        self._reader = ImpactReader(ctx, self._shaders, renderer.rain, "capture", key)
        self._parts: list[np.ndarray] = []

    def take(self, view: ViewData) -> np.ndarray:
        """Position, age, diameter, speed, weight of every impact there is."""
        self._parts = []
        self._reader.run(view, self._transform)
        rows = np.concatenate(self._parts) if self._parts else np.zeros((0, 8), np.float32)
        return rows[rows[:, 7] > 0.0]

    def _transform(self, array: moderngl.VertexArray, count: int) -> None:
        buffer = self._ctx.buffer(reserve=32 * count)
        array.transform(buffer, moderngl.POINTS, vertices=count)
        self._parts.append(np.frombuffer(buffer.read(), np.float32).reshape(-1, 8).copy())
        buffer.release()

    def release(self) -> None:
        self._reader.release()
        self._shaders.release()


class RippleOracle:
    """One surface. Follows a renderer's draws by wrapping its ripples' update."""

    def __init__(
        self, ctx: moderngl.Context, renderer: Renderer, surface: RippleData, folder: Path
    ) -> None:
        self.capture = ImpactCapture(ctx, renderer, folder)
        self.surface = surface
        self.now: np.ndarray | None = None
        self.before: np.ndarray | None = None
        self.steps: int | None = None
        self.craters = 0
        self._passes: Any = renderer.ripples
        self._update = self._passes.update
        self._passes.update = self._follow

    def _follow(self, view: ViewData, sheltered: bool, most_cells: int) -> None:
        self._update(view, sheltered, most_cells)
        dt = ripple.time_step(self.surface.cell, self.surface.speed)
        place = ripple_place.grid_of(self.surface.size, self.surface.cell, most_cells)
        time = view.frame.time
        due = math.floor(time / dt)
        if self.now is None or self.before is None or self.steps is None:
            self.now = np.zeros(place.cells[::-1], np.float32)
            self.before, self.steps = self.now.copy(), due
            return
        hits = self.capture.take(view)
        window = np.array(self._passes.map(view.key, self.surface).window, np.float32)
        for k in range(self.steps + 1, due + 1):
            ages = np.float32(time - k * dt), np.float32(time - (k - 1) * dt)
            self._press(hits[(hits[:, 3] >= ages[0]) & (hits[:, 3] < ages[1])], place, window)
            following = ripple.step(
                self.now, self.before, self.surface.damping, ripple.THRESHOLD,
                periodic=not all(place.held),
            )  # fmt: skip
            self.now, self.before = following, self.now
        self.steps = due

    def _press(self, hits: np.ndarray, place: Any, window: np.ndarray) -> None:
        surface = self.surface
        hits = hits[abs(hits[:, 1] - surface.center[1]) <= ripple.ON_SURFACE]
        own = np.array(
            [
                ripple_place.to_own(surface.center, surface.heading, x, z)
                for x, z in hits[:, [0, 2]].tolist()
            ]
        ).reshape(-1, 2)
        inside = (abs(own - window[:2]) < window[2:]).all(axis=1)
        if surface.ellipse:
            inside &= ((own / (0.5 * np.array(surface.size))) ** 2).sum(axis=1) < 1.0
        hits, own = hits[inside], own[inside]
        off, deep = ripple.craters(hits[:, :3], hits[:, 4], hits[:, 5], hits[:, 6])
        cells = np.array(place.cells)
        spots = ((own[:, None] + off) / surface.cell + 0.5 * cells)[deep > 0.0]
        deep = deep[deep > 0.0]
        if not all(place.held):
            spots %= cells
        assert self.now is not None
        ripple.add_sources(self.now, spots, deep, periodic=not all(place.held))
        self.craters += len(deep)

    def release(self) -> None:
        self._passes.update = self._update
        self.capture.release()
