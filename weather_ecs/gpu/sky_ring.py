"""Halo and rainbow: rings of light round the sun and round the point opposite it."""

from __future__ import annotations

import math

import moderngl
import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import AtmosphereData, ViewData
from weather_ecs.gpu.shader_loader import ProgramKey, ShaderLoader
from weather_ecs.physics.bows import BOW, HALO, halo, rainbow
from weather_ecs.physics.daylight import LUMINANCE
from weather_ecs.physics.rain_ahead import bow_strength, rain_along

DRAW = ProgramKey(vertex="sky_ring.vert", fragment="sky_ring.frag")
AROUND = 96  # segments of a ring
PARTS = 32  # of the half of it that is above
HALO_LIGHT, BOW_LIGHT = 0.15, 0.21  # at full strength, beside a sun of 1 and as it is encoded
FAINTEST = 0.5 / 255.0  # light that changes no pixel
_FORMAT = "4f4 3f4"


class SkyRings:
    """Draws both, as light that is added to the picture."""

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader) -> None:
        self._program = shaders.program(DRAW)
        self._halo = self._make(ctx, HALO[::3], halo()[::3])
        self._bow = self._make(ctx, BOW[::2], rainbow()[::2])
        self._brightest = float(rainbow().max())

    def _make(
        self, ctx: moderngl.Context, angles: NDArray, colors: NDArray
    ) -> tuple[moderngl.VertexArray, moderngl.Buffer, moderngl.Buffer]:
        turn = np.arange(AROUND + 1) * (2.0 / AROUND)
        rows = np.zeros((len(angles), AROUND + 1, 7), np.float32)
        radians = np.radians(angles)[:, None]
        rows[..., 0], rows[..., 1], rows[..., 2] = np.cos(radians), np.sin(radians), turn
        fade = np.minimum(np.arange(len(angles)), np.arange(len(angles))[::-1]) / 12.0
        rows[..., 4:] = (colors * np.minimum(fade, 1.0)[:, None])[:, None]
        i, j = np.meshgrid(np.arange(len(angles) - 1), np.arange(AROUND), indexing="ij")
        first = i * (AROUND + 1) + j
        below = first + AROUND + 1
        corners = np.stack([first, first + 1, below, below, first + 1, below + 1], -1)
        vertices, indices = ctx.buffer(rows.tobytes()), ctx.buffer(corners.astype("i4").tobytes())
        content = [(vertices, _FORMAT, "in_ring", "in_color")]
        array = ctx.vertex_array(self._program, content, indices)
        return array, vertices, indices

    def draw_halo(self, data: AtmosphereData, sun: NDArray) -> None:
        """Round the sun; additive blending is the caller's. `sun`: its colour on a surface."""
        if data.halo <= 0.0 or data.sun_direction[1] < -0.35:
            return
        light = HALO_LIGHT * data.halo * sun
        self._draw(self._halo[0], data.sun_direction, light, np.ones(PARTS + 1))

    def rain(self, view: ViewData, data: AtmosphereData) -> NDArray | None:
        """Strength of the bow from the right over its top to the left; None where there is none."""
        high = data.sun_direction[1]
        if data.rainbow <= 0.0 or not 0.0 < high < math.sin(math.radians(53.0)):
            return None
        if not len(view.frame.areas):
            return None
        axis = np.negative(data.sun_direction)
        right, up = _across(axis)
        turn = np.linspace(0.0, math.pi, PARTS + 1)[:, None]
        c, s = math.cos(math.radians(42.0)), math.sin(math.radians(42.0))
        looks = c * axis + s * (np.cos(turn) * right + np.sin(turn) * up)
        flat = looks[:, (0, 2)]
        flat /= np.maximum(np.linalg.norm(flat, axis=1, keepdims=True), 1e-6)
        x, _, z = view.position
        strength = bow_strength(rain_along(view.frame.areas, (x, z), flat))
        strength = np.convolve(np.pad(strength, 2, mode="edge"), np.full(5, 0.2), mode="valid")
        light = BOW_LIGHT * data.rainbow * float(sun_light(data).max()) * self._brightest
        peak = float(strength.max())
        return strength if peak > 0.01 and peak * light > FAINTEST else None

    def draw_bow(self, data: AtmosphereData, sun: NDArray, strength: NDArray) -> None:
        """Opposite the sun, with the strengths of `rain`."""
        light = BOW_LIGHT * data.rainbow * sun
        self._draw(self._bow[0], tuple(np.negative(data.sun_direction)), light, strength)

    def _draw(
        self,
        array: moderngl.VertexArray,
        axis: tuple[float, ...],
        light: NDArray,
        strength: NDArray,
    ) -> None:
        right, up = _across(np.array(axis))
        program = self._program
        program["ring_axis"] = axis
        program["ring_right"] = tuple(right)
        program["ring_up"] = tuple(up)
        program["ring_light"] = tuple(light)
        program["ring_strength"] = strength.astype(np.float32).tolist()
        array.render(moderngl.TRIANGLES)

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for thing in (*self._halo, *self._bow):
            thing.release()


def _across(axis: NDArray) -> tuple[NDArray, NDArray]:
    """Two unit vectors across an axis: one level, to the right, and one up."""
    x, _, z = axis
    long = math.hypot(x, z)
    right = np.array([-z / long, 0.0, x / long]) if long > 1e-6 else np.array([1.0, 0.0, 0.0])
    return right, np.cross(right, axis)


def sun_light(data: AtmosphereData) -> NDArray:
    """What the sun puts into a ring: its colour, 1 at most, fading as it sets."""
    color = data.sun_disc / max(float(data.sun_disc @ LUMINANCE), 1e-6)
    risen = min(max(data.sun_direction[1] * 20.0 + 0.3, 0.0), 1.0)
    return np.asarray(color * min(float(data.sun_disc @ LUMINANCE) / 15.0, 1.0) * risen)
