"""A flag pole by the cabin, in world coordinates."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from . import layout, palette
from .mesh import PLAIN, Builder
from .terrain import Terrain

TALL = 6.6  # m, of the pole
SIZE = (1.9, 1.15)  # m, of the cloth along and down
# Linear RGB, from the top.
BANDS = ((0.03, 0.16, 0.17), (0.03, 0.16, 0.17), (0.72, 0.66, 0.50), (0.50, 0.20, 0.03))
SEEN = 260.0  # m from the camera


def pole(build: Builder, x: float, ground: float, z: float) -> None:
    """A tapering pole with a knob."""
    foot, up = np.array([x, ground, z]), np.array([0.0, 1.0, 0.0])
    build.tube(
        foot - up * 0.4, foot + up * TALL, (0.055, 0.03), palette.TRIM, sides=8, material=PLAIN
    )
    build.tube(
        foot + up * TALL, foot + up * (TALL + 0.1), (0.06, 0.03), palette.IRON, sides=8,
        caps=True, material=PLAIN,
    )  # fmt: skip


def hoist(terrain: Terrain) -> NDArray:
    """(3,) m, the upper corner of the cloth at the pole."""
    x, z = layout.FLAG
    return np.array([x, terrain.height(x, z) + TALL - 0.12, z])
