"""The uniform block `Frame`: camera, light and rain areas of one frame, as frame.glsl has it."""

from __future__ import annotations

import math
from typing import Any

import moderngl
import numpy as np
from numpy.typing import ArrayLike, NDArray

from .breeze import PAST, Breeze
from .environment import Environment

AREAS = 4
BINDING = 30  # the game's own; hosts hand out low ones, the weather takes the topmost
FRAME_DTYPE = np.dtype(
    [
        ("view_projection", "f4", (4, 4)), ("shadow_matrix", "f4", (4, 4)),
        ("camera", "f4", 4), ("sun_direction", "f4", 4), ("sun_color", "f4", 4),
        ("zenith_color", "f4", 4), ("horizon_color", "f4", 4), ("ground_color", "f4", 4),
        ("fog_color", "f4", 4), ("fog_law", "f4", 4), ("wind", "f4", 4), ("drift", "f4", 4),
        ("gusts", "f4", (PAST // 4, 4)),
        ("area_shape", "f4", (AREAS, 4)), ("area_turn", "f4", (AREAS, 4)),
        ("area_cloud", "f4", (AREAS, 4)),
    ]
)  # fmt: skip


def as_matrix(values: Any) -> NDArray:
    """(4, 4) f8 acting on columns, of 16 column-major floats or a (4, 4) array."""
    m = np.asarray(values, "f8")
    return m.reshape(4, 4).T if m.ndim == 1 else m


def unit(vector: ArrayLike) -> NDArray:
    """(3,) f8 of length 1."""
    v = np.asarray(vector, "f8")
    return v / max(float(np.linalg.norm(v)), 1e-9)


class FrameBlock:
    """The block's buffer; written once a frame, once more for a second view of it."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.data = np.zeros(1, FRAME_DTYPE)
        self._breeze = Breeze()
        self.buffer = ctx.buffer(reserve=FRAME_DTYPE.itemsize, dynamic=True)

    def attach(self, *programs: moderngl.Program, name: str = "Frame") -> None:
        """Point the programs' block at this buffer's binding."""
        for program in programs:
            block = program.get(name, None)
            if block is not None:
                block.binding = BINDING  # type: ignore[union-attr]

    def camera(self, view: NDArray, projection: NDArray) -> NDArray:
        """Set the camera; returns its position, m."""
        row = self.data[0]
        row["view_projection"] = (projection @ view).T
        position = -view[:3, :3].T @ view[:3, 3]
        row["camera"][:3] = position
        return position

    def fill(self, time: float, environment: Environment, shadow_matrix: NDArray) -> None:
        """Set light, air and areas."""
        row, env = self.data[0], environment
        row["camera"][3] = time
        row["shadow_matrix"] = shadow_matrix.T
        row["sun_direction"] = (*unit(env.sun_direction), env.lamp_strength())
        row["sun_color"] = (*env.sun_color, env.wetness)
        row["zenith_color"] = (*env.zenith_color, env.overcast)
        row["horizon_color"] = (*env.horizon_color, env.fog_density)
        row["ground_color"] = (*env.ground_color, 0.0)
        breeze = self._breeze
        breeze.advance(time, env.wind)
        row["drift"] = (0.0, float(env.air is not None), 0.0, breeze.wave)
        row["wind"] = (*breeze.way, breeze.front, breeze.sway)
        row["gusts"] = breeze.past().reshape(-1, 4)
        areas = [a for a in env.rain_areas if a[3] > 0.0][:AREAS]
        row["fog_color"] = (*env.fog_color, len(areas))
        dense = 1.0 - math.exp(-4.0 * env.fog_overhead)
        row["fog_law"] = (env.fog_overhead, env.fog_rim, dense, 0.0)
        for k, (center, (a, b), heading, rate, ceiling) in enumerate(areas):
            strength = 1.0 - math.exp(-rate / 4.0)
            row["area_shape"][k] = (*center, 1.0 / a, 1.0 / b)
            turn = (math.cos(heading), math.sin(heading))
            row["area_turn"][k] = (*turn, 0.35 + 0.5 * strength, min(1.0, 0.45 + rate / 4.0))
            row["area_cloud"][k] = (ceiling, 0.12 + 0.36 * strength, 0.0, 0.0)

    def upload(self) -> None:
        """Send the block and bind it."""
        self.buffer.write(self.data.tobytes())
        self.buffer.bind_to_uniform_block(BINDING)

    def release(self) -> None:
        """Give the buffer back."""
        self.buffer.release()
