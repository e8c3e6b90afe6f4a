"""Drops on things, played on."""

from __future__ import annotations

import math

import esper
import numpy as np

from tests.boxes import CORNERS, TRIANGLES, placed
from tests.weather_pictures import Stage
from weather_ecs.components import Occluder, RainArea, SplashEmitter, Wind

NORTH = math.pi / 2  # the heading of -z


def scene(splashes: bool = True, roof: bool = False, **looks: float) -> None:
    """Rain on level ground; a roof over the half that is in front of x = 0."""
    esper.create_entity(RainArea((0, 0), (60, 40), 60.0))
    esper.create_entity(Wind((1.0, 0.0), 0.0))
    esper.create_entity(Occluder(CORNERS, TRIANGLES, placed((0, -1, 0), (50, 1, 50))))
    if roof:
        esper.create_entity(Occluder(CORNERS, TRIANGLES, placed((0, 3, -8), (6, 0.1, 6))))
    if splashes:
        esper.create_entity(SplashEmitter(**looks))


def play(it: Stage, frames: int) -> np.ndarray:
    return it.play(frames, position=(0.0, 1.5, 0.0), heading=NORTH, pitch=-0.25)
