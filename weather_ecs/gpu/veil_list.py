"""The veils of a view as the block Veil holds them: those that are seen, most important first."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from weather_ecs.frame import FrameData, VeilData, ViewData
from weather_ecs.gpu.blocks import UniformBlock
from weather_ecs.gpu.flake_blocks import flake_light
from weather_ecs.gpu.flash import VEIL as VEIL_FLASH
from weather_ecs.gpu.flash import flash_of
from weather_ecs.gpu.view_block import clip_columns, cloud_light, encode, veil_light
from weather_ecs.physics.veil import longest_path

MOST = 24  # drawn
TOGETHER = 4  # in one go over the picture; also in shaders/veil.frag
LEAST = 1.0 / 255.0  # an optical depth that nobody sees
DARKER = 0.22  # share of its light that thick rain under a cloud lacks
BRIGHTEST_SNOW = 1.3  # of the light that a flake takes from the sky, what a veil of them shows
SHADED_SNOW = 1.35  # times as bright as rain under a cloud

VEIL = UniformBlock(
    "Veil",
    ("veil_rays", "vec4", 3),  # the ray in the picture's middle, and what it gains to the edges
    ("veil_frame", "vec4"),  # the rectangle that is drawn, -1 to 1
    ("veil_place", "vec4"),  # the depth it is drawn at, -1 to 1
    # World's (x, z) to the ellipse's axes, in shares of its radii.
    ("veil_turn", "vec4", TOGETHER),
    # In these from its centre to the camera; level of f of the full rate; slope of the diameters.
    ("veil_from", "vec4", TOGETHER),
    # Extinction in 1/m over the part of f that is the soft edge's; m up to the ceiling (z); 1/m, of
    # its soft top.
    ("veil_load", "vec4", TOGETHER),
    # m to which the drops show it, and 1 over that.
    ("veil_shown", "vec4", TOGETHER),
    # Encoded, its colour; the share of it that is lost where it is thick.
    ("veil_tint", "vec4", TOGETHER),
    # Its rays of rain: strength, place, and drift in shares of the radii for 1 m of fall.
    ("veil_curtain", "vec4", TOGETHER),
    # s, fall times of the drops that are missing; see rain_front.glsl.
    ("veil_dry", "vec4", TOGETHER),
)


Vector = tuple[float, float, float]


class Seen(NamedTuple):
    """A veil and what decides whether it is drawn."""

    veil: VeilData
    optical: float  # its greatest optical depth
    distance: float  # m, to its rim; 0 inside
    importance: float


def important(view: ViewData, veils: Sequence[VeilData]) -> list[Seen]:
    """Those that can be told from none, at most MOST, most important first."""
    x, _, z = view.position
    fog = view.frame.fog.extinction
    found = []
    for veil in veils:
        optical = veil.extinction * longest_path(veil.shape)
        distance = max(math.hypot(veil.axis[0] - x, veil.axis[1] - z) - veil.shape[0], 0.0)
        if optical > LEAST:
            seen = (1.0 - math.exp(-optical)) * math.exp(-fog * distance)
            size = veil.shape[0] / (veil.shape[0] + distance)
            found.append(Seen(veil, optical, distance, seen * size))
    found.sort(key=lambda each: -each.importance)
    return found[:MOST]


def rays(view: ViewData) -> NDArray:
    """(3, 3): the ray through the picture's middle, and what it gains to the right and upwards."""
    return np.array(_rays(view))


def _rays(view: ViewData) -> tuple[Vector, Vector, Vector]:
    """Of the matrix that takes directions to x, y and w of the picture, the inverse's columns."""
    m = clip_columns(view)
    x, y, w = m[0:12:4], m[1:12:4], m[3:12:4]
    middle, right, up = _cross(x, y), _cross(y, w), _cross(w, x)
    k = 1.0 / (x[0] * right[0] + x[1] * right[1] + x[2] * right[2])
    return _scaled(middle, k), _scaled(right, k), _scaled(up, k)


def _cross(a: Sequence[float], b: Sequence[float]) -> Vector:
    return a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]


def _scaled(a: Vector, k: float) -> Vector:
    return a[0] * k, a[1] * k, a[2] * k


