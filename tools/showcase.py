"""The picture in README: `python -m tools.showcase OUT.jpg [SCENE ...]`, moments of the demo."""

from __future__ import annotations

import sys
from collections.abc import Callable, Sequence
from pathlib import Path

import esper
import numpy as np
from numpy.typing import NDArray

from demo_game.game import Game
from demo_game.plays import SnowPlay
from demo_game.skies import seconds
from tools.stills import ALONG_THE_PATH, Stage, run, save_sheet
from weather_ecs.components import RainArea

USAGE = "usage: python -m tools.showcase OUT.jpg [SCENE ...]"
SNOWFALL = 60.0  # s of play
SNOWED = 0.5  # share of it at which the picture is taken
AFTERNOON, SUNSET = "2025-03-13T14:30:00Z", "2025-03-13T17:25:00Z"
STORM = 0.0, -7000.0  # x, z in m, of its rain, which ends short of the path
STRUCK = -80.0, 0.0, -900.0  # m

Picture = NDArray[np.uint8]


def opening(stage: Stage) -> Picture:
    """The game's first view: a shower ahead and its bow."""
    game = stage.opening()
    stage.settle(game)
    return _last(stage, game, 20)


def heavy(stage: Stage) -> Picture:
    """In the rain, after minutes of it."""
    game = stage.game(preset="heavy")
    stage.look(-2.6, -40.0, -19.0, -3.0)
    stage.settle(game, 60, 20)
    stage.still(game, seconds=150.0)
    return _last(stage, game, 30)


def strike(stage: Stage) -> Picture:
    """Lightning in the evening."""
    game = stage.game(preset="clear")
    game.changer.choose_whole("thunderstorm", 0.0)
    game.sky.be("dusk")
    stage.look(*ALONG_THE_PATH)
    whole = game.weather.whole
    assert whole is not None
    esper.component_for_entity(whole.entities["rain"], RainArea).center = STORM
    stage.settle(game)
    stage.still(game, seconds=20.0, frames=24)
    game.weather.strike(STRUCK)
    # The brightest of the frames that follow.
    shown = [stage.still(game, frames=1) for _ in range(8)]
    picture = shown[int(np.argmax([each.mean() for each in shown]))]
    game.close()
    return picture


def snow(stage: Stage) -> Picture:
    """Snow, when much of it lies."""
    game = stage.game(preset="light_snow", play=SnowPlay(SNOWFALL))
    stage.face((-0.5, 1.2, -46.5), (5.0, 1.3, -60.0))
    for k in range(round(30.0 * SNOWED * SNOWFALL)):
        game.update(1.0 / 30.0)
        if k % 10 == 0:
            stage.still(game, frames=1)
    return _last(stage, game, 8)


def sunset(stage: Stage) -> Picture:
    """Cumulus before a low sun."""
    stage.look(-2.0, -36.0, 84.0, 12.0)
    return _fair(stage, SUNSET, 45)


def above(stage: Stage) -> Picture:
    """Over the tops of cumulus."""
    stage.face((0.0, 2600.0, 600.0), (400.0, 1900.0, -3000.0))
    return _fair(stage, AFTERNOON, 90)


def _fair(stage: Stage, time: str, drawn: int) -> Picture:
    """Fair cumulus at a time, once so many frames have made the clouds' pictures."""
    game = stage.game(preset="clear")
    game.changer.choose_whole("fair_cumulus", 0.0)
    game.sky.atmosphere.time = seconds(time)
    stage.still(game, seconds=60.0, frames=1)
    stage.settle(game, drawn=drawn)
    return _last(stage, game, 20)


def _last(stage: Stage, game: Game, frames: int) -> Picture:
    """A game's last picture, after so many frames."""
    picture = stage.still(game, frames=frames)
    game.close()
    return picture


SCENES: dict[str, Callable[[Stage], Picture]] = {
    "a shower ahead": opening,
    "in the rain": heavy,
    "a thunderstorm": strike,
    "snow": snow,
    "a fair evening": sunset,
    "over the tops": above,
}


def draw(out: Path, names: Sequence[str]) -> None:
    """Render the picture, or only the scenes with these texts."""
    stage = Stage((1280, 720))
    shown = [(text, scene(stage)) for text, scene in SCENES.items() if not names or text in names]
    pictures, texts = [picture for _, picture in shown], [text for text, _ in shown]
    save_sheet(out, pictures, texts, columns=2, width=640, quality=78)


def main(arguments: Sequence[str]) -> int:
    """0, or 2 where there is no name for the picture, or of no scene."""
    known = all(name in SCENES for name in arguments[1:])
    return run(arguments if known else [], USAGE, draw)


if __name__ == "__main__":
    sys.exit(main(sys.argv[1:]))
