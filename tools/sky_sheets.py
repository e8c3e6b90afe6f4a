"""Sheets of the demo's sky: `python -m tools.sky_sheets OUT day|halo|rainbow|strike|storm`.

The angles of halo and rainbow are measured in the picture: where what they add to it is brightest.
The sheets in docs/sky.md, docs/lightning.md and docs/weathers.md are made by it.
"""

from __future__ import annotations

import math
import sys
from pathlib import Path

import esper
import numpy as np
from numpy.typing import NDArray

from demo_game.camera import projection_matrix, view_matrix
from demo_game.game import Game
from demo_game.skies import DAY, seconds
from tools.stills import ALONG_THE_PATH, Stage, run_one, save_sheet
from weather_ecs.components import RainArea
from weather_ecs.presets import CloudBank, WholeWeather

USAGE = "usage: python -m tools.sky_sheets OUT.jpg day|halo|rainbow|strike|storm"
LATITUDE = 45.0
MARCH = "2025-03-13T00:00:00Z"
WEST = (10.0, -25.0, 85.0, 13.0)
ICE = WholeWeather(
    "ice clouds", 0.2, banks=(CloudBank(("cirrostratus",), 8000.0, 7.0),), overcast=0.2
)
ANGLES = np.arange(18.0, 60.0, 0.25)  # degrees
STORM_COMES = 110.0  # s
STORM_FROM, STORM_TO = (-600.0, -9500.0), (0.0, -2500.0)  # (x, z) in m of its rain


def day(stage: Stage, out: Path) -> None:
    """Every two hours of a day in March under a full moon, looking west."""
    game = stage.game(preset="clear")
    game.changer.choose_whole("fair_cumulus", 0.0)
    game.sky.atmosphere.latitude = LATITUDE
    stage.look(*WEST)
    for _ in range(120):
        game.update(0.5)
    pictures, texts = [], []
    for hour in range(0, 24, 2):
        game.sky.atmosphere.time = seconds(MARCH) + hour / 24.0 * DAY
        stage.settle(game)
        pictures.append(stage.still(game))
        x, y, _ = game.weather.light.sun_direction
        what = f"light from {math.degrees(math.asin(y)):.0f}° in the {'east' if x > 0 else 'west'}"
        texts.append(f"{hour:02}:00, {what}, lamps {100 * game.light.lamps:.0f} %")
    game.close()
    save_sheet(out, pictures, texts, columns=3, width=480)


def halo(stage: Stage, out: Path) -> None:
    """The sun through cirrostratus."""
    game = stage.game(preset="clear")
    game.changer.choose_whole("clear", 0.0)
    game.weather.change_to(ICE, 0.0)
    game.sky.be("afternoon")
    game.settings.field_of_view = 90.0
    _face(stage, game, 25.0, towards=True)
    stage.settle(game)
    shown = _with_and_without(stage, game, "halo", 60.0)
    apart = _angles(stage, game, game.weather.light.sun_direction)
    peaks = _peaks(shown, apart, ((20.0, 26.0),))
    game.close()
    save_sheet(out, [shown[0]], [f"Halo, measured {peaks[0]:.1f}°"], columns=1, width=960)


def rainbow(stage: Stage, out: Path) -> None:
    """Both bows in a shower far off, opposite a low sun."""
    game = stage.game(preset="clear")
    game.changer.choose_whole("showers", 0.0)
    game.sky.be("afternoon")
    game.sky.atmosphere.time = seconds("2025-03-13T16:10:00Z")
    game.settings.field_of_view = 100.0
    _face(stage, game, 16.0, towards=False)
    x, _, z = game.weather.light.sun_direction
    whole = game.weather.whole
    assert whole is not None
    area = esper.component_for_entity(whole.entities["rain"], RainArea)
    area.center = (-2600.0 * x, 39.0 - 2600.0 * z)
    stage.settle(game)
    shown = _with_and_without(stage, game, "rainbow", 30.0)
    x, y, z = game.weather.light.sun_direction
    apart = _angles(stage, game, (-x, -y, -z))
    peaks = _peaks(shown, apart, ((39.0, 45.0), (48.0, 56.0)))
    game.close()
    text = f"Rainbow, measured {peaks[0]:.1f}° and {peaks[1]:.1f}°"
    save_sheet(out, [shown[0]], [text], columns=1, width=960)


