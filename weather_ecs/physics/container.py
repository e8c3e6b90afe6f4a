"""Where the drops of one area stand for one observer: the rain container (seed 000, 3.2).

A container is half of an elliptical cylinder. Its own axes are forward (along the heading) and
lateral; the middle of its flat back is its centre. `place` is a pure function of the area, the
observer and the container before it: near rain (observer inside the area) is centred on the
observer, far rain stands at the nearest point of the perimeter, and at distance 0 both are equal.
"""

from __future__ import annotations

import math
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from weather_ecs.physics.camera import wrap_angle
from weather_ecs.physics.ellipse_point import line_crossings, nearest_point
from weather_ecs.physics.lod import own_reach, radial_positions, rim_fade, size_factor, weight_shape

__all__ = [
    "Area",
    "Container",
    "ContainerSettings",
    "births",
    "own_reach",
    "place",
    "radial_positions",
    "rim_fade",
    "size_factor",
    "weight_shape",
]

# Beyond an azimuth of about 80 degrees no half cylinder that follows the view within its margin can
# hold it. Between these half-widths the drops are shared out to the rear half too, so that they are
# there when it comes into view.
_REAR_FROM, _REAR_FULL = math.radians(68.0), math.radians(82.0)
_REAR_RATE = 3.0  # 1/s, how fast the rear's share changes
_PLASTIC = 1.3247179572447460  # root of x^3 = x + 1
# The share of the near container that lies below the observer's eye.
_BELOW = 0.3
_UNDER = 0.5  # m, that the container reaches below the lowest surface in front of the observer
_DEEPEST = 30.0  # m, that it reaches below the eye at most
_DEEPER = 4.0  # m/s, how fast it comes to reach deeper, or less deep
# Far fit: how fast a fit may change, per second, so that turning the head does not shift the rain.
_FIT_RATE = 0.35


class Area(NamedTuple):
    """The rain area as the placing sees it; metres and radians."""

    center: tuple[float, float]
    radii: tuple[float, float]
    heading: float
    ceiling: float


@dataclass(frozen=True, slots=True)
class ContainerSettings:
    """Size and margin of the near container, metres."""

    reach: float = 40.0
    height: float = 24.0
    margin: float = 0.75


class Container(NamedTuple):
    """A placed container; metres, radians, world axes."""

    center: tuple[float, float]  # middle of the flat back, (x, z)
    heading: float  # of the forward axis
    reach: tuple[float, float]  # semi-axes, forward and lateral
    bottom: float
    height: float
    depth: float  # m, that it reaches below the eye, within the margin
    rear: float  # share of the drops that the omitted half has, where it is needed too; 0 to 0.5
    near: bool
    visible: bool
    distance: float  # from the observer to the area, 0 inside
    share: float  # of the drops that is used, 1 near, less with distance
    size_scale: float  # on top of Eq. 3, 1 near, more with distance
    anchor: tuple[float, float]  # the observer, or P, less the margin
    view_heading: float  # the heading that the view asked for last

    @property
    def whole(self) -> bool:
        """Whether the omitted half is needed too."""
        return self.rear > 0.0


def births(n: int, rng: np.random.Generator) -> NDArray[np.float32]:
    """Original records of n drops, (n, 4) float32: forward, lateral, own reach, size quantile.

    The first two are the original position in the container's own axes, as shares of its reach;
    their distances follow Eq. 2. The own reach is the radius of the half disc, as a share, that
    the drop keeps to: Eq. 2 is the even mixture of such discs, each filled evenly (see `lod`).

    Drops keep reach and size for good. Were these drawn one by one, the few large drops that carry
    the water would by chance be too many or too few at some distance, for ever. So the pairs
    follow the R2 sequence (Roberts 2018), whose first n points, for any n, fill the square evenly.
    """
    k = np.arange(n) + 0.5
    s = 1.0 - (rng.random() + k / _PLASTIC) % 1.0  # in (0, 1]
    d = s * np.sqrt(rng.random(n))
    angle = (rng.random(n) - 0.5) * math.pi
    record = np.empty((n, 4), np.float32)
    record[:, 0] = d * np.cos(angle)
    record[:, 1] = d * np.sin(angle)
    record[:, 2] = s
    record[:, 3] = (rng.random() + k / _PLASTIC**2) % 1.0
    return record


def place(
    area: Area,
    observer: tuple[float, float, float],
    view_heading: float,
    half_width: float,
    settings: ContainerSettings,
    previous: Container | None = None,
    dt: float = 0.0,
    floor: float | None = None,
) -> Container:
    """The container of `area` for an observer who looks along `view_heading`.

    `half_width` is the greatest azimuth in view to either side of the heading; `dt` the time in
    seconds since `previous`. A width of view of 180 degrees or more gets the whole cylinder.
    `floor`: world height of the lowest surface in front of the observer, where it is known.
    """
    x, y, z = observer
    reach, margin = settings.reach, settings.margin
    turned = _turned(view_heading, half_width, previous)
    inside, point, distance = _nearest(area, (x, z))
    target = (x, z) if inside else point
    anchor = _drag(previous.anchor if previous else target, target, margin)
    if inside:
        heading, axes, visible = turned, (reach, reach), True
    else:
        inward = math.atan2(-(point[1] - z), point[0] - x) if distance > 1e-9 else turned
        ease = _smooth(distance / reach)
        heading = wrap_angle(turned + wrap_angle(inward - turned) * ease)
        fit = _fit(area, (x, z), point, inward, view_heading, half_width)
        visible = fit is not None
        wanted = fit if fit is not None else (reach, reach)
        ease = _smooth(distance / (2.0 * reach))
        axes = (reach + (wanted[0] - reach) * ease, reach + (wanted[1] - reach) * ease)
        if previous is not None and not previous.near and previous.visible:
            axes = (
                _towards(previous.reach[0], axes[0], dt),
                _towards(previous.reach[1], axes[1], dt),
            )
    back = margin + 0.25
    center = (anchor[0] - back * math.cos(heading), anchor[1] + back * math.sin(heading))
    least = _BELOW * settings.height
    depth = least if floor is None else min(max(y - floor + _UNDER, least), _DEEPEST)
    bottom = y - depth
    if previous is not None:
        change = _DEEPER * dt
        depth = min(max(depth, previous.depth - change), previous.depth + change)
        bottom = y - depth
        kept = previous.bottom - (depth - previous.depth)
        if abs(kept - bottom) <= margin:
            bottom = kept
    top = max(area.ceiling - bottom, 1.0)
    height = min(settings.height - least + depth + 0.8 * distance, top)
    return Container(
        center=center,
        heading=heading,
        reach=axes,
        bottom=bottom,
        height=height,
        depth=depth,
        rear=_rear_share(half_width, previous, dt),
        near=inside,
        visible=visible,
        distance=distance,
        share=1.0 / (1.0 + distance / (6.0 * reach)),
        size_scale=1.0 + distance / reach,
        anchor=anchor,
        view_heading=turned,
    )


