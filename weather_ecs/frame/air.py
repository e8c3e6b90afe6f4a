"""The air as a frame has it: what falls in it, fog and wind."""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True, slots=True)
class AirData:
    """The air at the ground; see `components.Air` and `physics.phase`."""

    temperature: float = 15.0  # degrees Celsius
    humidity: float = 0.8  # 0 to 1, relative
    wet_bulb: float = 12.73  # degrees Celsius
    snow_share: float = 0.0  # of the water that falls, 0 rain to 1 snow; between: sleet


@dataclass(frozen=True, slots=True)
class FogData:
    """What the air takes from the view; see `components.Fog`."""

    extinction: float = 3.912 / 50_000.0  # 1/m, of the air and its fog; rain and snow are more
    color: tuple[float, float, float] = (0.64, 0.70, 0.77)  # linear RGB
    depth: float = 250.0  # m of it above the eye, before the sky
    draw: bool = False  # over the whole picture, for games whose shaders know no fog


@dataclass(frozen=True, slots=True)
class WindProfile:
    """How the wind varies in space; `FrameData.wind` is that at the reference height, now."""

    reference: float = 10.0  # m above the ground
    exponent: float = 0.0  # of the power law; 0: the same at every height
    ground: float = 0.0  # m, world height
    turbulence: float = 0.0  # m/s, standard deviation of one component
    scale: float = 6.0  # m, of the largest eddies
