"""The panels, and where each of them stands: `PANELS` is the one list of them."""

from __future__ import annotations

from collections.abc import Callable
from enum import Enum
from importlib import import_module
from typing import NamedTuple

from weather_ecs.editor.shared import Panel, Shared


class Place(Enum):
    """A part of the window; panels of one place share it as tabs, but for stacked places."""

    CLOUD_LEFT = "cloud left"
    CLOUD_RIGHT = "cloud right"  # stacked
    CLOUD_VIEW = "cloud view"
    CLOUD_BELOW = "cloud below"
    SKY_LEFT = "sky left"
    SKY_RIGHT = "sky right"
    SKY_VIEW = "sky view"
    SKY_BELOW = "sky below"


class Entry(NamedTuple):
    """A panel by name: its module is imported and it is made when the window opens."""

    place: Place
    module: str  # of weather_ecs.editor
    name: str  # of a class or function that takes the Shared
    share: float = 1.0  # of the height, where panels are stacked


PANELS: list[Entry] = [
    Entry(Place.CLOUD_LEFT, "panels.cloud", "CloudPanel"),
    Entry(Place.CLOUD_RIGHT, "panels.seed", "SeedPanel", 0.475),
    Entry(Place.CLOUD_RIGHT, "panels.root", "RootPanel", 0.525),
    Entry(Place.CLOUD_VIEW, "cloud_view", "CloudView"),
    Entry(Place.CLOUD_BELOW, "gallery", "Gallery"),
    Entry(Place.SKY_LEFT, "panels.simulation", "SimulationPanel"),
    Entry(Place.SKY_LEFT, "panels.sky", "SkyPanel"),
    Entry(Place.SKY_LEFT, "panels.clouds", "CloudsPanel"),
    Entry(Place.SKY_VIEW, "world_view", "WorldView"),
    Entry(Place.SKY_VIEW, "map_view", "MapView"),
    Entry(Place.SKY_VIEW, "heights_view", "HeightsView"),
    Entry(Place.SKY_RIGHT, "panels.weather", "WeatherPanel"),
    Entry(Place.SKY_RIGHT, "panels.wind", "WindPanel"),
    Entry(Place.SKY_RIGHT, "panels.metar", "MetarPanel"),
    Entry(Place.SKY_BELOW, "panels.transport", "Transport"),
]


def make(entry: Entry, shared: Shared) -> Panel:
    """The panel of an entry."""
    module = import_module(f"weather_ecs.editor.{entry.module}")
    factory: Callable[[Shared], Panel] = getattr(module, entry.name)
    return factory(shared)
