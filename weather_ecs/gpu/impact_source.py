"""Impacts as vertices, the same for both backends: what splashes, ripples and gauges draw from."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace

import moderngl

from weather_ecs.frame import SNOW, ViewData
from weather_ecs.gpu.rain_pass import MOTION_UNIT, SHELTER_UNIT, RainPass, drops_used
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader


class ImpactReader:
    """A program whose vertex shader includes `impact.glsl`, and the impacts it is run over.

    Make it before the rain's first update. With the list (compute) it runs over the records; with
    feedback over the drops of every container, each of which keeps its own last impact.
    """

    def __init__(
        self, ctx: moderngl.Context, shaders: ShaderLoader, rain: RainPass, name: str,
        key: ProgramKey,
    ) -> None:  # fmt: skip
        self._ctx = ctx
        self._rain = rain
        self._name = name
        self._listed = rain.has_lists
        if self._listed:
            key = replace(key, defines=(*key.defines, "IMPACT_LIST"))
        self.program = shaders.program(key)
        for sampler, unit in (("shelter_map", SHELTER_UNIT), ("shelter_motion", MOTION_UNIT)):
            if sampler in self.program:
                self.program[sampler] = unit
        if not self._listed:
            rain.add_reader(name, self.program)
        self._arrays: dict[int, tuple[moderngl.Buffer, moderngl.VertexArray]] = {}

    def run(
        self,
        view: ViewData,
        render: Callable[[moderngl.VertexArray, int], None] | None = None,
    ) -> None:
        """Draw the impacts of a view as points into what is bound.

        `render(array, count)` replaces the plain draw, for instance to capture.
        """
        draw = render if render is not None else _points
        if self._listed:
            impacts = self._rain.impacts(view.key)
            if impacts is not None:
                draw(self._array(view.key, impacts.records), impacts.capacity)
            return
        sets = self._rain.sets(view.key)
        self._rain.bind_blocks(view)
        for container in view.containers:
            if container.kind == SNOW:
                continue  # snow lands silently
            drops = sets.get(container.key)
            if drops is not None and drops.alive:
                self._rain.fill_container(container, view)
                draw(drops.array(self._name), min(drops_used(container, drops), drops.alive))

    def _array(self, key: int, records: moderngl.Buffer) -> moderngl.VertexArray:
        known = self._arrays.get(key)
        if known is not None and known[0] is records:
            return known[1]
        if known is not None:
            known[1].release()
        array = impact_array(self._ctx, self.program, records)
        self._arrays[key] = (records, array)
        return array

    def forget(self, key: int) -> None:
        """Give back what belongs to an observer who is gone."""
        _, array = self._arrays.pop(key, (None, None))
        if array is not None:
            array.release()

    def release(self) -> None:
        """Give the vertex arrays back; twice does no harm."""
        for _, array in self._arrays.values():
            array.release()
        self._arrays.clear()


def impact_array(
    ctx: moderngl.Context,
    program: moderngl.Program,
    records: moderngl.Buffer,
    ids: moderngl.Buffer | None = None,
) -> moderngl.VertexArray:
    """The records of a list as vertices of a program made with IMPACT_LIST; those in `ids`."""
    names = [n if n in program else "" for n in ("in_hit", "in_surface", "in_fall")]
    layout = " ".join("4f" if name else "16x" for name in names)
    content = [(records, layout, *[name for name in names if name])]
    return ctx.vertex_array(program, content, index_buffer=ids)


def _points(array: moderngl.VertexArray, count: int) -> None:
    array.render(moderngl.POINTS, vertices=count)
