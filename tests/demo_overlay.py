"""Lays out every screen of the game in a real window, at several sizes; prints what is wrong.

Run on a display: `demo_overlay.py [FOLDER for pictures]`.
"""

from __future__ import annotations

import json
import sys
import time
from pathlib import Path
from typing import Any

from demo_game.display import make_window
from demo_game.letter import RUINED_AT, Letter
from demo_game.pictures import save_png
from demo_game.screens import Screen
from demo_game.settings import Settings
from demo_game.ui.surface import prepare_for_pyglet, read_pixels
from demo_game.ui.theme import Text

# Screens, each with how wet the letter is
SHOWN = (
    *((screen, 0.62) for screen in Screen),
    (Screen.END, 1.0),
    (Screen.PLAY, 0.1),
    (Screen.PLAY, 0.9),
)
SIZES = ((1280, 720), (640, 360), (800, 600), (900, 360))


def layers(overlay: Any) -> list[Any]:
    """What the overlay has laid out for the screen it drew last."""
    found = [view._layer for view in overlay._views.values()]
    return found + ([overlay._message._layer] if overlay._message._layer else [])


def box(text: Any) -> tuple[float, float, float, float]:
    label = text._label
    return label.left, label.bottom, label.right, label.top


def problems(layer: Any, size: tuple[int, int]) -> list[str]:
    texts = [thing for thing in layer._things if isinstance(thing, Text) and thing._text.strip()]
    boxes = [(text._text, box(text)) for text in texts]
    found = []
    panels = layer.panels
    for name, (left, bottom, right, top) in boxes:
        if left < 0 or bottom < 0 or right > size[0] or top > size[1]:
            found.append(f"{name!r} leaves the window")
        if panels and not any(
            p.x <= left and right <= p.right and p.y <= bottom + 3 and top - 3 <= p.top
            for p in panels
        ):
            found.append(f"{name!r} leaves its panel")
    for index, (name, a) in enumerate(boxes):
        for other, b in boxes[index + 1 :]:
            if min(a[2], b[2]) > max(a[0], b[0]) + 1 and min(a[3], b[3]) > max(a[1], b[1]) + 4:
                found.append(f"{name!r} lies over {other!r}")
    for panel in panels:
        if panel.x < 0 or panel.y < 0 or panel.right > size[0] or panel.top > size[1]:
            found.append("a panel leaves the window")
    return found


def bring(letter: Letter, wetness: float, to_its_end: bool) -> None:
    """A letter that is carried and so wet, or at the mailbox, or ruined."""
    letter.again()
    dry = {"speed": 0.0, "rain_rate": 0.0, "sheltered": False}
    letter.update(0.0, letter._table, **dry)
    letter.water = wetness * RUINED_AT
    wet = {"speed": 0.0, "rain_rate": 3.0, "sheltered": False}
    letter.update(0.001, letter._mailbox if to_its_end else (0.0, 0.0, 0.0), **wet)


def main(folder: str | None = None) -> None:
    window = make_window(Settings(quality="low"))
    overlay, game = window.overlay, window.game
    game.update(1 / 60)
    report: dict[str, Any] = {"problems": [], "changed": {}}
    for size in SIZES:
        window.set_size(*size)
        for _ in range(3):  # until display and driver have followed
            window.dispatch_events()
            window.draw(0.0)
            time.sleep(0.02)
        overlay.resize(*size)
        target = window._gl.detect_framebuffer(0)
        target.viewport = (0, 0, *size)
        game.draw(target)
        color = window._gl.renderbuffer(size, 4)
        kept = window._gl.framebuffer([color])
        window._gl.copy_framebuffer(kept, target)
        plain = read_pixels(*size).astype("i2")
        for screen, wetness in SHOWN:
            overlay.show_readout = overlay.show_map = True
            overlay.say("Drizzle: fine drops that barely wet the ground")
            bring(game.letter, wetness, screen is Screen.END)
            window._gl.copy_framebuffer(target, kept)
            prepare_for_pyglet(window)
            overlay.draw(screen, game, 1234.5)
            after = read_pixels(*size)
            where = f"{screen.value} {wetness:g} {size[0]}"
            if window._gl.error != "GL_NO_ERROR":
                report["problems"].append(f"{where}: OpenGL error")
            for layer in layers(overlay):
                report["problems"] += [f"{where}: {text}" for text in problems(layer, size)]
            report["changed"][where] = float((abs(after - plain).max(axis=2) > 8).mean())
            if folder:
                save_png(
                    Path(folder) / f"{screen.value}_{wetness:g}_{size[0]}x{size[1]}.png", after
                )
        kept.release()
        color.release()
    window.close()
    print(json.dumps(report))


if __name__ == "__main__":
    main(*sys.argv[1:])
