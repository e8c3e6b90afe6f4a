"""Runs the example of the README as it stands: `window_readme.py OUT` saves what its window shows.

Stands in only for what the reader brings: a scene, a view, a projection, and somebody who closes
the window when it has rained for a while.
"""

from __future__ import annotations

import re
import sys
from pathlib import Path
from typing import Any

import numpy as np
import pyglet

from window_host import camera, screenshot

README = Path(__file__).parent.parent / "README.md"
LONGEST = 60.0  # s


def example() -> str:
    found = re.findall(r"^```python\n(.*?)^```", README.read_text(encoding="utf-8"), re.M | re.S)
    assert found, "no example in README.md"
    return found[0]


def main(out: str) -> None:
    view, projection = camera((1280, 720))
    names: dict[str, Any] = {"view": view, "projection": projection}
    drawn: list[np.ndarray] = []
    names["draw_my_scene"] = lambda: drawn.append(screenshot())

    def look(_: float) -> None:
        window, weather = names["window"], names["weather"]
        if len(drawn) < 10 or weather.stats.drops_drawn == 0:
            return
        pyglet.clock.unschedule(look)
        window.switch_to()
        window.dispatch_event("on_draw")
        np.savez(out, before=drawn[-1], after=screenshot())
        pyglet.app.exit()

    pyglet.clock.schedule_interval(look, 0.01)
    pyglet.clock.schedule_once(lambda _: sys.exit("it never rained"), LONGEST)
    exec(compile(example(), "the README's example", "exec"), names)
    names["weather"].close()


if __name__ == "__main__":
    main(sys.argv[1])
