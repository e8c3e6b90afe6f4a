"""`WeatherState`: what the systems share."""

from __future__ import annotations

from typing import Any

import numpy as np

from weather_ecs.clock import STEP, Clock
from weather_ecs.frame import WindProfile
from weather_ecs.physics.ground_law import SnowLaw
from weather_ecs.systems.cloud_field import CloudField
from weather_ecs.systems.cloud_models import ModelBook
from weather_ecs.systems.cloud_shapes import ShapeLibrary
from weather_ecs.systems.course import Course
from weather_ecs.systems.rain_fronts import RainFronts
from weather_ecs.systems.strikes import StrikeField
from weather_ecs.systems.uids import Uids
from weather_ecs.systems.wet_ground import WetGround


class WeatherState:
    """One weather's state beyond its components. All of it goes into a snapshot."""

    __slots__ = (
        "clock",
        "cloud_shapes",
        "clouds",
        "course",
        "drawn",
        "events",
        "fronts",
        "light_direction",
        "models",
        "profile",
        "rng",
        "seed",
        "snow_ground",
        "step",
        "strikes",
        "uids",
        "wet_ground",
        "wind",
    )

    def __init__(self, seed: int, models: ModelBook | None = None) -> None:
        self.seed = seed
        self.rng = np.random.Generator(np.random.PCG64(seed))  # the only source of chance
        self.clock = Clock()
        self.uids = Uids()
        self.clouds = CloudField()
        self.fronts = RainFronts()
        self.strikes = StrikeField()
        self.course: Course | None = None  # of a whole weather, where the game has asked for one
        self.wet_ground = WetGround()
        self.snow_ground = WetGround(SnowLaw())
        self.step = 0  # the fixed step that the systems are at
        self.wind = (0.0, 0.0, 0.0)  # m/s, world axes, at the reference height; of WindSystem
        self.profile = WindProfile()  # how that varies with height
        # What follows from all that, or is the same for good.
        self.models = models or ModelBook()
        self.cloud_shapes = ShapeLibrary()
        self.events: list[tuple[str, tuple[Any, ...]]] = []  # names and values, to be told of
        self.light_direction: tuple[float, float, float] | None = None  # of the clouds
        self.drawn = False  # somebody draws this weather, and needs what only pictures show

    @property
    def next_time(self) -> float:
        """The weather's clock at the end of the next fixed step, s."""
        return (self.clock.steps + 1) * STEP
