"""How a game begins: what is handed on from the command line to the game."""

from __future__ import annotations

from typing import TypedDict


class Beginning(TypedDict, total=False):
    """Arguments of `Game`; what is left out is as there."""

    seed: int
    preset: str  # name of a weather, or path of a file
    start: tuple[float, float]  # (x, z), m
    metar: str | None  # a report in place of the preset
    watch: bool  # the file
