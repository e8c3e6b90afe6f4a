"""Fills the block RainView from a view: the camera and the light of one draw."""

from __future__ import annotations

import math
from functools import lru_cache

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import SkyLight, ViewData
from weather_ecs.gpu.blocks import BlockBuffer
from weather_ecs.gpu.flash import HAZE, VEIL, Flash, flash_of
from weather_ecs.gpu.impact_times import in_epoch
from weather_ecs.gpu.rain_blocks import MAX_LIGHTS, RAIN_VIEW
from weather_ecs.physics.vectors import product_columns

ENCODED = 1.0 / 2.2
TURNING = 2.0 / 0.0095  # s, after which every flake has come round; see shaders/flake.vert
LOG2_E = 1.0 / math.log(2.0)  # shaders raise 2 to a power, which costs them less than e

# What another camera or another time changes.
CAMERA = RAIN_VIEW.run(
    "view_projection",
    "camera_position",
    "camera_velocity",
    "camera_forward",
    "view_size",
    "view_origin",
    "view_depth",
    "view_time",
)
LIGHT_COUNT = RAIN_VIEW.run("light_count")


def encode(linear: NDArray) -> NDArray:
    """Linear light to what an 8-bit target shows; as shaders/encode.glsl."""
    return np.maximum(linear, 0.0) ** ENCODED


@lru_cache(maxsize=8)
def drop_light(sky: SkyLight) -> NDArray:
    """What a drop shows, linear RGB: mostly the sky, as it turns the picture upside down."""
    zenith, horizon = np.array(sky.zenith_color), np.array(sky.horizon_color)
    return 0.25 * zenith + 0.70 * horizon + 0.05 * np.array(sky.ground_color)


@lru_cache(maxsize=8)
def veil_light(sky: SkyLight) -> NDArray:
    """Colour of rain so deep that nothing shines through, linear RGB: light from all round."""
    zenith, horizon = np.array(sky.zenith_color), np.array(sky.horizon_color)
    return 0.45 * zenith + 0.40 * horizon + 0.15 * np.array(sky.ground_color)


@lru_cache(maxsize=8)
def cloud_light(sky: SkyLight) -> NDArray:
    """The same under a thick cloud, linear RGB: from the sides, and grey from above."""
    zenith, horizon = np.array(sky.zenith_color), np.array(sky.horizon_color)
    above = 0.25 * float(zenith @ (0.2126, 0.7152, 0.0722))
    return 0.36 * above + 0.22 * horizon + 0.10 * np.array(sky.ground_color)


@lru_cache(maxsize=8)
def _lights(sky: SkyLight) -> tuple[NDArray, NDArray]:
    """(what a drop shows, the veil's colour encoded): the light changes seldom."""
    return drop_light(sky), encode(veil_light(sky))


# The matrices that were multiplied last, and their product: several passes need a view's.
_latest: tuple[NDArray | None, NDArray | None, list[float]] = (None, None, [])


def clip_columns(view: ViewData) -> list[float]:
    """The matrix from the world to clip space, 16 numbers column by column."""
    global _latest
    p, v = view.projection, view.view
    before, seen, known = _latest  # at once: another thread may draw elsewhere
    if p is before and v is seen:
        return known
    found = product_columns(p.tolist(), v.tolist())
    if not (p.flags.writeable or v.flags.writeable):
        _latest = p, v, found
    return found


def fill_view(block: BlockBuffer, view: ViewData, viewport: tuple[int, int, int, int]) -> None:
    """Write camera and light of `view`, drawn into `viewport` (x, y, width, height in pixels)."""
    x, y, width, height = viewport
    seen, p = view.view.tolist(), view.projection.tolist()
    pixels = 0.5 * height * p[1][1]
    look, time = view.frame.look, view.frame.time
    (px, py, pz), (vx, vy, vz) = view.position, view.velocity
    speed = math.hypot(vx, vy, vz)
    slow = min(look.fastest / speed, 1.0) if speed > 0.0 else 1.0
    nx, ny, nz, _ = seen[2]
    block.put(
        CAMERA,
        *clip_columns(view),
        *(px, py, pz, pixels, vx * slow, vy * slow, vz * slow, look.exposure),
        *(-nx, -ny, -nz, 0.0, width, height, 0.0, 0.0, x, y, 0.0, 0.0),
        *(p[2][2], p[2][3], 0.0, 0.0),
        *(in_epoch(time), view.dt, time % TURNING, 0.0),
    )
    flash = flash_of(view.frame, view.position)
    # Light stays the same for many frames, but for lightning.
    light = (view.frame.sky, view.frame.fog, look.brightness) if flash is None else None
    if light is None or light != block.holds:
        block.holds = light
        _fill_light(block, view, flash)
    _fill_lamps(block, view)


def _fill_light(block: BlockBuffer, view: ViewData, flash: Flash | None) -> None:
    data, look, sky, fog = block.data, view.frame.look, view.frame.sky, view.frame.fog
    data["sun_direction"] = (*sky.sun_direction, 0.0)
    data["sun_color"] = (*sky.sun_color, 0.0)
    data["flash_color"] = 0.0
    drop, veil = _lights(sky)
    data["drop_color"][:3] = look.brightness * drop
    data["veil_color"][:3] = veil
    color = fog.color
    if flash is not None:
        way = flash.place - np.array(view.position)
        data["flash_direction"][:3] = way / max(float(np.linalg.norm(way)), 1e-6)
        data["flash_color"][:3] = flash.here
        data["veil_color"][:3] = encode(veil_light(sky) + VEIL * flash.here)
        color = (HAZE * flash.here + color).tolist()
    data["fog_color"] = (*color, fog.extinction * LOG2_E)
    data["fog_shown"] = (*[max(value, 0.0) ** ENCODED for value in color], fog.depth)


def _fill_lamps(block: BlockBuffer, view: ViewData) -> None:
    """The lights nearest to the camera; a light's reach is how far off it still counts."""
    lights = view.frame.lights
    count = len(lights)
    if count > MAX_LIGHTS:
        away = np.linalg.norm(lights["position"] - np.array(view.position), axis=1)
        lights = lights[np.argsort(away - lights["reach"], kind="stable")[:MAX_LIGHTS]]
        count = MAX_LIGHTS
    block.put(LIGHT_COUNT, count)
    if count:
        block.data["light_position"][:count, :3] = lights["position"]
        block.data["light_position"][:count, 3] = lights["reach"]
        block.data["light_color"][:count, :3] = lights["color"]
