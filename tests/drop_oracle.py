"""What the passes that move drops and flakes ought to have, in NumPy."""

from __future__ import annotations

from collections.abc import Iterable
from typing import NamedTuple

import moderngl
import numpy as np

from weather_ecs.frame import SNOW, ViewData
from weather_ecs.gpu.air_block import flow_of
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.heightmap import Footprint
from weather_ecs.gpu.rain_blocks import SHELTER
from weather_ecs.gpu.rain_pass import MOTION_UNIT, SHELTER_UNIT, RainPass
from weather_ecs.physics import rain_step
from weather_ecs.physics.ride import motion_bytes
from weather_ecs.physics.shelter import ShelterMap
from weather_ecs.physics.snow import SnowLaw
from weather_ecs.physics.snow_step import flakes_of

N = 3000  # drops of a container
SEED = 7


def states(rain: RainPass) -> dict[int, np.ndarray]:
    """Places and speeds, (n, 6), of what is alive in a pass, by container."""
    found = {}
    for key, drops in rain.sets().items():
        state = np.frombuffer(drops.states[drops.current].read(), np.float32)
        found[key] = state.reshape(-1, 6)[: drops.alive]
    return found


def oracle(views: Iterable[ViewData], shelter: ShelterMap | None = None) -> dict[int, np.ndarray]:
    """The same after these views, of a pass made with SEED."""
    sets: dict[int, dict] = {}
    for view in views:
        for c in view.containers:
            d = sets.setdefault(
                c.key,
                {"p": np.zeros((N, 3), np.float32), "v": np.zeros((N, 3), np.float32),
                 "placed": None, "alive": 0, "steps": 0},
            )  # fmt: skip
            placing = (c.axis, c.shape)
            if view.dt <= 0 and d["placed"] == placing:
                continue
            d["steps"] += 1
            count = min(int(c.count) + 1, N)
            seed = (SEED * 0x9E3779B1 + c.word * 0x85EBCA6B + d["steps"]) & 0xFFFFFFFF
            flakes = None
            if c.kind == SNOW:
                law = SnowLaw(*c.law, model=view.frame.flakes.model)
                flakes = flakes_of(law, view.frame.time, view.frame.flakes.flutter)
            step = rain_step.Step(
                *(d["placed"] or placing), *placing, (*view.frame.wind, view.dt), c.law, seed,
                0 if d["placed"] is None else d["alive"], flow_of(view), flakes,
            )  # fmt: skip
            p, v = rain_step.step(c.births[:count], d["p"][:count], d["v"][:count], step, shelter)
            d["p"][:count], d["v"][:count] = p, v
            d["alive"], d["placed"] = count, placing
    return {k: np.hstack([d["p"][: d["alive"]], d["v"][: d["alive"]]]) for k, d in sets.items()}


class SlabTextures(NamedTuple):
    """What shaders read of a slab."""

    depth: moderngl.Texture
    motion: moderngl.Texture

    def release(self) -> None:
        for texture in self:
            texture.release()


def slab_map(ctx: moderngl.Context) -> tuple[SlabTextures, BlockBuffer, ShelterMap]:
    """Ground that rises and a roof over a part of it, seen along a slanted fall."""
    size, half, slope = 128, 90.0, (0.4, 0.2)
    place = Footprint((0.0, 0.0), half, slope, -20.0, 40.0)
    side = (np.arange(size, dtype=np.float32) + 0.5) / size * 2 * half - half
    x, z = np.meshgrid(side, side)
    height = 0.02 * x
    height[(abs(x) < 25) & (abs(z) < 30)] = 5.0
    depth = ((40.0 - height) / 60.0).astype(np.float32)
    texture = ctx.depth_texture((size, size), depth)
    texture.compare_func = ""
    texture.filter = moderngl.NEAREST, moderngl.NEAREST
    texture.use(SHELTER_UNIT)
    at_rest = np.broadcast_to(motion_bytes(np.zeros(3)), (size, size, 3)).astype(np.uint8)
    motion = ctx.texture((size, size), 3, at_rest.tobytes(), alignment=1)
    motion.filter = moderngl.NEAREST, moderngl.NEAREST
    motion.use(MOTION_UNIT)
    block = BlockBuffer(ctx, SHELTER)
    block["shelter_matrix"] = place.matrix()
    block.data["shelter_size"] = (size, 60.0, 2 * half / size, 0.0)
    block.data["shelter_fall"] = (*slope, 0.0, 0.0)
    block.upload()
    block.bind()
    # The depth buffer may be stored in 24 bits; the oracle gets what the shader will read.
    stored = np.frombuffer(texture.read(), np.float32).reshape(size, size)
    known = ShelterMap(stored, place.matrix().astype(np.float32), 60.0, 2 * half / size, slope)
    return SlabTextures(texture, motion), block, known
