"""The passes of rain and snow: move the drops and flakes, and draw them."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import dataclass

import moderngl

from weather_ecs.frame import RAIN, SNOW, ContainerData, ViewData
from weather_ecs.gpu.air_block import AirBlock
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.compute_order import ComputeOrder
from weather_ecs.gpu.drop_set import DropSet
from weather_ecs.gpu.feedback_list import FeedbackList, Lister
from weather_ecs.gpu.impact_list import ImpactList, list_for
from weather_ecs.gpu.impact_times import ImpactTimes, in_epoch
from weather_ecs.gpu.kind_programs import MOTION_UNIT as MOTION_UNIT
from weather_ecs.gpu.kind_programs import SHELTER_UNIT as SHELTER_UNIT
from weather_ecs.gpu.kind_programs import KindPrograms, step_name
from weather_ecs.gpu.rain_blocks import DRAW, RAIN_DRAW, RAIN_STEP, STEP
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.gpu.streak_list import StreakList

GROUP = 64 * 32  # drops that a work group of rain_step.comp moves
# A set that no view has used for so many draws is given back.
_KEPT_DRAWS = 600
# The last tenth of the drops in use fades in; also in systems/rain_view.py.
_COUNT_FADE = 0.1

FIND = ProgramKey(compute="impact_find.comp")

# How what a step has written is read: by the search for hits, and by all that comes after.
_LISTED = moderngl.SHADER_STORAGE_BARRIER_BIT | moderngl.COMMAND_BARRIER_BIT
_MOVED = (
    moderngl.VERTEX_ATTRIB_ARRAY_BARRIER_BIT
    | moderngl.SHADER_STORAGE_BARRIER_BIT
    | moderngl.BUFFER_UPDATE_BARRIER_BIT
)


@dataclass(slots=True)
class _Observed:
    """What one observer's rain keeps on the GPU."""

    sets: dict[int, DropSet]
    impacts: ImpactList | None