def _rear_share(half_width: float, previous: Container | None, dt: float) -> float:
    x = (half_width - _REAR_FROM) / (_REAR_FULL - _REAR_FROM)
    wanted = 0.5 * min(max(x, 0.0), 1.0)
    if previous is None:
        return wanted
    change = _REAR_RATE * dt
    return min(max(wanted, previous.rear - change), previous.rear + change)


def _turned(view_heading: float, half_width: float, previous: Container | None) -> float:
    """The heading to use: the one before, until the view's edge would leave the half cylinder."""
    if previous is None:
        return view_heading
    margin = max(0.5 * math.pi - half_width, 0.0)
    if abs(wrap_angle(view_heading - previous.view_heading)) > margin:
        return view_heading
    return previous.view_heading


def _nearest(area: Area, at: tuple[float, float]) -> tuple[bool, tuple[float, float], float]:
    """(inside?, nearest point of the perimeter, distance to the area)."""
    dx, dz = at[0] - area.center[0], at[1] - area.center[1]
    c, s = math.cos(area.heading), math.sin(area.heading)
    u, w = (dx * c - dz * s) / area.radii[0], (dx * s + dz * c) / area.radii[1]
    if u * u + w * w < 1.0:
        return True, at, 0.0
    point = nearest_point(at, area.center, area.radii, area.heading)
    return False, point, math.hypot(point[0] - at[0], point[1] - at[1])


def _drag(
    before: tuple[float, float], target: tuple[float, float], margin: float
) -> tuple[float, float]:
    """`before`, pulled after `target` as by a rope of the margin's length."""
    dx, dz = before[0] - target[0], before[1] - target[1]
    away = math.hypot(dx, dz)
    if away <= margin:
        return before
    return (target[0] + dx * margin / away, target[1] + dz * margin / away)


def _fit(
    area: Area,
    at: tuple[float, float],
    point: tuple[float, float],
    inward: float,
    view_heading: float,
    half_width: float,
) -> tuple[float, float] | None:
    """Depth and half-width, from `point`, of the part of the ellipse that is in view; None: none.

    The part lies between the frustum's two lateral lines: its farthest points are where these
    cut the ellipse, or the ellipse's own extremes where they lie between the lines.
    """
    n = (math.cos(inward), -math.sin(inward))
    t = (-n[1], n[0])
    candidates = [point]
    half = half_width + math.radians(3.0)
    if half < 0.5 * math.pi:
        for side in (-half, half):
            ray = (math.cos(view_heading + side), -math.sin(view_heading + side))
            for hit in line_crossings(at, ray, area.center, area.radii, area.heading):
                if (hit[0] - at[0]) * ray[0] + (hit[1] - at[1]) * ray[1] > 0.0:
                    candidates.append(hit)
        lines = candidates[1:]
        candidates = [*candidates, *_extremes(area, n, t)]
        candidates = [
            c
            for c in candidates
            if abs(wrap_angle(math.atan2(at[1] - c[1], c[0] - at[0]) - view_heading)) <= half
        ] + lines
    else:
        candidates.extend(_extremes(area, n, t))
    if not candidates:
        return None
    depth = max((c[0] - point[0]) * n[0] + (c[1] - point[1]) * n[1] for c in candidates)
    width = max(abs((c[0] - point[0]) * t[0] + (c[1] - point[1]) * t[1]) for c in candidates)
    # A container thinner than this would squeeze its drops into a sheet.
    floor = 0.5 * area.radii[1]
    return (max(depth, floor), max(width, floor))


def _extremes(
    area: Area, n: tuple[float, float], t: tuple[float, float]
) -> list[tuple[float, float]]:
    """The ellipse's farthest points along n and along +t and -t."""
    c, s = math.cos(area.heading), math.sin(area.heading)
    a, b = area.radii
    found = []
    for dx, dz in (n, t, (-t[0], -t[1])):
        u, w = (dx * c - dz * s) * a, (dx * s + dz * c) * b
        length = math.hypot(u, w)
        u, w = a * u / length, b * w / length
        found.append((area.center[0] + u * c + w * s, area.center[1] - u * s + w * c))
    return found


def _smooth(x: float) -> float:
    x = min(max(x, 0.0), 1.0)
    return x * x * (3.0 - 2.0 * x)


def _towards(before: float, wanted: float, dt: float) -> float:
    """`wanted`, reached at a limited rate."""
    limit = math.exp(_FIT_RATE * min(dt, 1.0))
    return min(max(wanted, before / limit), before * limit)
