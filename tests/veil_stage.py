"""A veil on its own, drawn and by the oracle."""

from __future__ import annotations

import math
from dataclasses import replace
from typing import Any

import moderngl
import numpy as np

from tests.rain_frames import frame
from weather_ecs.frame import FogData, SkyLight, VeilData, ViewData
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.rain_blocks import RAIN_VIEW
from weather_ecs.gpu.shader_loader import ShaderLoader
from weather_ecs.gpu.veil_pass import VeilPass
from weather_ecs.gpu.view_block import encode, fill_view, veil_light
from weather_ecs.physics import veil
from weather_ecs.physics.camera import Camera

SIZE = (96, 54)

GRAIN = 0.5 * 1.6 / 255.0


def axis_of(center: tuple[float, float], heading: float) -> tuple[float, float, float, float]:
    return (*center, math.cos(heading), math.sin(heading))


# The shader


CLEAR = FogData(extinction=0.0)


def only(at: Camera, data: VeilData, fog: FogData = CLEAR) -> ViewData:
    """A view in which there is this veil and nothing else."""
    seen = frame(fog=fog)
    return ViewData(seen, 0, at.view, at.projection, at.position, (0.0, 0.0, 0.0), 0.0, (), (data,))


class Stage:
    """Draws veils into a float target and keeps the depth that cuts them."""

    def __init__(self, ctx: moderngl.Context, size: tuple[int, int] = SIZE) -> None:
        self.ctx, self.size = ctx, size
        self.shaders = ShaderLoader(ctx)
        self.veils = VeilPass(ctx, self.shaders)
        self.block = BlockBuffer(ctx, RAIN_VIEW)
        self.color = ctx.texture((160, 90), 4, dtype="f4")
        self.target = ctx.framebuffer([self.color])

    def draw(
        self, view: ViewData, depth: np.ndarray | None = None, origin: tuple[int, int] = (0, 0)
    ) -> np.ndarray:
        """Colour and opacity (rows from below, columns, 4); 0 where nothing was drawn."""
        width, height = self.size
        stored = np.ones((height, width), np.float32) if depth is None else depth
        texture = self.ctx.depth_texture(self.size, np.ascontiguousarray(stored, np.float32))
        texture.compare_func = ""
        texture.filter = moderngl.NEAREST, moderngl.NEAREST
        self.target.use()
        self.target.clear()
        self.target.viewport = (*origin, width, height)
        fill_view(self.block, view, (*origin, width, height))
        self.block.upload()
        self.block.bind()
        self.ctx.enable_only(moderngl.NOTHING)
        self.veils.draw(view, view.veils, texture)
        self.target.viewport = (0, 0, 160, 90)
        pixels = np.frombuffer(self.target.read(components=4, dtype="f4"), np.float32)
        texture.release()
        x, y = origin
        return pixels.reshape(90, 160, 4)[y : y + height, x : x + width]

    def release(self) -> None:
        for thing in (self.target, self.color, self.block, self.veils, self.shaders):
            thing.release()


def rays_of(at: Camera, size: tuple[int, int] = SIZE) -> np.ndarray:
    """Rays through the middles of the pixels, (height, width, 3), 1 long along forward."""
    width, height = size
    x = (np.arange(width) + 0.5) / width * 2.0 - 1.0
    y = (np.arange(height) + 0.5) / height * 2.0 - 1.0
    p = at.projection
    ex, ey = np.meshgrid((x + p[0, 2]) / p[0, 0], (y + p[1, 2]) / p[1, 1])
    return np.stack([ex, ey, -np.ones_like(ex)], axis=-1) @ at.view[:3, :3]


def oracle(at: Camera, data: VeilData, end: Any = math.inf) -> np.ndarray:
    """Opacity of every pixel."""
    path = veil.rain_path(
        at.position, rays_of(at), end, data.axis, data.shape, data.span[1], data.shown,
        data.dry, (data.slope / 4.1) ** (-1.0 / 0.21),
    )  # fmt: skip
    curtain = veil.curtain_share(
        at.position, rays_of(at), end, data.axis, data.shape, data.span[1], data.shown,
        data.top, data.ragged, data.phase, data.drift,
    )  # fmt: skip
    return veil.opacity(path * curtain, data.extinction)


def assert_same(found: np.ndarray, expected: np.ndarray, atol: float = 2e-3) -> None:
    """The oracle's opacity, but for what is too faint to be drawn; colour where there is any."""
    alpha = found[..., 3]
    assert np.isfinite(found).all()
    assert np.abs(alpha - np.where(expected < 0.002, 0.0, expected)).max() <= atol + 0.002
    drawn = expected > 0.003 + atol
    assert np.abs(alpha - expected)[drawn].max(initial=0.0) <= atol
    light = encode(veil_light(SkyLight()))
    off = np.abs(found[..., :3] - light).max(axis=2) * np.maximum(expected, 0.05)
    assert off[drawn].max(initial=0.0) <= GRAIN * 1.1


def shaft(**changes: Any) -> VeilData:
    """A veil 150 m off, straight along -z, thick enough to be measured.

    It reaches so far down because in these scenes no ground ends what is seen below the horizon.
    """
    shape = (70.0, 45.0, 0.5)
    whole = VeilData(axis_of((0.0, -150.0), 0.4), shape, (-3e4, 200.0), 0.02, 0.0)
    return replace(whole, **changes)


HERE = (0.0, 1.7, 0.0)
