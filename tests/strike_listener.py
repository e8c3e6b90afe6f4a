"""Who keeps the events of lightning."""

from __future__ import annotations

from typing import Any

import esper

from weather_ecs.systems.strikes import Strike


class Listener:
    """What has been told, in order."""

    def __init__(self) -> None:
        self.log: list[tuple[Any, ...]] = []
        esper.set_handler("strike", self.strike)
        esper.set_handler("thunder", self.thunder)

    def strike(self, strike: Strike, heard: tuple[Any, ...]) -> None:
        self.log.append(("strike", strike, heard))

    def thunder(self, observer: int, strike: Strike, distance: float) -> None:
        self.log.append(("thunder", observer, strike.number, distance))

    @property
    def strikes(self) -> list[Strike]:
        return [entry[1] for entry in self.log if entry[0] == "strike"]
