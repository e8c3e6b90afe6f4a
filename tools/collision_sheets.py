"""Sheets of rain that meets the demo: `python -m tools.collision_sheets OUT.jpg NAME`.

NAME: hits (what rain falls on), frames (successive frames of somebody who walks and of a sail that
turns), puddles (a minute and more of rain, and what dries after it), lee (the ground round the
cabin, calm and in wind).
The sheets in docs/collisions.md are made by it.
"""

from __future__ import annotations

import math
import sys
from dataclasses import replace
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from demo_game.game import Game
from demo_game.place import layout
from tools.stills import Stage, run_one, save_sheet

USAGE = "usage: python -m tools.collision_sheets OUT.jpg hits|frames|puddles|lee"
RAIN = "heavy"
FRAME = 1.0 / 30.0  # s
HIT = 32  # frames until the figure is hit
Point = tuple[float, float, float]


def set_weather(game: Game, wind: float, rate: float | None = None) -> None:
    """So much wind in m/s, and rain in mm/h, from now on."""
    mood = game.mood.current
    rate = mood.rain_rate if rate is None else rate
    game.mood.put(replace(mood, wind_speed=wind, rain_rate=rate), RAIN)


def figure_at(game: Game) -> Point:
    """Where the figure stands, m."""
    x, y, z, _ = game.place.figure_position(game.scene_time)
    return x, y, z


def views(game: Game) -> dict[str, tuple[Point, Point]]:
    """Eye and target of each view, m."""
    place = game.place
    (x, floor, z), level = place.door, place.pond.level
    _, jetty_z = layout.JETTY
    ground = place.height(0.0, -41.0)
    return {
        "the roof": ((x - 1.6, floor + 4.0, z + 3.4), (x - 0.4, floor + 2.6, z + 0.6)),
        "the steps": ((x + 0.9, floor + 0.8, z + 4.4), (x + 0.1, floor - 0.4, z + 2.9)),
        "bare ground": ((0.0, ground + 1.0, -40.0), (-0.4, ground, -41.9)),
        "the pond": ((-17.0, level + 1.1, -73.2), (-20.5, level, -72.2)),
        "a jetty": ((-16.8, level + 1.0, jetty_z + 3.4), (-16.4, level + 0.1, jetty_z)),
        "from inside the cabin": ((x, floor + 1.6, z - 3.6), (x, floor + 1.2, z + 5.0)),
    }


def hits(stage: Stage, out: Path) -> None:
    """Roof, steps, ground, pond, jetty, and none of it indoors."""
    game = stage.game(preset=RAIN)
    set_weather(game, 0.0)
    stage.still(game, seconds=40.0, frames=0)
    pictures, texts = [], []
    for name, (eye, target) in views(game).items():
        stage.face(eye, target)
        pictures.append(stage.still(game, frames=24))
        texts.append(name)
    game.close()
    save_sheet(out, pictures, texts, columns=2, width=640)


def frames(stage: Stage, out: Path) -> None:
    """Successive frames of somebody who walks, from a hit on a shoulder on, and of a sail."""
    sail = sail_frames(stage)
    stage.quality = "medium"
    game = stage.game(preset=RAIN)
    set_weather(game, 0.0, 50.0)
    stage.still(game, seconds=20.0, frames=0)
    pictures = []
    for _ in range(HIT + 6):
        x, y, z = figure_at(game)
        stage.face((x + 0.8, y + 2.25, z + 0.9), (x, y + 1.4, z))
        pictures.append(stage.still(game, frames=1)[60:420, 220:800])
    game.close()
    texts = [f"{1000 * k * FRAME:.0f} ms" for k in range(6)]
    texts += [f"a sail that turns, {text}" for text in texts[:3]]
    save_sheet(out, pictures[HIT:] + sail, texts, columns=3, width=480)


