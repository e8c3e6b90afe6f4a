"""The letter in a real window: lost once and delivered once, with real keys and mouse."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path

import pytest

from demo_game.settings import LOOK_SPEED
from test_window_walk import Walk, on
from xvfb import display

pytestmark = [pytest.mark.window, pytest.mark.slow]

START = 6.0, -60.7  # in the cabin, inside the door
TABLE = [(5.5, -61.9)]
OUT = [(6.0, -60.4), (6.0, -54.6)]  # through the door and down the steps
WAY = [(-2.0, -57.0), (-5.0, -66.0), (-8.0, -86.0), (-9.5, -104.0), (-13.0, -124.0),
       (-19.0, -144.0), (-24.6, -159.4)]  # fmt: skip
MAILBOX = [(-25.0, -160.0)]
FARTHEST = 200  # px in one motion: the mouse must not meet the screen's edge


@pytest.fixture
def walk(tmp_path: Path) -> Iterator[Walk]:
    start = f"--start={START[0]},{START[1]}"
    with display() as screen:
        walk = Walk(screen, tmp_path, "--quality", "low", "--preset", "cloudburst", start)
        try:
            walk.open()
            yield walk
        finally:
            walk.stop()


def go(walk: Walk, points: list[tuple[float, float]], reach: float) -> None:
    """Hold W and steer with the mouse from point to point, until the letter's story ends."""
    walk.hold("w")
    for x, z in points:
        while True:
            line = walk.until(lambda line: True, "a frame")
            px, _, pz = line["position"]
            if line["screen"] != "play" or math.hypot(x - px, z - pz) < reach:
                break
            turn = math.atan2(px - x, pz - z) - line["yaw"]
            turn = (turn + math.pi) % math.tau - math.pi
            if abs(turn) > 0.02:
                counts = round(-turn / LOOK_SPEED)
                counts = min(max(counts, -FARTHEST), FARTHEST)
                walk.screen.xdotool("mousemove_relative", "--", counts, 0)
                walk.until(lambda line: True, "the turn")
    walk.release("w")


def test_a_letter_is_lost_and_another_one_delivered(walk: Walk) -> None:
    assert walk.now()["letter"] == "lying"
    walk.key("Return")
    walk.until(on("play"), "play")
    walk.screen.xdotool("mousemove_relative", "--", 3, 0)  # pyglet drops the first motion
    go(walk, TABLE, 0.4)
    taken = walk.until(lambda line: line["letter"] == "carried", "the letter")
    assert taken["wetness"] == 0.0

    # Out into the cloudburst, and stand there.
    go(walk, OUT, 0.5)
    lost = walk.until(on("end"), "the end of the first letter")
    assert lost["letter"] == "ruined"
    assert lost["wetness"] == 1.0
    indoors = [line for line in walk.lines() if line["position"][2] < -59.6]
    assert all(line["wetness"] == 0.0 for line in indoors)
    carried = [line["wetness"] for line in walk.lines() if line["letter"] == "carried"]
    assert carried and carried == sorted(carried)

    # Another one, in light rain, and run.
    walk.key("Return")
    again = walk.until(on("play"), "another letter")
    assert (again["letter"], again["wetness"]) == ("lying", 0.0)
    assert math.dist(again["position"][::2], START) < 0.1
    walk.key("3")
    walk.screen.xdotool("mousemove_relative", "--", 3, 0)
    go(walk, TABLE, 0.4)
    walk.until(lambda line: line["letter"] == "carried", "the second letter")
    go(walk, OUT, 0.5)
    walk.hold("Shift_L")
    go(walk, WAY, 1.5)
    go(walk, MAILBOX, 0.2)  # until the letter is in it
    walk.release("Shift_L")
    won = walk.until(on("end"), "the mailbox")
    assert won["letter"] == "delivered"
    assert 0.0 < won["wetness"] < 0.5

    walk.key("Escape")
    assert walk.until(on("play"), "the walk after it")["letter"] == "delivered"
    assert walk.process.poll() is None
    assert "Traceback" not in walk.text()
