"""Frames, quality settings and cameras that the tests of the rain share; no OpenGL."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import Any

import numpy as np
from numpy.typing import NDArray

from tests.views import look_from, perspective
from weather_ecs.frame import AREA_DTYPE, LIGHT_DTYPE, FrameData
from weather_ecs.physics.camera import Camera, camera_from


def area(
    key: int = 0,
    center: tuple[float, float] = (0.0, 0.0),
    radii: tuple[float, float] = (60.0, 40.0),
    rain_rate: float = 25.0,
    heading: float = 0.0,
    soft_edge: float = 10.0,
    ceiling: float = 400.0,
) -> tuple[Any, ...]:
    """One row of `AREA_DTYPE`."""
    return (key, center, radii, heading, rain_rate, soft_edge, ceiling)


def frame(*areas: tuple[Any, ...], time: float = 0.0, **rest: Any) -> FrameData:
    """A frame with these areas; `rest` are fields of `FrameData`."""
    return FrameData(time=time, areas=np.array(list(areas), AREA_DTYPE), **rest)


def lights(*rows: tuple[Any, ...]) -> NDArray:
    """Point lights from (position, color, reach)."""
    return np.array(list(rows), LIGHT_DTYPE)


def quality(
    drops: int = 1000,
    containers: int = 4,
    budget: float = 1.0,
    veil: bool = True,
    map_size: int = 64,
) -> SimpleNamespace:
    """Quality settings, smaller than those that players choose."""
    return SimpleNamespace(
        drops=drops, containers=containers, budget=budget, veil=veil, heightmap_size=map_size
    )


def camera(
    position: tuple[float, float, float] = (0.0, 1.7, 0.0),
    heading: float = 0.0,
    pitch: float = 0.0,
    vertical: float = 60.0,
    aspect: float = 16 / 9,
    near: float = 0.1,
    far: float = 2000.0,
) -> Camera:
    """From a place along a heading, pitched up; `vertical` field of view in degrees."""
    found = camera_from(
        look_from(position, heading, pitch), perspective(vertical, aspect, near, far)
    )
    # Of its own, to be written to: `camera_from` gives out the same one again.
    return replace(found, view=found.view.copy(), projection=found.projection.copy())