class RainPass:
    """Keeps one `DropSet` per container and observer; `backend` is "compute" or "feedback"."""

    def __init__(
        self,
        ctx: moderngl.Context,
        shaders: ShaderLoader,
        *,
        backend: str,
        seed: int,
        impact_capacity: int | None = None,
    ) -> None:
        self._ctx = ctx
        self._seed = seed
        self._capacity = impact_capacity
        self._observed: dict[int, _Observed] = {}
        self._draws = 0
        self._lists = backend == "compute"
        self._shaders = shaders
        self._readers: dict[str, moderngl.Program] = {}
        self._kinds: dict[int, KindPrograms] = {}
        self._kind(RAIN)
        self._find = shaders.program(FIND) if self._lists else None
        if self._find is not None:
            self._find["shelter_map"], self._find["shelter_motion"] = SHELTER_UNIT, MOTION_UNIT
        self._order = ComputeOrder(ctx)
        self._lister: Lister | None = None
        self._times = ImpactTimes(shaders, self._order)
        self._step_block = BlockBuffer(ctx, RAIN_STEP)
        self._air = AirBlock(ctx)
        self._steady = False  # the air of this draw
        self._draw_block = BlockBuffer(ctx, RAIN_DRAW)
        self._filled: tuple[ContainerData, ViewData] | None = None  # what it holds

    def add_reader(self, name: str, program: moderngl.Program) -> None:
        """A program that reads drops and flakes as vertices."""
        self._readers[name] = program
        for seen in self._observed.values():
            for drops in seen.sets.values():
                drops.add_reader(name, program)

    def _kind(self, kind: int) -> KindPrograms:
        """The programs of a kind of what falls, made when they are first needed."""
        known = self._kinds.get(kind)
        if known is None:
            known = self._kinds[kind] = KindPrograms(self._ctx, self._shaders, kind, self._lists)
        return known

    @property
    def has_lists(self) -> bool:
        """Whether impacts are listed (compute) or kept by the drops themselves (feedback)."""
        return self._lists

    def sets(self, observer: int = 0) -> dict[int, DropSet]:
        """An observer's drops by container; for other passes, tests and statistics."""
        seen = self._observed.get(observer)
        return seen.sets if seen is not None else {}

    def impacts(self, observer: int = 0) -> ImpactList | None:
        """An observer's impacts; None with feedback, where each drop keeps its own."""
        seen = self._observed.get(observer)
        return seen.impacts if seen is not None else None

    def update(self, view: ViewData, sheltered: bool = False) -> int:
        """Moves the drops of every container in `view`; returns how many.

        With `sheltered`, what they meet is in the collision heightmap at SHELTER_UNIT.
        """
        self._draws += 1
        moved = 0
        seen = self._observed.get(view.key)
        if seen is None:
            seen = self._observed[view.key] = _Observed({}, None)
        if self._lists:
            most = max((len(each.births) for each in view.containers), default=0)
            seen.impacts = list_for(self._ctx, most, seen.impacts, self._capacity)
        if seen.impacts is not None:
            self._times.follow(seen.impacts, view.frame.time)
            if sheltered:
                seen.impacts.begin_frame()
        self._step_block.bind()
        self._draw_block.bind()
        self._steady = self._air.use(view)
        for container in view.containers:
            drops = self._drops(seen, container)
            drops.last_used = self._draws
            placing = (container.axis, container.shape)
            if view.dt <= 0.0 and drops.placed == placing:
                continue
            self.fill_container(container, view)
            moved += self._move(drops, container, view, seen.impacts, sheltered)
            drops.placed = placing
        if len(seen.sets) > len(view.containers):
            alive = set(view.frame.areas["key"].tolist())
            for key in [k for k in seen.sets if k >> 2 not in alive]:
                seen.sets.pop(key).release()
        self._forget()
        return moved

    def _move(
        self,
        drops: DropSet,
        container: ContainerData,
        view: ViewData,
        impacts: ImpactList | None,
        sheltered: bool,
    ) -> int:
        count = drops_used(container, drops)
        drops.steps += 1
        before = drops.placed if drops.placed is not None else (container.axis, container.shape)
        seed = self._seed * 0x9E3779B1 + container.word * 0x85EBCA6B + drops.steps
        self._step_block.put(
            STEP,
            *(*before[0], *before[1]),
            *(*container.axis, *container.shape),
            *container.law,
            view.dt,
            seed & 0xFFFFFFFF,
            count,
            0 if drops.placed is None else drops.alive,
            in_epoch(view.frame.time),
            impacts.capacity if impacts is not None else 0,
        )
        self._step_block.upload()
        kind, step = self._kind(container.kind), step_name(sheltered, self._steady)
        kind.use(container, view)
        if self._lists:
            drops.births.bind_to_storage_buffer(0)
            drops.states[0].bind_to_storage_buffer(1)
            lists = impacts if sheltered and container.kind != SNOW else None
            if lists is not None:
                lists.begin_step()
            kind.steps[step].run((count + GROUP - 1) // GROUP)
            if lists is not None:
                self._order.after(_LISTED)
                lists.find(self._find)
            self._order.after(_MOVED)
        else:
            following = 1 - drops.current
            drops.array(step).transform(drops.states[following], moderngl.POINTS, vertices=count)
            drops.current = following
        drops.alive = count
        return count

    def look(self, view: ViewData) -> None:
        """List what is in view, before `draw`; with compute that is part of it.

        Apart, because transform feedback counts among the primitives that are drawn.
        """
        if self._lists:
            return
        self.bind_blocks(view)
        for drops, kind, count in self._shown(view):
            found = self._list(drops, kind)
            if isinstance(found, FeedbackList):
                found.look(kind.cull, count)

    def draw(self, view: ViewData) -> None:
        """Draws the streaks into the bound framebuffer."""
        self.bind_blocks(view)
        lit = len(view.frame.lights) > 0
        for drops, kind, count in self._shown(view):
            self._list(drops, kind).draw(kind.cull, count, lit)

    def _shown(self, view: ViewData) -> Iterator[tuple[DropSet, KindPrograms, int]]:
        """One container after the other, its blocks in place; how many of its drops there are."""
        seen = self._observed[view.key]
        for container in view.containers:
            drops, kind = seen.sets[container.key], self._kind(container.kind)
            self.fill_container(container, view)
            kind.use(container, view, drawing=True)
            yield drops, kind, min(drops_used(container, drops), drops.alive)

    def _list(self, drops: DropSet, kind: KindPrograms) -> StreakList | FeedbackList:
        """Of those in view, for a set of drops."""
        if drops.streaks is None and self._lists:
            drops.streaks = StreakList(self._ctx, drops, kind.draw, kind.far, self._order)
        elif drops.streaks is None:
            if self._lister is None:
                self._lister = Lister(self._ctx)
            drops.streaks = FeedbackList(self._lister, drops, kind.draw, kind.far)
        return drops.streaks

    def bind_blocks(self, view: ViewData) -> None:
        """Bind what drawing reads: the block of containers, and the air's."""
        self._draw_block.bind()
        self._air.use(view)

    def fill_container(self, container: ContainerData, view: ViewData) -> None:
        """Upload the block RainDraw of one container, unless it is the one that is there."""
        filled = self._filled
        if filled is not None and filled[0] is container and filled[1] is view:
            return
        self._filled = (container, view)
        look, snow = view.frame.look, view.frame.flakes
        # A far drop is drawn larger, not fainter: of a shaft it is the grain. A flake, which is no
        # hair but a disc, less so, or its shaft becomes a swarm of dots.
        scale = container.size_scale
        if container.kind == SNOW:
            scale = math.sqrt(scale)
            density = snow.density
            shown = (snow.size_maximum, scale, snow.size, snow.opacity)
        else:
            density = look.density
            shown = (look.size_maximum, scale, look.width, look.opacity)
        density *= min(scale**2, 16.0) * container.cover
        fade = 1.0 / max(_COUNT_FADE * container.count, 1.0)
        self._draw_block.put(
            DRAW,
            *(*container.axis, *container.shape),
            *(*container.area_axis, *container.area_shape),
            *container.law,
            *(container.load, container.count, fade, density),
            *shown,
            *container.dry,
        )
        self._draw_block.upload()

    def _drops(self, seen: _Observed, container: ContainerData) -> DropSet:
        drops = seen.sets.get(container.key)
        if drops is not None and drops.capacity != len(container.births):
            drops.release()
            drops = None
        if drops is None:
            programs = self._kind(container.kind).readers | self._readers
            drops = DropSet(self._ctx, container.births, programs, not self._lists)
            seen.sets[container.key] = drops
        return drops

    def _forget(self) -> None:
        if self._draws % 60:
            return
        oldest = self._draws - _KEPT_DRAWS
        for observer, seen in list(self._observed.items()):
            for key in [k for k, drops in seen.sets.items() if drops.last_used < oldest]:
                seen.sets.pop(key).release()
            if not seen.sets:
                self.forget(observer)

    def forget(self, observer: int) -> None:
        """Give back the drops and impacts of an observer who is gone."""
        seen = self._observed.pop(observer, None)
        if seen is None:
            return
        for drops in seen.sets.values():
            drops.release()
        if seen.impacts is not None:
            seen.impacts.release()

    def reseed(self, seed: int) -> None:
        """Other chances from here on, and other drops."""
        self._seed = seed
        for observer in list(self._observed):
            self.forget(observer)

    def release(self) -> None:
        """Give every buffer back; twice does no harm."""
        for observer in list(self._observed):
            self.forget(observer)
        for kind in self._kinds.values():
            kind.release()
        if self._lister is not None:
            self._lister.release()
        self._draw_block.release()
        self._step_block.release()
        self._air.release()


def drops_used(container: ContainerData, drops: DropSet) -> int:
    """Drops of a set that are in use, the last one fading."""
    return min(int(container.count) + 1, drops.capacity)
