"""Sheets of what falls: `python -m tools.precipitation_sheets OUT presets|gust|snow|kinds|posts`.

All but the last are the demo's walk, the last is a plain with black posts. The sheets in
docs/drops.md, docs/wind.md, docs/snow.md and docs/fog.md are made by it. Needs Pillow.
"""

from __future__ import annotations

import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from demo_game.game import Game
from demo_game.plays import SnowPlay
from tools.post_row import posts
from tools.stills import ALONG_THE_PATH, Stage, run, save_sheet
from weather_ecs.physics import wind
from weather_ecs.presets import PRESETS

USAGE = "usage: python -m tools.precipitation_sheets OUT.jpg presets|gust|snow|kinds|posts"
SHOWN = (
    "drizzle", "light", "moderate", "heavy", "cloudburst",
    "sleet", "light_snow", "heavy_snow", "blizzard", "fog",
)  # fmt: skip
BEFORE = 15.0  # s of a preset before its picture
GUST = 2.0, 9.0  # s: rises, and dies down until
MOMENTS = (0.0, 1.0, 2.0, 4.0, 6.0, 9.5)  # s after it begins
STRENGTH = 14.0  # m/s
SNOWFALL = 60.0  # s of play, from before the snow to after it
SHARES = {
    "before": 0.04, "it begins": 0.14, "it snows": 0.3, "after more of it": 0.5,
    "before it eases": 0.62, "after it": 0.95,
}  # fmt: skip
LAST, NOW_AND_THEN = 8, 10  # frames that are drawn before a picture
# What falls, where the day is, and where one looks from.
KINDS = {
    "heavy snow": ("heavy_snow", "afternoon", False),
    "light snow": ("light_snow", "afternoon", False),
    "a blizzard": ("blizzard", "afternoon", False),
    "sleet": ("sleet", "afternoon", False),
    "by the lamps, at dusk": ("heavy_snow", "dusk", False),
    "from afar": ("heavy_snow", "afternoon", True),
}
LAMP = -2.6, -40.0, -19.0, -3.0  # x, z in m, yaw and pitch in degrees
CABIN = (-0.5, 1.2, -46.5), (5.0, 1.3, -60.0)  # eye, and what it looks at


def presets(stage: Stage, out: Path) -> None:
    """Every preset from the same spot, with its figures."""
    pictures, texts = [], []
    for name in SHOWN:
        game = stage.game(preset=name)
        stage.face(*CABIN)
        stage.settle(game, 30, 12)
        pictures.append(_later(stage, game, BEFORE))
        game.close()
        it = PRESETS[name]
        texts.append(
            f"{name.replace('_', ' ')}: {it.rain_rate:g} mm/h, {it.temperature:g} °C, "
            f"wind {it.wind_speed:g} m/s"
        )
    save_sheet(out, pictures, texts, columns=2, width=480, quality=72)


def gust(stage: Stage, out: Path) -> None:
    """A gust passes through heavy rain: streaks, flag, windmill."""
    game = stage.game(preset="heavy")
    stage.face(*CABIN)
    stage.settle(game, 30, 12)
    stage.still(game, seconds=10.0, frames=6)
    calm, frame = game.mood.current, 0
    pictures, texts = [], []
    for moment in MOMENTS:
        last = round(30.0 * moment)
        while frame <= last:
            strength = float(wind.gust(frame / 30.0, GUST[0], GUST[1]))
            speed = calm.wind_speed + STRENGTH * strength
            game.mood.put(replace(calm, wind_speed=speed), "heavy")
            if last - frame < LAST or frame % NOW_AND_THEN == 0:
                picture = stage.still(game, frames=1)
            else:
                game.update(1.0 / 30.0)
            frame += 1
        pictures.append(picture)
        texts.append(f"after {moment:g} s: {math.hypot(*_wind(game)):.1f} m/s")
    game.close()
    save_sheet(out, pictures, texts, columns=2, width=480, quality=76)


def _later(stage: Stage, game: Game, seconds: float) -> NDArray[np.uint8]:
    """The picture after so many seconds.

    Maps of what lies are brought up to date by drawing, and what moves covers the ground only for
    a moment: so a frame is drawn now and then, and the last ones all.
    """
    frames = min(max(round(30.0 * seconds), 1), LAST)
    for k in range(round(30.0 * seconds) - frames):
        game.update(1.0 / 30.0)
        if k % NOW_AND_THEN == 0:
            stage.still(game, frames=1)
    return stage.still(game, frames=frames)


def _wind(game: Game) -> tuple[float, float]:
    x, _, z = game.weather.sample(game.pose.eye).wind
    return x, z


def snow(stage: Stage, out: Path) -> None:
    """Snow before, while it falls and after, on roof, ground and figure; a time-lapse."""
    game = stage.game(preset="light_snow", play=SnowPlay(SNOWFALL))
    stage.face(*CABIN)
    pictures, time = [], 0.0
    for share in SHARES.values():
        moment = share * SNOWFALL
        pictures.append(_later(stage, game, moment - time))
        time = moment
    game.close()
    save_sheet(out, pictures, list(SHARES), columns=2, width=480, quality=78)


def kinds(stage: Stage, out: Path) -> None:
    """What snow looks like: much and little of it, blown, half melted, by lamps, from afar."""
    pictures = []
    for preset, time, afar in KINDS.values():
        game = stage.game(preset=preset)
        game.sky.be(time)
        stage.look(*(ALONG_THE_PATH if afar else LAMP))
        stage.settle(game, 60, 20)
        pictures.append(_later(stage, game, BEFORE))
        game.close()
    save_sheet(out, pictures, list(KINDS), columns=2, width=640, quality=72)


SHEETS = {"presets": presets, "gust": gust, "snow": snow, "kinds": kinds}


def draw(out: Path, arguments: list[str]) -> None:
    """Render the sheet of a name; raises KeyError for a name that is none."""
    if arguments[0] == "posts":
        posts(out)
    else:
        SHEETS[arguments[0]](Stage(), out)


def main(arguments: list[str]) -> int:
    """0, or 2 where an argument is missing or names no sheet."""
    known = len(arguments) > 1 and arguments[1] in (*SHEETS, "posts")
    return run(arguments if known else [], USAGE, draw, least=2)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
