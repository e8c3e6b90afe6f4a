"""The sky's radiance by direction: what the shaders `sky_map.frag` and `sky.glsl` do.

Sums the tables of sun and moon, what covers them and the light of the night. The map is a square of
directions above the horizon: with r = sqrt(1 - sqrt(y)), so that half of it is below 15 degrees,
p = (x, z) r / (|x| + |z|), and its axes are p_x + p_z and p_x - p_z, each -1 to 1.
"""

from __future__ import annotations

from typing import Protocol

import numpy as np
from numpy.typing import NDArray

from weather_ecs.physics.atmosphere import haze_phase
from weather_ecs.physics.checks import FloatArray
from weather_ecs.physics.daylight import shifted
from weather_ecs.physics.haze import haze_left

SIZE = 128  # of the map
SHOULDER = 0.4  # of what a picture shows, from where on it is bent below 1


class Lights(Protocol):
    """Of `frame.AtmosphereData`, what the sky's radiance needs."""

    @property
    def sun_direction(self) -> tuple[float, float, float]: ...
    @property
    def moon_direction(self) -> tuple[float, float, float]: ...
    @property
    def sun_air(self) -> NDArray: ...
    @property
    def sun_haze(self) -> NDArray: ...
    @property
    def moon_air(self) -> NDArray: ...
    @property
    def moon_haze(self) -> NDArray: ...
    @property
    def sun_scale(self) -> NDArray: ...
    @property
    def moon_scale(self) -> NDArray: ...
    @property
    def overcast_light(self) -> NDArray: ...
    @property
    def night_light(self) -> NDArray: ...
    @property
    def haze_light(self) -> NDArray: ...
    @property
    def haze_depth(self) -> float: ...
    @property
    def ground_light(self) -> NDArray: ...
    @property
    def shift(self) -> float: ...


def radiance(lights: Lights, directions: FloatArray) -> FloatArray:
    """Linear RGB of the sky along unit directions (..., 3), as it is shown; level below 0."""
    up = np.maximum(directions[..., 1], 0.0)
    light = lights.sun_scale * _source(
        lights.sun_air, lights.sun_haze, directions, up, np.array(lights.sun_direction)
    )
    light = light + lights.moon_scale * _source(
        lights.moon_air, lights.moon_haze, directions, up, np.array(lights.moon_direction)
    )
    light += lights.overcast_light * ((1.0 + 2.0 * up) / 3.0)[..., None]
    light += lights.night_light * (1.0 + 0.8 * (1.0 - up) ** 3)[..., None]
    left = haze_left(lights.haze_depth, up)[..., None]
    light = lights.haze_light + left * (light - lights.haze_light)
    return shifted(light, lights.shift)


def with_ground(lights: Lights, directions: FloatArray) -> FloatArray:
    """The same, and below the horizon a haze over the ground (`weather_sky` in sky.glsl)."""
    sky = np.exp(40.0 * np.minimum(directions[..., 1], 0.0))[..., None]
    return lights.ground_light + sky * (radiance(lights, directions) - lights.ground_light)


def shown(linear: FloatArray) -> FloatArray:
    """What a picture shows of linear light: a bend below 1, then a power (`sky_show.glsl`)."""
    over = 1.0 + np.maximum(linear - SHOULDER, 0.0) * (0.5 / (1.0 - SHOULDER))
    bent = np.where(linear > SHOULDER, 1.0 - (1.0 - SHOULDER) / (over * over), linear)
    return np.asarray(np.maximum(bent, 0.0) ** (1.0 / 2.2))


def map_place(directions: FloatArray) -> FloatArray:
    """Where directions (..., 3) stand in the map, each axis -1 to 1, (..., 2)."""
    x, y, z = np.moveaxis(directions, -1, 0)
    r = np.sqrt(1.0 - np.sqrt(np.clip(y, 0.0, 1.0)))
    scale = r / np.maximum(np.abs(x) + np.abs(z), 1e-6)
    return np.stack([(x + z) * scale, (x - z) * scale], -1)


def map_direction(place: FloatArray) -> FloatArray:
    """The unit direction (..., 3) at a place of the map."""
    x, z = 0.5 * (place[..., 0] + place[..., 1]), 0.5 * (place[..., 0] - place[..., 1])
    r = np.abs(x) + np.abs(z)
    up = (1.0 - r * r) ** 2
    flat = np.sqrt(np.maximum(1.0 - up * up, 0.0)) / np.maximum(np.hypot(x, z), 1e-9)
    return np.stack([x * flat, up, z * flat], -1)


def _source(
    air: FloatArray, haze: FloatArray, directions: FloatArray, up: FloatArray, to: FloatArray
) -> FloatArray:
    """The clear sky of one source, from its tables (see `physics.atmosphere`)."""
    flat = directions[..., (0, 2)]
    long = np.maximum(np.linalg.norm(flat, axis=-1), 1e-6)
    cosine = np.clip(flat @ to[[0, 2]] / (long * max(float(np.hypot(to[0], to[2])), 1e-6)), -1, 1)
    u, v = np.sqrt(0.5 - 0.5 * cosine), np.sqrt(up)
    rows, columns = air.shape[:2]
    y, x = v * (rows - 1), u * (columns - 1)
    i = np.clip(y.astype(np.intp), 0, rows - 2)
    j = np.clip(x.astype(np.intp), 0, columns - 2)
    fy, fx = (y - i)[..., None], (x - j)[..., None]

    def at(table: FloatArray) -> FloatArray:
        upper = table[i, j] * (1.0 - fx) + table[i, j + 1] * fx
        lower = table[i + 1, j] * (1.0 - fx) + table[i + 1, j + 1] * fx
        return upper * (1.0 - fy) + lower * fy

    return at(air) + at(haze) * haze_phase(directions @ to)[..., None]
