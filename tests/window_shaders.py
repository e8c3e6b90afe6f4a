"""Runs the game of docs/shaders.md as it stands: `window_shaders.py OUT` saves what it shows.

Two pictures: in the rain, and after snow has fallen for a while, which T brings. Somebody else has
to close the window, and has no patience.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pyglet
from pyglet.window import key

from window_host import screenshot

PAGE = Path(__file__).parent.parent / "docs" / "shaders.md"
LONGEST = 120.0  # s
HURRY = 20.0  # times as fast as life
DEEP = 0.003  # m of snow


def main(out: str) -> None:
    (code,) = re.findall(r"^```python\n(.*?)^```", PAGE.read_text(encoding="utf-8"), re.M | re.S)
    names: dict[str, Any] = {}
    pictures: list[np.ndarray] = []

    def shoot() -> None:
        names["window"].switch_to()
        names["window"].dispatch_event("on_draw")
        pictures.append(screenshot())

    def look(_: float) -> None:
        weather = names["weather"]
        if weather.stats.drops_drawn == 0:
            return
        if not pictures:
            shoot()
            names["on_key_press"](key.T, 0)
            weather.speed = HURRY
        elif weather.sample((0.0, 0.5, -4.0)).snow_depth > DEEP:
            shoot()
            pyglet.clock.unschedule(look)
            np.savez(out, rain=pictures[0], snow=pictures[1])
            pyglet.app.exit()

    pyglet.clock.schedule_interval(look, 0.05)
    pyglet.clock.schedule_once(lambda _: sys.exit("it never snowed"), LONGEST)
    exec(compile(code, str(PAGE), "exec"), names)
    names["weather"].close()


if __name__ == "__main__":
    main(sys.argv[1])
