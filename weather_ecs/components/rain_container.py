"""`RainContainer`: how the drops around an observer look."""

from __future__ import annotations

from dataclasses import dataclass
from typing import ClassVar

from weather_ecs.components._base import Check, Component, number


@dataclass(eq=False, slots=True)
class RainContainer(Component):
    """Looks of the rain; what it costs is the quality's affair. The oldest entity's one counts.

    The fields and their defaults are those of `weather_ecs.frame.DropLook`.
    """

    reach: float = 30.0  # m, 2 to 500, semi-axis of the container around the observer
    height: float = 20.0  # m, 2 to 500, of that container
    margin: float = 0.75  # m, 0 to 100, movement of the observer that leaves it where it is
    size_maximum: float = 8.0  # 1 to 50, growth of a drop at the container's rim (Eq. 3)
    exposure: float = 1.0 / 20.0  # s, 1e-4 to 1, of fall that a streak shows
    width: float = 4.0  # 0.05 to 20, factor on the drop's diameter
    density: float = 7.0  # 0 to 100, factor on how much the drops cover: 1 is what nature shows
    brightness: float = 1.6  # 0 to 10, factor on the light of the sky that drops show
    opacity: float = 0.6  # 0 to 1, greatest opacity of one streak, of a drop of 1.5 mm or more
    veil: float = 3.5  # 0 to 10, factor on the extinction of the rain beyond the container
    fastest: float = 8.0  # m/s, 0 to 1000, of the observer's own speed that slants the streaks

    checks: ClassVar[dict[str, Check]] = {
        "reach": number(2.0, 500.0),
        "height": number(2.0, 500.0),
        "margin": number(0.0, 100.0),
        "size_maximum": number(1.0, 50.0),
        "exposure": number(1.0e-4, 1.0),
        "width": number(0.05, 20.0),
        "density": number(0.0, 100.0),
        "brightness": number(0.0, 10.0),
        "opacity": number(0.0, 1.0),
        "veil": number(0.0, 10.0),
        "fastest": number(0.0, 1000.0),
    }
