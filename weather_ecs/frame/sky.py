"""The sky and its lights as a frame has them."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

LIGHT_DTYPE = np.dtype(
    [
        ("position", "f8", 3),  # m
        ("color", "f8", 3),  # linear RGB times strength
        ("reach", "f8"),  # m, the distance at which it has faded to nothing
    ]
)

STRIKE_DTYPE = np.dtype(
    [
        ("number", "i8"),  # of the strike; only ever compared
        ("word", "i8"),  # that its shape follows from; see `physics.lightning_bolt`
        ("origin", "f8", 3),  # m
        ("target", "f8", 3),  # m
        ("place", "f8", 3),  # m, where its light comes from for what is below the clouds
        ("cloud_place", "f8", 3),  # m, and for the clouds
        ("age", "f8"),  # s
        ("light", "f8"),  # of it now, times the look's colour; 1: of a day, nearby
        ("leader", "f8"),  # 0 to 1: how far it has come
        ("ground", "?"),  # it comes down
        ("again", "?"),  # a later stroke: the branches are dark
    ]
)


@dataclass(frozen=True, slots=True)
class SkyLight:
    """Light of sun, sky and ground, linear RGB."""

    sun_direction: tuple[float, float, float] = (0.35, 0.8, 0.48)  # unit, towards the sun
    sun_color: tuple[float, float, float] = (1.0, 0.95, 0.86)
    zenith_color: tuple[float, float, float] = (0.36, 0.47, 0.62)
    horizon_color: tuple[float, float, float] = (0.68, 0.73, 0.78)
    ground_color: tuple[float, float, float] = (0.20, 0.20, 0.17)
    # Of the clouds, which have the sun for longer: see `physics.high_sun`. Without, as it is below.
    high_direction: tuple[float, float, float] | None = None
    high_colors: tuple[tuple[float, float, float], ...] = ()

    @property
    def cloud_direction(self) -> tuple[float, float, float]:
        """Unit, towards what lights the clouds."""
        return self.high_direction or self.sun_direction


@dataclass(frozen=True, slots=True, eq=False)
class AtmosphereData:
    """What the sky is drawn from; see `physics.sky_map`. Light is linear RGB, as it is shown."""

    sun_direction: tuple[float, float, float]  # unit, to where it is seen
    moon_direction: tuple[float, float, float]
    star_axes: NDArray  # (3, 3): world = axes @ equatorial
    sun_air: NDArray  # `physics.daylight.ClearSky` of the sun
    sun_haze: NDArray
    moon_air: NDArray  # and of the moon
    moon_haze: NDArray
    sun_scale: NDArray  # (3,), factor on the sun's clear sky
    moon_scale: NDArray
    overcast_light: NDArray  # (3,), at the zenith; a third of it at the horizon
    night_light: NDArray  # (3,), at the zenith
    haze_light: NDArray  # (3,), of haze that nothing is seen through
    haze_depth: float  # optical, straight up
    ground_light: NDArray  # (3,)
    shift: float  # 0 to 1, of the colours towards those of the night
    sun_disc: NDArray  # (3,)
    moon_disc: NDArray  # (3,)
    faintest: float  # magnitude of the faintest star that is seen
    stars: float  # factor on their light
    disc: float  # factor on the width of sun and moon
    halo: float  # 0 to 1
    rainbow: float  # factor
    draw: bool


@dataclass(frozen=True, slots=True)
class LightningLook:
    """Looks of lightning; see `components.Lightning`."""

    color: tuple[float, float, float] = (0.80, 0.88, 1.0)  # linear RGB
    width: float = 2.2  # m that the channel seems wide
    glow: float = 1.0  # factor on the air's glow round it
    branches: float = 1.0  # factor on their number
