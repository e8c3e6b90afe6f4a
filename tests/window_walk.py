"""The game in its real window, telling what happens: `window_walk.py LOG [ARGUMENTS of the game]`.

Adds nothing to the game but a line of JSON per frame in LOG, and draws fewer frames than it could:
how far one walks goes by the clock, and other tests run beside it.
"""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

from demo_game import cli, window

PACE = 1.0 / 20.0  # s between frames at least


def line(game_window: Any) -> dict[str, Any]:
    game = game_window.game
    stats = game.weather.stats
    return {
        "screen": game_window.screens.shown.value,
        "size": game_window.get_size(),
        "position": game.player.position.tolist(),
        "yaw": game.player.yaw,
        "preset": game.state,
        "letter": game.letter.state.value,
        "wetness": game.letter.wetness,
        "readout": game_window.overlay.show_readout,
        "map": game_window.overlay.show_map,
        "mode": stats.mode,
        "backend": game.weather.backend,
        "quality": game.weather.quality,
        "rain_rate_here": stats.rain_rate_here,
        "drops_drawn": stats.drops_drawn,
    }


def main(log: str, *arguments: str) -> int:
    plain = window.GameWindow.frame
    window.FASTEST = PACE
    with Path(log).open("w", encoding="utf-8") as out:

        def frame(self: Any, dt: float) -> None:
            plain(self, dt)
            if self.ready:
                out.write(json.dumps(line(self)) + "\n")
                out.flush()

        window.GameWindow.frame = frame  # type: ignore[method-assign]
        return cli.main(list(arguments))


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
