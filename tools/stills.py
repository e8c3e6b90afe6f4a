"""Stills of the demo's walk, and sheets of them with a line of text under each. Needs Pillow."""

from __future__ import annotations

import math
import textwrap
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

import numpy as np
from numpy.typing import NDArray

from demo_game.camera import Pose
from demo_game.game import Game
from demo_game.headless import make_context
from demo_game.place import Place
from demo_game.plays import Play
from demo_game.settings import Settings

SIZE = (960, 540)  # px
EYE = 1.7  # m
ALONG_THE_PATH = (0.0, 39.0, 0.0, 8.0)  # x, z in m, yaw and pitch in degrees
LETTERS = 15  # px, of the text


class Standing:
    """In place of a tour: a pose that stays until it is set."""

    name = "stills"

    def __init__(self) -> None:
        self.play: Play | None = None
        self.at = Pose((0.0, EYE, 0.0), 0.0, 0.0)

    def pose(self, time: float) -> Pose:
        """Where one stands."""
        return self.at

    def stage(self, time: float) -> str:
        """There is but one."""
        return ""


class Stage:
    """One place and one framebuffer, for as many games as a sheet asks for."""

    def __init__(self, size: tuple[int, int] = SIZE, quality: str = "high") -> None:
        self.size, self.quality = size, quality
        self._ctx, self._place = make_context(), Place(0)
        color, depth = self._ctx.renderbuffer(size), self._ctx.depth_renderbuffer(size)
        self._target = self._ctx.framebuffer([color], depth)
        self._standing = Standing()

    def game(self, play: Play | None = None, **options: Any) -> Game:
        """A game that stands still, with a course of weather if there is to be one."""
        self._standing.play = play
        return Game(
            self._ctx,
            Settings(quality=self.quality),
            place=self._place,
            tour=self._standing,
            **options,
        )

    def opening(self) -> Game:
        """A game as one begins to play it, where it puts one."""
        return Game(self._ctx, Settings(quality=self.quality), place=self._place)

    def look(self, x: float, z: float, yaw: float, pitch: float) -> None:
        """Stand at (x, z) in m and look along a yaw and a pitch in degrees."""
        y = float(self._place.height(x, z)) + EYE
        self._standing.at = Pose((x, y, z), math.radians(yaw), math.radians(pitch))

    def face(self, eye: Sequence[float], target: Sequence[float]) -> None:
        """Be at a place and look at another, both (x, y, z) in m."""
        dx, dy, dz = (b - a for a, b in zip(eye, target, strict=True))
        pitch = math.atan2(dy, math.hypot(dx, dz))
        at = float(eye[0]), float(eye[1]), float(eye[2])
        self._standing.at = Pose(at, math.atan2(-dx, -dz), pitch)

    def settle(self, game: Game, lit: int = 90, drawn: int = 45) -> None:
        """Let every cloud be lit anew as the sun stands now, and its picture be made anew.

        Both are done for a few clouds a frame.
        """
        for k in range(lit + drawn):
            game.update(1.0e-4)
            if k >= lit:
                game.draw(self._target)

    def still(self, game: Game, *, seconds: float = 0.0, frames: int = 4) -> NDArray[np.uint8]:
        """(height, width, 3) after so many seconds of weather, of which the last are drawn."""
        for _ in range(int(seconds / 0.25)):
            game.update(0.25)
        for _ in range(frames):
            game.update(1.0 / 30.0)
            game.draw(self._target)
        raw = np.frombuffer(self._target.read(components=3), np.uint8)
        return raw.reshape(self.size[1], self.size[0], 3)[::-1]


def save_sheet(
    path: Path,
    pictures: Sequence[NDArray[np.uint8]],
    texts: Sequence[str],
    *,
    columns: int = 2,
    width: int = 640,
    lines: int = 1,
    quality: int = 80,
) -> None:
    """Pictures side by side with their texts under them; JPEG or PNG by the name."""
    from PIL import Image, ImageDraw, ImageFont

    font = ImageFont.load_default(LETTERS)
    high = round(width * pictures[0].shape[0] / pictures[0].shape[1])
    cell = high + lines * (LETTERS + 4) + 8
    rows = -(-len(pictures) // columns)
    sheet = Image.new("RGB", (columns * width, rows * cell), (18, 18, 20))
    pen = ImageDraw.Draw(sheet)
    for k, (picture, text) in enumerate(zip(pictures, texts, strict=True)):
        x, y = k % columns * width, k // columns * cell
        small = Image.fromarray(picture).resize((width, high), Image.Resampling.LANCZOS)
        sheet.paste(small, (x, y))
        letters = int(len(text) * (width - 12) / max(font.getlength(text), 1.0))
        wrapped = textwrap.wrap(text, letters)[:lines]
        pen.text((x + 6, y + high + 3), "\n".join(wrapped), (222, 222, 222), font)
    path.parent.mkdir(parents=True, exist_ok=True)
    if path.suffix.lower() in (".jpg", ".jpeg"):
        sheet.save(path, quality=quality)
    else:
        sheet.save(path)


def run(
    arguments: Sequence[str], usage: str, draw: Callable[[Path, list[str]], None], least: int = 1
) -> int:
    """A script's end: draws into the file that its first argument names."""
    import sys

    if len(arguments) < least:
        print(usage, file=sys.stderr)
        return 2
    draw(Path(arguments[0]), list(arguments[1:]))
    return 0


def run_one(
    arguments: Sequence[str], usage: str, sheets: Mapping[str, Callable[[Stage, Path], None]]
) -> int:
    """The same of a script with sheets by name: `OUT NAME`; 2 where a name is missing or none."""

    def draw(out: Path, names: list[str]) -> None:
        sheets[names[0]](Stage(), out)

    known = len(arguments) > 1 and arguments[1] in sheets
    return run(arguments if known else [], usage, draw, least=2)
