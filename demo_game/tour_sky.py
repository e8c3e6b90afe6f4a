"""The tours that show the sky and the snow: few steps, long looks, and a flight."""

from __future__ import annotations

import math
from typing import NamedTuple

from demo_game.camera import Pose
from demo_game.curve import Smooth
from demo_game.player import EYE_HEIGHT, Ground
from demo_game.plays import NightPlay, Play, SnowPlay, StormPlay, ThunderPlay


class Moment(NamedTuple):
    """Where one is and looks at a share of a tour's time."""

    u: float  # 0..1
    x: float  # m
    z: float  # m
    yaw: float  # degrees, 0 to the north, counter-clockwise seen from above
    pitch: float  # degrees, positive looks up
    stage: str = ""  # that begins here, if one does
    above: float = 0.0  # m over a walker's eyes


CLOUDS = (
    Moment(0.00, 0.4, 68.0, 4.0, 13.0, "clear"),
    Moment(0.16, 0.9, 63.5, 34.0, 14.0, "clouds come"),
    Moment(0.34, 1.6, 59.0, -22.0, 12.0),
    Moment(0.48, 2.2, 55.0, -46.0, 10.0, "shafts far off"),
    Moment(0.62, 2.6, 52.0, -6.0, 9.0, "the storm"),
    Moment(0.72, 2.6, 51.0, 12.0, 11.0),
    Moment(0.76, 2.6, 49.0, 12.0, 22.0, "up", 6.0),
    Moment(0.82, 2.6, 0.0, 8.0, 30.0, "", 500.0),
    Moment(0.88, 0.0, -250.0, 4.0, 16.0, "in the cloud", 1600.0),
    Moment(0.94, -40.0, -800.0, 0.0, -8.0, "over the tops", 3300.0),
    Moment(1.00, -100.0, -1800.0, -6.0, -17.0, "", 4900.0),
)
SNOW = (
    Moment(0.00, -7.0, -38.0, -28.0, 1.0, "before"),
    Moment(0.12, -6.4, -39.0, -30.0, 1.0, "it snows"),
    Moment(0.45, -4.6, -42.0, -36.0, 0.0),
    Moment(0.60, -3.8, -43.4, -26.0, -4.0),
    Moment(0.80, -2.8, -45.4, -30.0, -1.0, "after"),
    Moment(1.00, -2.0, -47.0, -34.0, 0.0),
)


STORM = (
    Moment(0.00, 0.4, 68.0, 4.0, 9.0, "fair"),
    Moment(0.30, 0.9, 60.0, 8.0, 11.0, "it comes up"),
    Moment(0.52, 3.0, 46.0, -4.0, 9.0, "the storm"),
    Moment(0.75, -1.0, 26.0, 2.0, 8.0),
    Moment(1.00, -1.0, 4.0, -2.0, 6.0),
)
NIGHT = (
    Moment(0.00, 0.6, 22.0, 2.0, 6.0, "by lamps"),
    Moment(0.35, -1.0, 2.0, -4.0, 3.0),
    Moment(0.60, 0.2, -16.0, -10.0, 3.0, "the cabin"),
    Moment(0.80, 0.2, -28.0, -22.0, 2.0),
    Moment(1.00, 0.2, -36.0, -30.0, 2.0),
)


class SkyTour:
    """Smooth from moment to moment; each has its share of the time, however long that is."""

    def __init__(
        self, name: str, ground: Ground, duration: float, way: tuple[Moment, ...], play: Play
    ) -> None:
        self.name = name
        self.play: Play | None = play
        self._duration, self._ground, self._way = duration, ground, way
        at = [moment.u for moment in way]
        self._x = Smooth(at, [moment.x for moment in way])
        self._z = Smooth(at, [moment.z for moment in way])
        self._yaw = Smooth(at, [math.radians(moment.yaw) for moment in way])
        self._pitch = Smooth(at, [math.radians(moment.pitch) for moment in way])
        self._above = Smooth(at, [moment.above for moment in way])

    def pose(self, time: float) -> Pose:
        """Eye and look at `time` seconds."""
        u = time / self._duration
        x, z = self._x(u), self._z(u)
        y = self._ground.floor_height(x, z, math.inf) + EYE_HEIGHT + self._above(u)
        return Pose((x, y, z), self._yaw(u), self._pitch(u))

    def stage(self, time: float) -> str:
        """Name of the stage at `time`."""
        u = time / self._duration + 1e-9
        return [moment.stage for moment in self._way if moment.stage and moment.u <= u][-1]


def clouds_tour(ground: Ground, duration: float) -> SkyTour:
    """Under a sky that fills from clear to storm, then up through it and over its tops."""
    return SkyTour("clouds", ground, duration, CLOUDS, StormPlay(duration))


def snow_tour(ground: Ground, duration: float) -> SkyTour:
    """Before the cabin, while it begins to snow, snows and stops."""
    return SkyTour("snow", ground, duration, SNOW, SnowPlay(duration))


def storm_tour(ground: Ground, duration: float) -> SkyTour:
    """Along the path towards a thunderstorm that comes up."""
    return SkyTour("storm", ground, duration, STORM, ThunderPlay(duration))


def night_tour(ground: Ground, duration: float) -> SkyTour:
    """Along the lamps to the cabin by night, in a shower."""
    return SkyTour("night", ground, duration, NIGHT, NightPlay())
