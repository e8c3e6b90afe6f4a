"""The light and air a scene is drawn in."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field
from typing import Any, Protocol

Color = tuple[float, float, float]  # linear RGB
# (center (x, z) m, radii (a, b) m, heading rad, rain rate mm/h, ceiling m)
RainPatch = tuple[tuple[float, float], tuple[float, float], float, float, float]


class Ripples(Protocol):
    """Rings on water, for a program that includes ripple_sample.glsl."""

    def use(self, program: Any, unit: int) -> None:
        """Bind them."""


class Water(Protocol):
    """A map of the weather's, such as water on the ground, for a program that includes its GLSL."""

    def use(self, program: Any, unit: int) -> None:
        """Bind it."""


class Air(Protocol):
    """The weather's air, for a program that includes weather.glsl."""

    def use(self, program: Any) -> None:
        """Bind it."""


@dataclass
class Environment:
    """What the game tells the renderer each frame; the defaults are a late afternoon."""

    sun_direction: Color = (-0.66, 0.42, 0.62)  # towards the sun; need not be unit
    sun_color: Color = (1.0, 0.86, 0.66)
    zenith_color: Color = (0.20, 0.32, 0.52)
    horizon_color: Color = (0.62, 0.68, 0.74)
    ground_color: Color = (0.19, 0.18, 0.14)
    overcast: float = 0.35  # 0..1
    wetness: float = 0.0  # 0..1, everywhere; rain areas add their own
    fog_density: float = 1.0 / 1400.0  # 1/m
    fog_color: Color = (0.60, 0.66, 0.72)
    fog_overhead: float = 0.0  # optical depth straight up, of what hides the sky
    fog_rim: float = 8e-5  # square of the sine of the elevation below which that stays as it is
    rain_areas: Sequence[RainPatch] = field(default_factory=list)
    wind: tuple[float, float, float] = (2.0, 0.0, 0.6)  # m/s
    ripples: Ripples | None = None  # on the pond
    water: Water | None = None  # on the ground; without it rain areas and wetness wet it
    cloud_shadow: Water | None = None  # of clouds on the ground; for cloud_shadow.glsl
    air: Air | None = None  # of the weather while there is lightning, for its light
    snow: bool = False  # whether any may lie, as `water` knows
    actor_snow: tuple[float, float] = (0.0, 0.0)  # m, on the figure and on the sails
    sky: Water | None = None  # of the weather, by direction; without it a gradient
    draws_sky: bool = True  # here; else the weather draws it behind the scene
    lamps: float | None = None  # 0..1, how bright lamps burn; None: as the daylight asks

    @property
    def defines(self) -> tuple[str, ...]:
        """What shaders are made for: WATER on the ground, SNOWS, CLOUDED."""
        found = {"WATER": self.water, "SNOWS": self.water and self.snow}
        found["CLOUDED"] = self.cloud_shadow
        return tuple([name for name, there in found.items() if there])

    def lamp_strength(self) -> float:
        """How bright the lamps burn, 0..1."""
        if self.lamps is not None:
            return self.lamps
        bright = sum(self.horizon_color) / 3.0 + 0.6 * sum(self.sun_color) / 3.0
        return min(max(1.15 - 0.8 * bright, 0.3), 1.0)
