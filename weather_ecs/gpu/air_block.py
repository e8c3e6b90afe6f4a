"""The uniform block of the air's motion, which everything that drifts includes."""

from __future__ import annotations

import math
from typing import Any

import moderngl

from weather_ecs.frame import ViewData
from weather_ecs.gpu.blocks import BlockBuffer, UniformBlock
from weather_ecs.physics.turbulence import AirFlow, air_flow

AIR_FLOW = UniformBlock(
    "AirFlow",
    ("air_wind", "vec4"),  # m/s, at the reference height; 1 / that height above the ground, 1/m
    ("air_shape", "vec4"),  # exponent of the growth with height; m, world height of the ground
    ("air_gain", "vec4"),  # m/s, standard deviations of the octaves and of all; 0: no turbulence
    ("air_octave", "vec4", 3),  # phases along its axes in rad, wave number in 1/m
)


class AirBlock:
    """The block `AirFlow` of one view; see `shaders/turbulence.glsl`."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self._block = BlockBuffer(ctx, AIR_FLOW)
        self._view: ViewData | None = None
        self._steady = False
        self._air: tuple[Any, Any] = (None, None)  # wind and profile that the block is for

    def use(self, view: ViewData) -> bool:
        """Bring the block up to date with a view, and bind it; whether STEADY_AIR will do."""
        if view is not self._view:
            air = view.frame.wind, view.frame.profile
            # Steady air is the same however far it has gone.
            if not self._steady or air != self._air:
                flow = flow_of(view)
                fill_air(self._block, flow)
                self._block.upload()
                self._steady, self._air = is_steady(flow), air
            self._view = view
        self._block.bind()
        return self._steady

    def release(self) -> None:
        """Give the buffer back; twice does no harm."""
        self._block.release()


def is_steady(flow: AirFlow) -> bool:
    """Whether the air moves alike everywhere: no turbulence, and no wind that grows with height."""
    return not any(flow.gains) and (flow.exponent == 0.0 or not any(flow.wind))


def flow_of(view: ViewData) -> AirFlow:
    """The motion of the air that a view's drops feel."""
    it = view.frame.profile
    return air_flow(
        view.frame.wind,
        reference=it.reference,
        exponent=it.exponent,
        ground=it.ground,
        turbulence=it.turbulence,
        scale=it.scale,
        run=view.air_run,
    )


def fill_air(block: BlockBuffer, flow: AirFlow) -> None:
    """Write a flow into the block."""
    data = block.data
    data["air_wind"] = (*flow.wind, 1.0 / flow.reference)
    data["air_shape"] = (flow.exponent, flow.ground, 0.0, 0.0)
    data["air_gain"] = (*flow.gains, math.hypot(*flow.gains))
    data["air_octave"] = flow.octaves
