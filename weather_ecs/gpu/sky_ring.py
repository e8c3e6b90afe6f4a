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
LEVEL = -0.02  # sine of the elevation below which the shader lets a ring end
_FORMAT = "4f4 3f4"


class SkyRings:
    """Draws both, as light that is added to the picture."""

    def __init__(self, ctx: moderngl.Context, shaders: ShaderLoader) -> None:
        self._program = shaders.program(DRAW)
        self._halo = _Ring(ctx, self._program, HALO, halo(), HALO_LIGHT)
        self._bow = _Ring(ctx, self._program, BOW, rainbow(), BOW_LIGHT)
        self._brightest = float(rainbow().max())

    def draw_halo(self, data: AtmosphereData, sun: NDArray) -> None:
        """Round the sun; additive blending is the caller's. `sun`: its colour on a surface."""
        if data.halo <= 0.0 or data.sun_direction[1] < -0.35:
            return
        light = HALO_LIGHT * data.halo * sun
        self._draw(self._halo, data.sun_direction, light, np.ones(PARTS + 1))

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
        strength = bow_strength(rain_along(view.frame.areas, view.position, looks))
        strength = np.convolve(np.pad(strength, 2, mode="edge"), np.full(5, 0.2), mode="valid")
        light = BOW_LIGHT * data.rainbow * float(sun_light(data).max()) * self._brightest
        peak = float(strength.max())
        return strength if peak > 0.01 and peak * light > FAINTEST else None

    def draw_bow(self, data: AtmosphereData, sun: NDArray, strength: NDArray) -> None:
        """Opposite the sun, with the strengths of `rain`."""
        light = BOW_LIGHT * data.rainbow * sun
        self._draw(self._bow, tuple(np.negative(data.sun_direction)), light, strength)

    def _draw(
        self,
        ring: _Ring,
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
        ring.draw(float(axis[1]), float(up[1]), strength)

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        self._halo.release()
        self._bow.release()


class _Ring:
    """Triangles of a ring of colours, segment by segment, of which the seen ones are drawn."""

    def __init__(
        self,
        ctx: moderngl.Context,
        program: moderngl.Program,
        angles: NDArray,
        colors: NDArray,
        light: float,
    ) -> None:
        ends = np.minimum(np.arange(len(angles)), np.arange(len(angles))[::-1])
        colors = colors * np.minimum(ends / 24.0, 1.0)[:, None]
        kept = thinned(angles, colors, FAINTEST / light)
        radians = np.radians(angles[kept])[:, None]
        turn = np.arange(AROUND + 1) * (2.0 / AROUND)
        rows = np.zeros((len(kept), AROUND + 1, 7), np.float32)
        rows[..., 0], rows[..., 1], rows[..., 2] = np.cos(radians), np.sin(radians), turn
        rows[..., 4:] = colors[kept][:, None]
        # Between the bows there is a band without light.
        bright = colors[kept].max(axis=1) * light > FAINTEST
        bands = np.flatnonzero(bright[:-1] | bright[1:])
        j, i = np.meshgrid(np.arange(AROUND), bands, indexing="ij")
        first = i * (AROUND + 1) + j
        below = first + AROUND + 1
        corners = np.stack([first, first + 1, below, below, first + 1, below + 1], -1)
        self._along, self._across = np.cos(radians), np.sin(radians)
        self._a_segment = 6 * len(bands)
        self._vertices = ctx.buffer(rows.tobytes())
        self._indices = ctx.buffer(corners.astype("i4").tobytes())
        content = [(self._vertices, _FORMAT, "in_ring", "in_color")]
        self._array = ctx.vertex_array(program, content, self._indices)

    def draw(self, axis_up: float, across_up: float, strength: NDArray) -> None:
        """The segments over the horizon that shine: a triangle costs as much as 100 pixels.

        axis_up, across_up: of the axis, and of what is across it and up: how far they point up.
        """
        turn = np.arange(AROUND + 1) * (2.0 * math.pi / AROUND)
        high = self._along * axis_up + self._across * (np.sin(turn) * across_up)
        folded = np.minimum(turn, 2.0 * math.pi - turn) * (PARTS / math.pi)
        shines = np.interp(folded, np.arange(PARTS + 1), strength) > FAINTEST
        seen = (high > LEVEL).any(axis=0) & shines
        drawn = np.concatenate([[False], seen[:-1] | seen[1:], [False]])
        edges = np.flatnonzero(drawn[1:] != drawn[:-1])
        for first, last in edges.reshape(-1, 2).tolist():
            count = (last - first) * self._a_segment
            self._array.render(moderngl.TRIANGLES, count, first=first * self._a_segment)

    def release(self) -> None:
        """Give everything back; twice does no harm."""
        for thing in (self._array, self._vertices, self._indices):
            thing.release()


def thinned(angles: NDArray, colors: NDArray, least: float) -> list[int]:
    """Which of some angles are enough: straight lines between them miss no colour by `least`."""
    kept = [0]
    while kept[-1] < len(angles) - 1:
        first = last = kept[-1]
        for end in range(first + 1, len(angles)):
            part = slice(first, end + 1)
            share = (angles[part] - angles[first]) / (angles[end] - angles[first])
            line = colors[first] + (colors[end] - colors[first]) * share[:, None]
            if end > first + 1 and float(np.abs(line - colors[part]).max()) > least:
                break
            last = end
        kept.append(last)
    return kept


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
