"""Veils: the rain of an area beyond what its drops show."""

from __future__ import annotations

import math
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import replace

from weather_ecs.frame import (
    SNOW,
    AreaRow,
    ContainerData,
    FrameData,
    VeilData,
    plain_areas,
)
from weather_ecs.physics.container import Container
from weather_ecs.physics.front import SETTLED, steepness
from weather_ecs.systems.falls import falls, shown_distance, snow_shown_distance

_SOFT_TOP = 0.25  # of the height of a cloud's base: in it the rain below becomes dense
_RAGGED, _FAR = 0.8, 1500.0  # how uneven a shaft is; m from which on it is all of that
_CORE = 0.02  # of a far shaft, the level of f inside which its rain is full
_WITHIN = 0.6  # of its soft top, how far a far shaft reaches up into its cloud
_SHEAR = 0.4  # of the wind: a cloud goes with most of it, and so does what it drops
_SHADE_RATE = 4.0  # mm/h from which a shower has most of the shade of its cloud
_RAIN_SPEED, _SNOW_SPEED = 6.0, 1.5  # m/s, of what shows the slant of a shaft
_VAST = 500.0  # m, radius of an area of which half the look's factor is left
_OVER = 500.0  # m over a cloud's base from which nothing is seen of its rain
_BELOW = 300.0  # m under the container and the eye to which a veil hangs


def veils(
    frame: FrameData,
    placed: Mapping[int, Container],
    containers: Iterable[ContainerData],
    eye: float,
) -> Iterator[VeilData]:
    """Veils of the areas whose containers, by key, are in view; `eye` is the observer's height."""
    # Of a front half as high as a container is near flat ground.
    counts = {
        (c.area, c.kind): c.count * frame.look.height / c.shape[3]
        for c in containers
        if not c.key & 1
    }
    for row in plain_areas(frame.areas):
        container = placed.get(row.key)
        if container is None or not container.visible:
            continue
        if row.key not in frame.carried or eye - row.ceiling < _OVER:
            yield _veil(frame, row, container, counts, eye)


def _veil(
    frame: FrameData,
    row: AreaRow,
    container: Container,
    counts: Mapping[tuple[int, int], float],
    eye: float,
) -> VeilData:
    look, rate, key, ceiling = frame.look, row.rain_rate, row.key, row.ceiling
    a, b = row.radii
    soft = min(row.soft_edge, b)
    shown = lost = snow = 0.0
    near = max(0.0, 1.0 - container.distance / look.reach)
    for fall in falls(rate, frame.air, frame.flakes):
        count = round(counts.get((key, fall.kind), 0.0))
        if fall.kind == SNOW:
            snow = fall.part
            lost += fall.extinction * _look(frame.flakes.veil, b)
            if count and near:
                far = snow_shown_distance(look, frame.flakes, fall, count)
                shown += near * fall.part * far
        else:
            lost += fall.extinction * _look(look.veil, b)
            if count and near:
                far = shown_distance(look, round(fall.rate, 1), count)
                shown += near * fall.part * far
    veil = VeilData(
        axis=(*row.center, math.cos(row.heading), math.sin(row.heading)),
        shape=(a, b, min((1.0 - soft / b) ** 2, 0.9999)),
        span=(min(container.bottom, eye) - _BELOW, ceiling),
        dry=frame.fronts.get(key, SETTLED),
        slope=steepness(rate),
        extinction=lost,
        shown=shown,
        snow=snow,
    )
    if key not in frame.carried:
        return _from_outside(veil, frame, key, container.distance, rate)
    hidden = min(max((eye - ceiling) / _OVER, 0.0), 1.0)
    veil = replace(veil, extinction=(1.0 - hidden) * veil.extinction)
    return _under_cloud(veil, frame, key, container.distance)


def _look(factor: float, radius: float) -> float:
    """What is left of the look's factor on the extinction of an area whose smaller radius is in m.

    It makes up for what a screen shows less of, where a shower of a game's size would hardly be
    seen. Rain that reaches for kilometres is seen, and its visibility is to be what was reported.
    """
    return factor - max(factor - 1.0, 0.0) * radius**2 / (radius**2 + _VAST**2)


def _from_outside(
    veil: VeilData, frame: FrameData, key: int, distance: float, rate: float
) -> VeilData:
    """A game's own shower as one comes to it: a curtain with rays, darker for what it hangs from.

    distance: m, to its rim. Inside it is plain: light comes in from all sides.
    """
    far = min(distance / veil.shape[1], 1.0)
    if far <= 0.0:
        return veil
    far *= far * (3.0 - 2.0 * far)
    shade = far * (1.0 - math.exp(-rate / _SHADE_RATE))
    return replace(_with_rays(veil, frame, key, far), cloud=shade)


def _under_cloud(veil: VeilData, frame: FrameData, key: int, distance: float) -> VeilData:
    """Rain under a cloud: in its shade, soft where it leaves it, ragged from afar.

    distance: m, to its rim.
    """
    far = min(max(distance / _FAR, 0.0), 1.0)
    # A whole shaft needs nothing of the look's factor.
    look = (1.0 - veil.snow) * frame.look.veil + veil.snow * frame.flakes.veil
    look = _look(look, veil.shape[1])
    (a, b, inner), (bottom, ceiling) = veil.shape, veil.span
    top = _SOFT_TOP * max(ceiling, 0.0)
    return replace(
        _with_rays(veil, frame, key, far),
        extinction=veil.extinction * (1.0 + far * (1.0 / max(look, 1.0) - 1.0)),
        # From afar a shaft thins out to its sides, and begins within the cloud: no box hangs there.
        shape=(a, b, inner + far * (min(inner, _CORE) - inner)),
        span=(bottom, ceiling + far * _WITHIN * top),
        cloud=1.0,
        top=top,
    )


def _with_rays(veil: VeilData, frame: FrameData, key: int, far: float) -> VeilData:
    """Uneven, slanted by the wind. far: 0 to 1, how much of that is seen."""
    speed = _RAIN_SPEED + veil.snow * (_SNOW_SPEED - _RAIN_SPEED)
    return replace(
        veil,
        ragged=_RAGGED * far,
        phase=key * 0.618034 % 1.0 * 7.0,
        drift=(_SHEAR * frame.wind[0] / speed, _SHEAR * frame.wind[2] / speed),
    )