def rectangle(view: ViewData, seen: Sequence[Seen]) -> tuple[float, float, float, float]:
    """The part of the picture where the veils are: left, bottom, right, top, in -1 to 1."""
    whole = (-1.0, -1.0, 1.0, 1.0)
    m = clip_columns(view)
    x, y, depth = m[0::4], m[1::4], m[3::4]
    falling = y[1] + depth[1]  # what a metre of height adds to the way from the lower edge
    if falling < 1e-3:
        return whole
    left, right, top = 1.0, -1.0, -1.0
    for each in seen:
        (cx, cz, c, s), (a, b, _), (_, ceiling) = each.veil.axis, each.veil.shape, each.veil.span
        a, b = 1.001 * a, 1.001 * b
        for u, w in ((-a, -b), (-a, b), (a, -b), (a, b)):
            px, pz = cx + u * c + w * s, cz - u * s + w * c
            high_x = x[0] * px + x[1] * ceiling + x[2] * pz + x[3]
            high_y = y[0] * px + y[1] * ceiling + y[2] * pz + y[3]
            high = depth[0] * px + depth[1] * ceiling + depth[2] * pz + depth[3]
            # The box's edge goes on falling where there is no ground, to the picture's lower edge.
            fall = (high_y + high) / falling
            low_x, low = high_x - fall * x[1], high - fall * depth[1]
            if high < 1e-3 or low < 1e-3:
                return whole
            left = min(left, high_x / high, low_x / low)
            right = max(right, high_x / high, low_x / low)
            top = max(top, high_y / high)
    return _within(left), -1.0, _within(right), _within(top)


def _within(place: float) -> float:
    return min(max(place, -1.0), 1.0)


def nearest(view: ViewData, each: Seen, frame: tuple[float, float, float, float]) -> float:
    """Depth, -1 to 1, before which nobody sees anything of a veil in this part of the picture."""
    left, bottom, right, top = frame
    (x, y, z), (right_x, right_y, right_z), (up_x, up_y, up_z) = _rays(view)
    inside = each.distance <= 0.0
    # Metres for one of depth, level ones from outside: convex over the picture, so greatest in a
    # corner.
    most = max(
        math.hypot(
            x + across * right_x + up * up_x,
            y + across * right_y + up * up_y if inside else 0.0,
            z + across * right_z + up * up_z,
        )
        for across, up in ((left, bottom), (left, top), (right, bottom), (right, top))
    )
    depth = (_unseen(each.veil) if inside else each.distance) / max(most, 1e-6)
    p = view.projection
    if p[3, 2] == 0.0 or depth < 1e-6:
        return -1.0
    return _within((-float(p[2, 2]) * depth + float(p[2, 3])) / depth)


def _unseen(veil: VeilData) -> float:
    """m from within a veil through which nothing is seen of it: its drops are, or are too few."""
    path = LEAST / max(veil.extinction * (1.0 + veil.ragged), 1e-9)
    # What the drops leave: t^2 / (2 shown), from there on t - shown / 2. See shaders/veil.frag.
    inner = math.sqrt(2.0 * veil.shown * path)
    return inner if inner < veil.shown else path + 0.5 * veil.shown


def fill(data: NDArray, view: ViewData, seen: Sequence[Seen]) -> None:
    """Write the block's part that depends on the veils; `data` is a block's record."""
    x, y, z = view.position
    flash = flash_of(view.frame, view.position)
    more = 0.0 if flash is None else VEIL_FLASH * flash.here
    data["veil_load"][len(seen) :, 0] = 0.0  # no rain
    for i, each in enumerate(seen):
        veil = each.veil
        (cx, cz, c, s), (a, b, inner) = veil.axis, veil.shape
        ox, oz = x - cx, z - cz
        data["veil_turn"][i] = (c / a, -s / a, s / b, c / b)
        data["veil_from"][i] = (
            (ox * c - oz * s) / a, (ox * s + oz * c) / b, inner, veil.slope
        )  # fmt: skip
        soft = 1.0 / veil.top if veil.top > 0.0 else 1e6
        strength = veil.extinction / (1.0 - inner)
        data["veil_load"][i] = (strength, 0.0, veil.span[1] - y, soft)
        shown = max(veil.shown, 1e-4)
        data["veil_shown"][i] = (shown, 1.0 / shown, 0.0, 0.0)
        data["veil_tint"][i, :3] = encode(color(view.frame, veil) + more)
        data["veil_tint"][i, 3] = DARKER * veil.cloud
        dx, dz = veil.drift
        drift = ((dx * c - dz * s) / a, (dx * s + dz * c) / b)
        data["veil_curtain"][i] = (veil.ragged, veil.phase, *drift)
        data["veil_dry"][i] = veil.dry


def color(frame: FrameData, veil: VeilData) -> NDArray:
    """Of a veil, linear RGB: rain has the light all round it; a cloud takes what is above."""
    sky, snow = frame.sky, veil.snow
    rain = veil_light(sky)
    if veil.cloud > 0.0:
        rain = (1.0 - veil.cloud) * rain + veil.cloud * cloud_light(sky)
    if snow <= 0.0:
        return np.asarray(rain)
    # Snow is white in the same light; under a cloud in what comes from the sides. A single flake
    # may be shown brighter, so that it stands out; many are about as bright as what lights them.
    shown = min(frame.flakes.brightness, BRIGHTEST_SNOW)
    white = shown * flake_light(sky) + np.array(sky.sun_color) * 0.22
    white = (1.0 - veil.cloud) * white + veil.cloud * SHADED_SNOW * cloud_light(sky)
    return np.asarray((1.0 - snow) * rain + snow * white)
