"""The programs that move and draw one kind of what falls: drops or flakes."""

from __future__ import annotations

from dataclasses import replace
from typing import Any

import moderngl

from weather_ecs.frame import SNOW, ContainerData, ViewData
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.feedback_list import CULL as FEEDBACK_CULL
from weather_ecs.gpu.feedback_list import CULL_APART, CULL_NAME, has_streams
from weather_ecs.gpu.flake_blocks import SNOW as SNOW_BLOCK
from weather_ecs.gpu.flake_blocks import fill_snow
from weather_ecs.gpu.flake_texture import flake_texture
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.gpu.streak_list import CULL

STREAK = ProgramKey(vertex="streak.vert", geometry="streak.geom", fragment="streak.frag")
FLAKE = ProgramKey(vertex="flake.vert", geometry="flake.geom", fragment="flake.frag")
FAR_FLAKE = replace(FLAKE, defines=("FAR",))
COMPUTE = ProgramKey(compute="rain_step.comp")
FEEDBACK = ProgramKey(vertex="rain_step.vert", varyings=("out_position", "out_velocity"))
SHELTER_UNIT = 1
MOTION_UNIT = 5  # velocities of what rain hits
PICTURES_UNIT = 0


def step_name(sheltered: bool, steady: bool) -> str:
    """Of the step with a collision heightmap or not, in air that moves alike everywhere or not."""
    return "sheltered " * sheltered + "steady " * steady + "step"


def by_lamps(shaders: ShaderLoader, key: ProgramKey) -> dict[bool, moderngl.Program]:
    """A program without lamps and one with them."""
    dark = replace(key, defines=(*key.defines, "NO_LAMPS"))
    return {False: shaders.program(dark), True: shaders.program(key)}


class KindPrograms:
    """Made when the first container of its kind comes; snow brings its pictures and its block."""

    def __init__(
        self, ctx: moderngl.Context, shaders: ShaderLoader, kind: int, compute: bool
    ) -> None:
        key, defines = (COMPUTE if compute else FEEDBACK), ("SNOW",) if kind == SNOW else ()
        self.steps: dict[str, Any] = {}
        for sheltered in (False, True):
            for steady in (False, True):
                more = ("SHELTER",) * sheltered + ("STEADY_AIR",) * steady
                program = shaders.program(replace(key, defines=(*defines, *more)))
                if "shelter_map" in program:
                    program["shelter_map"] = SHELTER_UNIT
                self.steps[step_name(sheltered, steady)] = program
        # By whether lamps shine on it.
        self.draw = by_lamps(shaders, FLAKE if kind == SNOW else STREAK)
        # Flakes of a few pixels are drawn without pictures, where they can be listed apart.
        apart = kind == SNOW and (compute or has_streams(ctx))
        self.far = by_lamps(shaders, FAR_FLAKE) if apart else None
        cull = CULL if compute else (CULL_APART if apart else FEEDBACK_CULL)
        self.cull: Any = shaders.program(replace(cull, defines=(*cull.defines, *defines)))
        # Those that read drops as vertices, by name.
        self.readers: dict[str, moderngl.Program] = {}
        if not compute:
            self.readers = {CULL_NAME: self.cull, **self.steps}
        self._block: BlockBuffer | None = None
        if kind == SNOW:
            self._block = BlockBuffer(ctx, SNOW_BLOCK)
            self._pictures = flake_texture(ctx)
            for program in self.draw.values():
                program["flake_pictures"] = PICTURES_UNIT

    def use(self, container: ContainerData, view: ViewData, drawing: bool = False) -> None:
        """Bind what the kind has of its own, for the step or for drawing."""
        if self._block is not None:
            fill_snow(self._block, container, view)
            self._block.upload()
            self._block.bind()
            if drawing:
                self._pictures.use(PICTURES_UNIT)

    def release(self) -> None:
        """Give back what is not the shader loader's; twice does no harm."""
        if self._block is not None:
            self._block.release()
            self._pictures.release()
            self._block = None
