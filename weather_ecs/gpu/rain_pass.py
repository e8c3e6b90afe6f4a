"""The two passes of the rain: move the drops, then draw their streaks."""

from __future__ import annotations

from dataclasses import replace

import moderngl

from weather_ecs.frame import ContainerData, ViewData
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.drop_set import DropSet, fill_step
from weather_ecs.gpu.rain_blocks import RAIN_DRAW, RAIN_STEP
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader

GROUP = 128  # drops in a work group; also in rain_step.comp
# A set that no view has used for so many draws is given back.
_KEPT_DRAWS = 600
# The last tenth of the drops in use fades in; also in systems/rain_view.py.
_COUNT_FADE = 0.1

DRAW = ProgramKey(vertex="streak.vert", geometry="streak.geom", fragment="streak.frag")
SHELTERED = replace(DRAW, defines=("SHELTER",))
SHELTER_UNIT = 1
COMPUTE = ProgramKey(compute="rain_step.comp")
FEEDBACK = ProgramKey(vertex="rain_step.vert", varyings=("out_position", "out_velocity"))


def drops_used(container: ContainerData, drops: DropSet) -> int:
    return min(int(container.count) + 1, drops.capacity)


class RainPass:
    """Keeps one `DropSet` per container and observer; `backend` is "compute" or "feedback"."""

    def __init__(
        self, ctx: moderngl.Context, shaders: ShaderLoader, *, backend: str, seed: int
    ) -> None:
        self._ctx = ctx
        self._seed = seed
        self._sets: dict[tuple[int, int], DropSet] = {}
        self._draws = 0
        self._open = shaders.program(DRAW)
        self._sheltered = shaders.program(SHELTERED)
        self._sheltered["shelter_map"] = SHELTER_UNIT
        self._kernel = shaders.program(COMPUTE) if backend == "compute" else None
        self._feedback = shaders.program(FEEDBACK) if backend == "feedback" else None
        self._step_block = BlockBuffer(ctx, RAIN_STEP)
        self._draw_block = BlockBuffer(ctx, RAIN_DRAW)

    def sets(self) -> dict[tuple[int, int], DropSet]:
        """The drops by (observer, container); for tests and statistics."""
        return self._sets

    def update(self, view: ViewData) -> int:
        """Moves the drops of every container in `view`; returns how many."""
        self._draws += 1
        moved = 0
        self._step_block.bind()
        for container in view.containers:
            drops = self._drops(view.key, container)
            drops.last_used = self._draws
            placing = (container.axis, container.shape)
            if view.dt <= 0.0 and drops.placed == placing:
                continue
            moved += self._move(drops, container, view)
            drops.placed = placing
        self._forget()
        return moved

    def _move(self, drops: DropSet, container: ContainerData, view: ViewData) -> int:
        count = drops_used(container, drops)
        drops.steps += 1
        fill_step(
            self._step_block.data,
            drops,
            container.axis,
            container.shape,
            view.frame.wind,
            view.dt,
            container.law,
            count,
            self._seed * 0x9E3779B1 + container.key * 0x85EBCA6B + drops.steps,
        )
        self._step_block.upload()
        if self._kernel is not None:
            drops.births.bind_to_storage_buffer(0)
            drops.states[0].bind_to_storage_buffer(1)
            self._kernel.run((count + GROUP - 1) // GROUP)
            self._ctx.memory_barrier(
                moderngl.VERTEX_ATTRIB_ARRAY_BARRIER_BIT | moderngl.SHADER_STORAGE_BARRIER_BIT
            )
        else:
            following = 1 - drops.current
            drops.step_arrays[drops.current].transform(
                drops.states[following], moderngl.POINTS, vertices=count
            )
            drops.current = following
        drops.alive = count
        return count

    def draw(self, view: ViewData, sheltered: bool = False) -> int:
        """Draws the streaks into the bound framebuffer; returns how many drops were offered.

        With `sheltered`, the collision heightmap at SHELTER_UNIT hides what lies below it.
        """
        look = view.frame.look
        offered = 0
        self._draw_block.bind()
        for container in view.containers:
            drops = self._sets[view.key, container.key]
            data = self._draw_block.data
            data["container_axis"], data["container_shape"] = container.axis, container.shape
            data["area_axis"], data["area_shape"] = container.area_axis, container.area_shape
            data["drop_law"] = container.law
            fade = 1.0 / max(_COUNT_FADE * container.count, 1.0)
            data["drop_load"] = (container.load, container.count, fade, 0.0)
            data["drop_look"] = (
                look.size_maximum, container.size_scale, look.width, look.opacity,
            )  # fmt: skip
            self._draw_block.upload()
            count = min(drops_used(container, drops), drops.alive)
            drops.draw_array(sheltered).render(moderngl.POINTS, vertices=count)
            offered += count
        return offered

    def _drops(self, observer: int, container: ContainerData) -> DropSet:
        key = (observer, container.key)
        drops = self._sets.get(key)
        if drops is not None and drops.capacity != len(container.births):
            drops.release()
            drops = None
        if drops is None:
            drops = DropSet(
                self._ctx, container.births, (self._open, self._sheltered), self._feedback
            )
            self._sets[key] = drops
        return drops

    def _forget(self) -> None:
        if self._draws % 60:
            return
        for key in [k for k, d in self._sets.items() if d.last_used < self._draws - _KEPT_DRAWS]:
            self._sets.pop(key).release()

    def release(self) -> None:
        """Give every buffer back; twice does no harm."""
        for drops in self._sets.values():
            drops.release()
        self._sets.clear()
        self._draw_block.release()
        self._step_block.release()
