"""Systems, and the one table that says in which order they run and why."""

from __future__ import annotations

from typing import NamedTuple

from weather_ecs.systems.atmosphere import AtmosphereSystem
from weather_ecs.systems.climate import ClimateSystem
from weather_ecs.systems.cloud_light import CloudLightSystem
from weather_ecs.systems.cloud_rain import CloudRainSystem
from weather_ecs.systems.clouds import CloudSystem
from weather_ecs.systems.events import EventSystem
from weather_ecs.systems.extract import ExtractSystem
from weather_ecs.systems.lightning import LightningSystem
from weather_ecs.systems.processor import System, WeatherProcessor
from weather_ecs.systems.rain_area import RainAreaSystem
from weather_ecs.systems.state import WeatherState
from weather_ecs.systems.transition import TransitionSystem
from weather_ecs.systems.wetness import WetnessSystem
from weather_ecs.systems.wind import WindSystem


class Row(NamedTuple):
    """One system's place in the schedule."""

    system: type[System]
    order: int
    phase: str  # "step": at every fixed step; "frame": once in every esper.process
    reason: str


SCHEDULE: tuple[Row, ...] = (
    Row(TransitionSystem, 90, "step", "first: all the others take what it leads as it is then"),
    Row(WindSystem, 100, "step", "early: whatever drifts needs the wind of this step"),
    Row(AtmosphereSystem, 105, "step", "by the clock alone: the time of the sky goes on"),
    Row(ClimateSystem, 110, "step", "before the clouds, which come in by the state of the skies"),
    Row(CloudSystem, 150, "step", "after wind and climate: they say what comes in, and where"),
    Row(RainAreaSystem, 200, "step", "after the wind, which carries the areas"),
    Row(CloudRainSystem, 250, "step", "after the areas have moved: puts its own under clouds"),
    Row(LightningSystem, 260, "step", "after the clouds, in which it strikes"),
    Row(EventSystem, 270, "step", "after the areas have moved: tells where rain begins and ends"),
    Row(WetnessSystem, 300, "step", "after the areas have moved: it rains where they are now"),
    Row(CloudLightSystem, 800, "frame", "before the frame is published, which shows its light"),
    Row(ExtractSystem, 900, "frame", "last: publishes what all the others have made"),
)


def scheduled(phase: str) -> list[System]:
    """New systems of one phase, in their order."""
    rows = sorted((row for row in SCHEDULE if row.phase == phase), key=lambda row: row.order)
    return [row.system() for row in rows]


__all__ = [
    "SCHEDULE",
    "AtmosphereSystem",
    "ClimateSystem",
    "CloudLightSystem",
    "CloudRainSystem",
    "CloudSystem",
    "EventSystem",
    "ExtractSystem",
    "LightningSystem",
    "RainAreaSystem",
    "Row",
    "System",
    "TransitionSystem",
    "WeatherProcessor",
    "WeatherState",
    "WetnessSystem",
    "WindSystem",
    "scheduled",
]
