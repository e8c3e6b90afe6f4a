"""Rain and snow as a frame has them: areas and looks."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass
from types import MappingProxyType
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

AREA_DTYPE = np.dtype(
    [
        ("key", "i8"),  # stable for the life of the area; only ever compared
        ("center", "f8", 2),  # (x, z), m
        ("radii", "f8", 2),  # (a, b), m, a >= b > 0
        ("heading", "f8"),  # rad, counter-clockwise seen from above
        ("rain_rate", "f8"),  # mm/h
        ("soft_edge", "f8"),  # m, inside the ellipse
        ("ceiling", "f8"),  # m, world height
    ]
)

# The same without arrays in it, which numpy turns into lists one by one.
_FLAT = np.dtype([("key", "i8"), *[(name, "f8") for name in "xzabhrsc"]])


class AreaRow(NamedTuple):
    """A row of AREA_DTYPE as plain numbers, which Python reckons with much faster."""

    key: int
    center: tuple[float, float]
    radii: tuple[float, float]
    heading: float
    rain_rate: float
    soft_edge: float
    ceiling: float


# The array that was asked about last, and its rows: a frame's areas are looked at by many.
_latest: tuple[NDArray | None, tuple[AreaRow, ...]] = (None, ())


def plain_areas(areas: NDArray) -> tuple[AreaRow, ...]:
    """Areas, AREA_DTYPE, one by one."""
    global _latest
    known, rows = _latest
    if areas is known:
        return rows
    rows = tuple(
        [
            AreaRow(key, (x, z), (a, b), heading, rate, soft, ceiling)
            for key, x, z, a, b, heading, rate, soft, ceiling in areas.view(_FLAT).tolist()
        ]
    )
    if not areas.flags.writeable:
        _latest = (areas, rows)
    return rows


RAIN, SNOW = 0, 1  # kinds of containers
Spells = tuple[float, float, float, float]  # from, to, from, to, s ago
NO_FRONTS: Mapping[int, Spells] = MappingProxyType({})


@dataclass(frozen=True, slots=True)
class DropLook:
    """Looks of the drops of a container; see `components.RainContainer`."""

    reach: float = 30.0  # m, semi-axis of the near container
    height: float = 20.0  # m, of the near container
    margin: float = 0.75  # m, observer's movement that leaves the container where it is
    size_maximum: float = 8.0  # Eq. 3's factor at the container's rim
    exposure: float = 1.0 / 20.0  # s, length of the path a streak shows
    width: float = 4.0  # factor on the drop's diameter, look only
    density: float = 7.0  # factor on how much the drops cover: 1 is what nature shows
    brightness: float = 1.6  # factor on the light of the sky that drops show
    opacity: float = 0.6  # greatest opacity of one streak
    veil: float = 3.5  # factor on the veil's extinction, look only
    fastest: float = 8.0  # m/s, of the observer's own speed that slants the streaks at most


@dataclass(frozen=True, slots=True)
class SnowLook:
    """Looks of falling snow; see `components.SnowFlakes`."""

    model: str = "physical"  # or "liu_tong"
    size: float = 4.0  # factor on the flake's diameter, look only
    size_maximum: float = 7.0  # Eq. 3's factor at the container's rim
    exposure: float = 1.0 / 90.0  # s, over which a flake in motion is drawn out
    flutter: float = 1.0  # factor on how far flakes sway
    density: float = 5.0  # factor on how much the flakes cover: 1 is what nature shows
    brightness: float = 1.7  # factor on the light of sky and ground that flakes show
    opacity: float = 0.9  # greatest opacity of one flake
    aperture: float = 0.004  # m, of the eye or lens that sees near flakes out of focus
    veil: float = 1.0  # factor on the veil's extinction, look only
    settling: float = 1.0  # factor on how fast snow collects


@dataclass(frozen=True, slots=True)
class SplashLook:
    """Looks of the splashes; see `components.SplashEmitter`."""

    size: float = 26.0  # factor on the radius to which the drop's water spreads
    largest: float = 0.12  # m, radius that no crown exceeds
    duration: float = 0.3  # s, from the hit until the crown has sunk
    opacity: float = 0.85  # greatest of one splash
    share: float = 0.005  # of the real drops whose splash is shown full-grown
    droplets: float = 4.0  # mean number that one splash throws, 5 at most
    droplet_size: float = 4.5  # mm, as they are drawn
    droplet_speed: float = 0.28  # of the drop's own speed at the hit
    spread: float = 0.7  # rad, greatest angle between a droplet's way and the normal
    drift: float = 0.3  # share of the wind that there is so close to the surface
    detail: float = 9.0  # m, distance up to which droplets and films are drawn