def strike(stage: Stage, out: Path) -> None:
    """Five successive frames, a thirtieth of a second each."""
    game = stage.game(preset="clear")
    game.changer.choose_whole("thunderstorm", 0.0)
    game.sky.be("evening")
    stage.look(*ALONG_THE_PATH)
    stage.settle(game)
    stage.still(game, seconds=20.0)
    game.weather.strike((-90.0, 0.0, -520.0))
    pictures = [stage.still(game, frames=1) for _ in range(6)][1:]
    game.close()
    texts = [f"{1000 * k / 30:.0f} ms" for k in range(1, 6)]
    save_sheet(out, pictures, texts, columns=3, width=480)


def storm(stage: Stage, out: Path) -> None:
    """From fair cumulus to a thunderstorm, in twelve stills."""
    game = stage.game(preset="clear")
    game.changer.choose_whole("fair_cumulus", 0.0)
    game.sky.be("afternoon")
    stage.look(*ALONG_THE_PATH)
    for _ in range(160):
        game.update(0.5)
    stage.settle(game)
    game.weather.change_to("thunderstorm", STORM_COMES, center=STORM_FROM)
    whole = game.weather.whole
    assert whole is not None
    area = esper.component_for_entity(whole.entities["rain"], RainArea)
    pictures, texts = [], []
    for k in range(12):
        share = k / 11.0
        (x0, z0), (x1, z1) = STORM_FROM, STORM_TO
        area.center = (x0 + share * (x1 - x0), z0 + share * (z1 - z0))
        pictures.append(stage.still(game, seconds=STORM_COMES / 11.0 if k else 0.0, frames=12))
        whole = game.weather.whole
        assert whole is not None
        c = whole.conditions
        texts.append(
            f"{100 * whole.progress:.0f} %: state {c.state:.2f}, {c.rain_rate:.0f} mm/h, "
            f"wind {c.wind_speed:.0f} m/s"
        )
    game.close()
    save_sheet(out, pictures, texts, columns=3, width=480)


def _face(stage: Stage, game: Game, pitch: float, *, towards: bool) -> None:
    """Look below the sun, or below the point opposite it."""
    game.update(0.0)
    x, _, z = game.weather.light.sun_direction
    yaw = math.degrees(math.atan2(-x, -z)) + (0.0 if towards else 180.0)
    stage.look(-3.0, 33.0, yaw, pitch)


def _with_and_without(
    stage: Stage, game: Game, ring: str, wait: float
) -> tuple[NDArray[np.uint8], NDArray[np.uint8]]:
    """The picture, and the same without the ring."""
    stage.still(game, seconds=wait)
    air = game.sky.atmosphere
    setattr(air, ring, 1.0)
    game.weather.paused = True
    there = stage.still(game, frames=2)
    setattr(air, ring, 0.0)
    return there, stage.still(game, frames=2)


def _angles(stage: Stage, game: Game, axis: tuple[float, ...]) -> NDArray[np.float64]:
    """Degrees from an axis, of every pixel."""
    width, height = stage.size
    view, p = view_matrix(game.pose), projection_matrix(game.settings.hfov, width / height)
    turn = view[:3, :3]
    x = (np.arange(width) + 0.5) / width * 2.0 - 1.0
    y = 1.0 - (np.arange(height) + 0.5) / height * 2.0
    ex, ey = np.meshgrid(x / p[0, 0], y / p[1, 1])
    rays = np.stack([ex, ey, -np.ones_like(ex)], -1) @ turn
    cosine = rays @ np.array(axis) / np.linalg.norm(rays, axis=-1)
    return np.asarray(np.degrees(np.arccos(np.clip(cosine, -1.0, 1.0))))


def _peaks(
    shown: tuple[NDArray[np.uint8], NDArray[np.uint8]],
    apart: NDArray[np.float64],
    windows: tuple[tuple[float, float], ...],
) -> list[float]:
    """Degrees in each window at which a ring adds most."""
    added = (shown[0].astype(float) - shown[1]).sum(-1)
    seen = added > 0.0
    half = 0.5 * (ANGLES[1] - ANGLES[0])
    mean = np.array(
        [added[seen & (np.abs(apart - a) < half)].sum() / max((np.abs(apart - a) < half).sum(), 1)
         for a in ANGLES]
    )  # fmt: skip
    found = []
    for low, high in windows:
        inside = (low <= ANGLES) & (high >= ANGLES)
        found.append(float(ANGLES[inside][mean[inside].argmax()]))
    return found


SHEETS = {"day": day, "halo": halo, "rainbow": rainbow, "strike": strike, "storm": storm}


def main(arguments: list[str]) -> int:
    """0, or 2 where an argument is missing or names no sheet."""
    return run_one(arguments, USAGE, SHEETS)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
