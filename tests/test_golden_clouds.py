"""A picture of clouds, held against one that was looked at: see test_golden.py."""

from __future__ import annotations

import os
from pathlib import Path

import esper
import moderngl
import numpy as np
from PIL import Image

from tests.golden_pictures import GOLDEN, check, difference, kept
from tests.views import look_from, perspective
from tests.weather_pictures import stage
from weather_ecs.components import Cloud, Sun

SIZE = (320, 180)
NAME = "clouds"
NORTH = np.pi / 2
PLACES = (  # model, place, number: near, far, overhead
    ("cumulus", (-500.0, 700.0, -1900.0), 2),
    ("cumulus", (2300.0, 800.0, -5200.0), 4),
    ("cumulonimbus", (-6000.0, 1100.0, -24_000.0), 3),
    ("stratus", (1500.0, 420.0, -1500.0), 1),
)


def picture(ctx: moderngl.Context) -> np.ndarray:
    """(height, width, 3) uint8, rows from above; some clouds are impostors, one is on a canvas."""
    with stage(ctx, SIZE, quality="medium", seed=11) as made:
        made.background = (0.36, 0.50, 0.72, 1.0)
        esper.create_entity(Sun((0.5, 0.6, 0.62)))
        for model, place, number in PLACES:
            esper.create_entity(Cloud(model, place, drift=0.0, number=number))
        for _ in range(12):
            esper.process(0.05)
            made.clear()
            made.weather.draw(look_from((0.0, 2.0, 0.0), NORTH, 0.28), perspective())
        return made.picture()[::-1]


def test_clouds_are_those_that_were_kept(ctx: moderngl.Context, tmp_path: Path) -> None:
    found = picture(ctx)
    if os.environ.get("REGENERATE_GOLDEN"):
        Image.fromarray(found).save(GOLDEN / f"{NAME}.png", optimize=True)
    check(ctx, found, NAME, tmp_path)


def test_an_empty_sky_would_not_pass() -> None:
    empty = np.full((*SIZE[::-1], 3), np.rint(np.array((0.36, 0.50, 0.72)) * 255), np.uint8)
    mean, others = difference(empty, kept(NAME))
    assert mean > 4.0 and others > 0.2