def sail_frames(stage: Stage) -> list[NDArray[np.uint8]]:
    """Three frames from close to a sail of the windmill, in rain that drives against it."""
    game = stage.game(preset=RAIN)
    mood, poses = game.mood.current, game.place.poses
    hub = poses(0.0)["sails"]
    x, _, z = facing = hub[:3, 2]
    wind = {"wind_speed": 7.0, "wind_heading": math.atan2(z, -x)}
    game.mood.put(replace(mood, rain_rate=60.0, **wind), RAIN)
    stage.still(game, seconds=20.0, frames=0)

    def middle() -> NDArray[np.float64]:
        """Of the sail that has just come down to the level, m."""
        spots = [(0.5, 5.0), (-5.0, 0.5), (-0.5, -5.0), (5.0, -0.5)]  # of the four
        places = np.array([poses(game.scene_time)["sails"] @ (*spot, 0.0, 1.0) for spot in spots])
        sinks = places @ hub[:, 0] > hub[:, 3] @ hub[:, 0]  # they turn clockwise
        away = np.where(sinks, np.abs(places[:, 1] - hub[1, 3] - 0.5), np.inf)
        return np.asarray(places[np.argmin(away), :3])

    while abs(middle()[1] - hub[1, 3] - 0.5) > 0.15:
        stage.still(game, frames=1)
    pictures = []
    for frame in range(14):
        if frame <= 10:
            at = middle()
            eye = at + 2.0 * facing + (0.0, 0.5, 0.0) - 1.5 * hub[:3, 0]
            stage.face(eye.tolist(), at.tolist())
        pictures.append(stage.still(game, frames=1)[150:510, 120:700])
    game.close()
    return pictures[10:13]


def puddles(stage: Stage, out: Path) -> None:
    """Dry ground, a minute and more of rain, and the time after it."""
    game = stage.game(preset=RAIN)
    set_weather(game, 2.0)
    ground = game.place.height(-1.3, -45.0)
    stage.face((0.2, game.place.height(0.2, -37.5) + 1.7, -37.5), (-1.3, ground, -45.0))
    pictures, texts = [stage.still(game, frames=4)], ["dry"]
    passed = 0.0
    for seconds in (20.0, 40.0, 60.0, 180.0):
        pictures.append(stage.still(game, seconds=seconds - passed, frames=12))
        texts.append(f"{seconds:.0f} s of 25 mm/h, {wet(game):.2f} mm")
        passed = seconds
    set_weather(game, 2.0, 0.0)
    passed = 0.0
    for seconds in (60.0, 180.0, 420.0):
        pictures.append(stage.still(game, seconds=seconds - passed, frames=4))
        texts.append(f"{seconds / 60.0:.0f} min after it, {wet(game):.2f} mm")
        passed = seconds
    game.close()
    save_sheet(out, pictures, texts, columns=2, width=560)


def wet(game: Game) -> float:
    """mm that lie on level ground there."""
    return float(game.weather.sample((-1.3, game.place.height(-1.3, -43.0) + 0.5, -43.0)).wetness)


def lee(stage: Stage, out: Path) -> None:
    """The cabin's rain shadow, after two minutes of rain."""
    pictures, texts = [], []
    for wind in (0.0, 12.0):
        game = stage.game(preset=RAIN)
        set_weather(game, wind)
        (x, floor, z) = game.place.door
        stage.face((x + 9.5, floor + 3.2, z + 6.0), (x + 3.2, floor, z - 1.5))
        pictures.append(stage.still(game, seconds=120.0, frames=30))
        texts.append("no wind" if not wind else f"wind of {wind:.0f} m/s from the left")
        game.close()
    save_sheet(out, pictures, texts, columns=2, width=640)


SHEETS = {"hits": hits, "frames": frames, "puddles": puddles, "lee": lee}


def main(arguments: list[str]) -> int:
    """0, or 2 where an argument is missing or names no sheet."""
    return run_one(arguments, USAGE, SHEETS)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
