"""The game in a real window, walked through the edge of the rain with real keys and mouse."""

from __future__ import annotations

import json
import math
import subprocess
from collections.abc import Callable, Iterator
from pathlib import Path
from typing import Any

import pytest
from PIL import Image

from xvfb import Display, display, wait_until

pytestmark = [pytest.mark.window, pytest.mark.slow]

TESTS = Path(__file__).parent
SIZE = 480, 270  # small, so that software rendering is quick
PATIENCE = 240.0  # s, on the slowest machine


class Walk:
    """A running game: what it says of itself, and hands for its keys and mouse."""

    def __init__(self, screen: Display, folder: Path, *arguments: str) -> None:
        self.screen, self.folder = screen, folder
        self._log = folder / "log.jsonl"
        self._output = folder / "output.txt"
        self._lines: list[dict[str, Any]] = []
        self._read = 0  # bytes of the log that are in them
        self.process: subprocess.Popen[str] = screen.start(
            TESTS / "window_walk.py", self._log, *arguments, cwd=folder, log=self._output
        )

    def lines(self) -> list[dict[str, Any]]:
        """A line for every frame so far."""
        if self._log.exists():
            with self._log.open("rb") as log:
                log.seek(self._read)
                whole = log.read().rpartition(b"\n")
            self._read += len(whole[0]) + len(whole[1])
            self._lines += [json.loads(text) for text in whole[0].splitlines()]
        return self._lines

    def now(self) -> dict[str, Any]:
        assert self.process.poll() is None, self._output.read_text()[-4000:]
        return self.lines()[-1]

    def until(
        self, condition: Callable[[dict[str, Any]], bool], what: str, seconds: float = PATIENCE
    ) -> dict[str, Any]:
        """The first frame from now on of which `condition` is true."""
        seen = len(self.lines())

        def ask() -> dict[str, Any] | None:
            lines = self.lines()
            if self.process.poll() is not None:
                raise AssertionError(self._output.read_text()[-4000:])
            return next((line for line in lines[seen:] if condition(line)), None)

        return wait_until(ask, what, seconds)

    def open(self) -> None:
        """Wait for the window, make it small, give it the keys and the mouse."""
        try:
            self.window = self.screen.find_window(self.process, "The Walk")
        except AssertionError as error:
            raise AssertionError(f"{error}\n{self.text()[-4000:]}") from None
        self.screen.xdotool("windowsize", self.window, *SIZE)
        self.screen.xdotool("windowmove", self.window, 0, 0)
        self.until(lambda line: tuple(line["size"]) == SIZE, "the new size")
        self.screen.xdotool("mousemove", SIZE[0] // 2, SIZE[1] // 2)
        self.screen.xdotool("windowfocus", self.window)

    def key(self, name: str) -> None:
        self.screen.xdotool("key", name)

    def hold(self, *names: str) -> None:
        for name in names:
            self.screen.xdotool("keydown", name)

    def release(self, *names: str) -> None:
        for name in names:
            self.screen.xdotool("keyup", name)

    def text(self) -> str:
        return self._output.read_text(encoding="utf-8")

    def stop(self) -> None:
        if self.process.poll() is None:
            self.process.kill()
        self.process.wait(timeout=60)


@pytest.fixture
def walk(tmp_path: Path) -> Iterator[Walk]:
    with display() as screen:
        walk = Walk(screen, tmp_path, "--quality", "low", "--preset", "heavy")
        try:
            walk.open()
            yield walk
        finally:
            walk.stop()


def on(screen: str) -> Callable[[dict[str, Any]], bool]:
    return lambda line: line["screen"] == screen


def test_walk_into_the_rain_with_keys_and_mouse(walk: Walk) -> None:
    assert walk.now()["screen"] == "start"
    walk.key("Return")
    first = walk.until(on("play"), "play")
    assert first["mode"] == "far"
    assert first["rain_rate_here"] == 0.0

    # Look to the right and back. pyglet drops the first motion after it has taken the mouse.
    walk.screen.xdotool("mousemove_relative", "--", 3, 0)
    walk.screen.xdotool("mousemove_relative", "--", 80, 0)
    walk.until(lambda line: line["yaw"] < first["yaw"] - 0.05, "a turn to the right")
    walk.screen.xdotool("mousemove_relative", "--", -80, 0)
    walk.until(lambda line: abs(line["yaw"] - first["yaw"]) < 0.02, "a turn back")

    # Run north, through the edge of the rain.
    z = first["position"][2]
    walk.hold("Shift_L", "w")
    walk.until(lambda line: line["position"][2] < z - 5.0, "five metres")
    walk.until(lambda line: line["mode"] == "near", "the edge of the rain")
    inside = walk.until(lambda line: line["rain_rate_here"] > 5.0, "heavy rain")
    walk.release("w", "Shift_L")
    assert inside["drops_drawn"] > 0
    modes = [line["mode"] for line in walk.lines()]
    assert modes.index("near") > modes.index("far")

    # No frame jumps: the player moves, and is not moved.
    places = [line["position"] for line in walk.lines()]
    steps = [math.dist(a, b) for a, b in zip(places, places[1:], strict=False)]
    assert max(steps) < 2.5

    here = walk.until(lambda line: True, "a frame")["position"]
    walk.hold("s")
    walk.until(lambda line: line["position"][2] > here[2] + 0.5, "a step back")
    walk.release("s")


def test_screens_settings_and_the_end(walk: Walk) -> None:
    walk.key("Return")
    before = walk.until(on("play"), "play")
    assert before["backend"] == "compute"
    walk.key("F3")
    walk.until(lambda line: line["readout"] != before["readout"], "the readout")
    walk.key("m")
    walk.until(lambda line: line["map"] != before["map"], "the map")
    walk.key("1")
    walk.until(lambda line: line["preset"] == "clear", "clear weather")
    walk.key("6")
    walk.until(lambda line: line["preset"] == "cloudburst", "a cloudburst")

    walk.key("F12")
    pictures = walk.folder / "screenshots"
    saved = wait_until(lambda: sorted(pictures.glob("*.png")), "a picture", PATIENCE)
    walk.until(lambda line: True, "the end of the frame that saves it")
    with Image.open(saved[0]) as picture:
        assert picture.size == SIZE
        assert len(picture.convert("RGB").getcolors(SIZE[0] * SIZE[1]) or []) > 500

    walk.key("F1")
    walk.until(on("help"), "the help page")
    walk.key("Escape")
    walk.until(on("play"), "back from help")

    walk.key("Escape")
    paused = walk.until(on("pause"), "the pause menu")
    walk.hold("d")
    walk.key("Down")
    walk.until(lambda line: True, "a frame")
    walk.release("d")
    assert walk.until(lambda line: True, "a frame")["position"] == paused["position"]
    # The first Down led to the quality; the next one leads to the rain engine.
    walk.key("Right")
    walk.until(lambda line: line["quality"] == "medium", "medium quality")
    walk.key("Down")
    walk.key("Left")
    walk.until(lambda line: line["backend"] == "feedback", "the other backend")
    walk.key("Escape")
    walk.until(on("play"), "back from the menu")

    walk.key("Escape")
    walk.until(on("pause"), "the pause menu")
    walk.key("Up")  # from the first row to the last one: quit
    walk.key("Return")
    wait_until(lambda: walk.process.poll() is not None, "the end of the game", PATIENCE)
    assert walk.process.returncode == 0
    assert "Traceback" not in walk.text()
