"""`Stats`: what the weather is doing, for readouts and logs."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass


@dataclass(slots=True)
class Stats:
    """Figures of the last frame; the same object for the life of a weather."""

    frame: int = 0  # calls of esper.process
    time: float = 0.0  # s, the weather's clock
    ms: float = 0.0  # CPU milliseconds of the last draw
    mode: str = "none"  # "near": the observer is in rain; "far": rain elsewhere; "none"
    rain_rate_here: float = 0.0  # mm/h at the observer
    drops_moved: int = 0
    drops_drawn: int = 0
    impacts: int = 0
    splashes: int = 0
    containers: int = 0  # that the last draw used
    clouds: int = 0  # that stand in the sky, in view or not
    clouds_drawn: int = 0
    impostors_refreshed: int = 0
    cfa_computed: int = 0  # absorption factors that the last frame has computed, new clouds' apart
    state: float = 0.0  # of the skies by the oldest climate, 0 clear to 1 storm
    quality: str = "auto"
    backend: str = "none"

    def count(self, figures: Mapping[str, int | float]) -> None:
        """Take over what the renderer counted in a draw; what it does not count is 0."""
        self.drops_moved = int(figures.get("drops_moved", 0))
        self.drops_drawn = int(figures.get("drops_drawn", 0))
        self.impacts = int(figures.get("impacts", 0))
        self.splashes = int(figures.get("splashes", 0))
        self.containers = int(figures.get("containers", 0))
        self.clouds_drawn = int(figures.get("clouds_drawn", 0))
        self.impostors_refreshed = int(figures.get("impostors_refreshed", 0))
