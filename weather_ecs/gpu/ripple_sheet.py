"""Draws water surfaces that have nobody else to draw them."""

from __future__ import annotations

import itertools
import math
from dataclasses import replace

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import LIGHT_DTYPE, FrameData, RippleData, empty
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.rain_pass import SHELTER_UNIT
from weather_ecs.gpu.ripple_blocks import MAX_AREAS, RIPPLE_SHEET
from weather_ecs.gpu.ripple_map import RippleMap
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.physics.ripple import roughness

DRAW = ProgramKey(vertex="ripple_sheet.vert", fragment="ripple_sheet.frag")
DEPTH_UNIT, MAP_UNIT = 0, 2
_VERTICES = 12 * 12 * 6  # as in ripple_sheet.vert


class RippleSheet:
    """A level sheet per surface: sky by Fresnel's share, the water's colour by depth, the sun."""

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader) -> None:
        self._arrays: dict[tuple[bool, bool], moderngl.VertexArray] = {}
        for lit, sheltered in itertools.product((False, True), repeat=2):
            defines = ("LAMPS",) * lit + ("SHELTER",) * sheltered
            program = shaders.program(replace(DRAW, defines=defines))
            program["scene_depth"] = DEPTH_UNIT
            if sheltered:
                program["shelter_map"] = SHELTER_UNIT
            self._arrays[lit, sheltered] = ctx.vertex_array(program, [])
        self._sheltered = False
        self._light = np.ones(3)
        self._lamps = empty(LIGHT_DTYPE)
        self._block = BlockBuffer(ctx, RIPPLE_SHEET)

    def begin(self, frame: FrameData, depth: moderngl.Texture, sheltered: bool) -> None:
        """What all surfaces of a frame share; blending and the depth test are the caller's.

        `sheltered`: as for the rain.
        """
        self._sheltered = sheltered
        depth.use(DEPTH_UNIT)
        self._block.bind()
        data, sky = self._block.data, frame.sky
        zenith, horizon = np.array(sky.zenith_color), np.array(sky.horizon_color)
        data["sheet_zenith"][:3], data["sheet_horizon"][:3] = zenith, horizon
        sun = np.array(sky.sun_color) * (0.8 * max(sky.sun_direction[1], 0.0))
        self._light = 0.5 * (zenith + horizon) + sun
        self._lamps = frame.lights
        self._areas(frame.areas)

    def draw(self, surface: RippleData, ripples: RippleMap) -> None:
        """Draw one surface."""
        data = self._block.data
        x, y, z = surface.center
        half_u, half_w = 0.5 * surface.size[0], 0.5 * surface.size[1]
        data["sheet_frame"] = (x, z, math.cos(surface.heading), math.sin(surface.heading))
        data["sheet_body"] = (half_u, half_w, y, surface.ellipse)
        color = self._light * surface.color
        data["sheet_color"] = (*color.tolist(), 1.0 / surface.clarity)
        data["sheet_window"] = ripples.window
        self._block.upload()
        array = self._arrays[self._lamps_reach(surface), self._sheltered]
        ripples.use(array.program, MAP_UNIT)
        array.render(moderngl.TRIANGLES, vertices=_VERTICES)

    def _lamps_reach(self, surface: RippleData) -> bool:
        away = np.linalg.norm(self._lamps["position"] - surface.center, axis=1)
        return bool((away < self._lamps["reach"] + 0.5 * math.hypot(*surface.size)).any())

    def _areas(self, areas: NDArray) -> None:
        rows = areas[areas["rain_rate"] > 0.0]
        rows = rows[np.argsort(-rows["rain_rate"], kind="stable")[:MAX_AREAS]]
        data, count = self._block.data, len(rows)
        data["sheet_areas"] = count
        turn = rows["heading"]
        axes = np.column_stack([rows["center"], np.cos(turn), np.sin(turn)])
        data["sheet_area_axis"][:count] = axes
        soft = np.minimum(rows["soft_edge"], rows["radii"][:, 1])
        data["sheet_area_shape"][:count] = np.column_stack([rows["radii"], soft, rows["ceiling"]])
        data["sheet_area_rough"][:count, 0] = roughness(rows["rain_rate"])

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for array in self._arrays.values():
            array.release()
        self._block.release()
