"""`WeatherAir`: the weather's air, light and wind for a game's own shaders."""

from __future__ import annotations

from typing import Any

import moderngl
import numpy as np

from weather_ecs.frame import FrameData
from weather_ecs.gpu.blocks import BlockBuffer, UniformBlock
from weather_ecs.gpu.flash import HAZE, block_flash, flash_of
from weather_ecs.gpu.host_program import use_block
from weather_ecs.physics.optics import CLEAR, CONTRAST, falling_extinction
from weather_ecs.physics.phase import share_at, temperature_at

# Spelled out once more in shaders/weather.glsl, which games paste into their own shaders.
WEATHER_AIR = UniformBlock(
    "WeatherAir",
    ("weather_fog_color", "vec4"),
    ("weather_fog_law", "vec4"),
    ("weather_sun_direction", "vec4"),
    ("weather_sun_color", "vec4"),
    ("weather_zenith_color", "vec4"),
    ("weather_horizon_color", "vec4"),
    ("weather_ground_color", "vec4"),
    ("weather_wind_now", "vec4"),
    ("weather_wind_law", "vec4"),
    ("weather_now", "vec4"),
    ("weather_air", "vec4"),
    ("weather_flash_place", "vec4"),
    ("weather_flash_color", "vec4"),
)


class WeatherAir:
    """The air round one observer as it was when the weather was last asked for it.

    For programs whose shader includes `weather.glsl`. The same object for good.
    """

    def __init__(self, ctx: moderngl.Context) -> None:
        self._block = BlockBuffer(ctx, WEATHER_AIR)
        self._made_of: tuple[FrameData, float, float, tuple[float, float] | None] | None = None
        self._rain = self._snow = 0.0
        self._frame = FrameData()

    @property
    def extinction(self) -> float:
        """1/m, of the air and its fog: for scenery over which the weather draws rain and snow."""
        return self._frame.fog.extinction

    @property
    def extinction_with_rain(self) -> float:
        """1/m, with what falls at the observer."""
        return self.extinction + falling_extinction(self._rain, self._snow)

    @property
    def visibility(self) -> float:
        """m, through air, fog and what falls at the observer."""
        return CONTRAST / self.extinction_with_rain

    @property
    def color(self) -> tuple[float, float, float]:
        """Of the fog, linear RGB."""
        return self._frame.fog.color

    @property
    def depth(self) -> float:
        """m of fog overhead."""
        return self._frame.fog.depth

    def stale(
        self, frame: FrameData, y: float, rate: float, place: tuple[float, float] = (0.0, 0.0)
    ) -> bool:
        """Whether `fill` would change something."""
        known = self._made_of
        if known is None or known[0] is not frame:
            return True
        return known[1:] != (y, rate, place if len(frame.strikes) else None)

    def fill(
        self, frame: FrameData, y: float, rate: float, place: tuple[float, float] = (0.0, 0.0)
    ) -> None:
        """Take a frame over, with `rate` mm/h falling at an observer at the height `y`.

        place: (x, z) of the observer, m, for the light of lightning in the air there.
        """
        # Where one stands matters to nothing but the light of lightning.
        self._made_of = (frame, y, rate, place if len(frame.strikes) else None)
        self._frame = frame
        air, fog, sky, profile = frame.air, frame.fog, frame.sky, frame.profile
        self._snow = rate * share_at(temperature_at(air.temperature, y), air.humidity)
        self._rain = rate - self._snow
        data = self._block.data
        flash = flash_of(frame, (place[0], y, place[1]))
        color = np.array(fog.color)
        if flash is not None:
            color = color + HAZE * flash.here
        data["weather_flash_place"], data["weather_flash_color"] = block_flash(flash)
        data["weather_fog_color"] = (*color.tolist(), fog.extinction)
        thick = max(fog.extinction - CLEAR, 0.0)
        data["weather_fog_law"] = (self.extinction_with_rain, fog.depth, thick, 0.0)
        data["weather_sun_direction"] = (*sky.sun_direction, 0.0)
        data["weather_sun_color"] = (*sky.sun_color, 0.0)
        data["weather_zenith_color"] = (*sky.zenith_color, 0.0)
        data["weather_horizon_color"] = (*sky.horizon_color, 0.0)
        data["weather_ground_color"] = (*sky.ground_color, 0.0)
        data["weather_wind_now"] = (*frame.wind, profile.turbulence)
        data["weather_wind_law"] = (profile.reference, profile.exponent, profile.ground, 0.0)
        data["weather_now"] = (frame.time, self._rain, self._snow, 0.0)
        data["weather_air"] = (air.temperature, air.humidity, air.snow_share, 0.0)
        self._block.upload()

    def use(self, program: Any) -> None:
        """Bind the block to the binding it has, and point the program's at it, if it has one.

        The program is moderngl's, pyglet's, or the OpenGL name of one; InvalidValueError for
        anything else.
        """
        use_block(program, self._block)

    def release(self) -> None:
        """Give the buffer back; twice does no harm."""
        self._block.release()
