"""Weathers with water in them: what the tests of the ripples share."""

from __future__ import annotations

from typing import Any

import numpy as np

from tests.weather_pictures import Stage
from weather_ecs.components import RainArea, RippleSurface
from weather_ecs.frame import RippleData
from weather_ecs.gpu.renderer import Renderer
from weather_ecs.gpu.ripple_grid import RippleGrid

ONTO: dict[str, Any] = {"position": (0.0, 1.7, 0.0), "heading": 0.0, "pitch": -0.5}  # along +x


def rain(rate: float = 60.0, center: tuple[float, float] = (0.0, 0.0)) -> RainArea:
    return RainArea(center, (60, 60), rate, soft_edge=1.0)


def renderer_of(made: Stage) -> Renderer:
    renderer = made.weather._renderer
    assert renderer is not None
    return renderer


def data_of(made: Stage, surface: RippleSurface) -> RippleData:
    made.weather._frame()
    data = made.weather._extract.ripples.find(surface)
    assert data is not None
    return data


def only_grid(made: Stage) -> RippleGrid:
    (grid,) = renderer_of(made).ripples.grids().values()
    return grid


def read(grid: RippleGrid, age: int = 0) -> np.ndarray:
    """Amplitudes now, or a step before, (rows, columns), mm."""
    data = np.frombuffer(grid.amplitudes[age].read(), np.float32)
    return data.reshape(grid.cells[1], grid.cells[0])
