"""From the room the outside is drawn where door and windows show it, and nowhere else."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from demo_game.place import Place, cabin
from demo_game.render import Environment, SceneRenderer, openings
from demo_game.render.openings import NOTHING, WHOLE, Openings
from tests.demo_views import look, perspective

SIZE = (160, 90)


@pytest.fixture(scope="module")
def place() -> Place:
    return Place()


def from_room(place: Place, ahead: tuple[float, float, float]) -> tuple[NDArray, NDArray]:
    """Eye 1.6 m over the middle of the floor, and the view of it that looks ahead."""
    eye = place.cabin_origin + (0.3, 1.6, 0.4)
    return eye, look(tuple(eye), tuple(eye + ahead))


def test_outside_there_is_no_limit(place: Place) -> None:
    found = Openings(place)
    for away in ((0.0, 1.6, 4.0), (8.0, 1.6, 0.0), (0.0, 9.0, 0.0), (0.0, 1.6, 2.45)):
        eye = place.cabin_origin + away
        assert found.frame(eye, perspective() @ look(tuple(eye), (0.0, 5.0, 900.0))) == WHOLE


def test_a_window_is_within_the_frame_and_a_bare_wall_shows_nothing(place: Place) -> None:
    _, low, high, first, last = next(it for it in cabin.WINDOWS if it[0] == "back")
    eye, view = from_room(place, (0.6, -0.1, -2.6))
    matrix = perspective(30.0) @ view
    frame = Openings(place).frame(eye, matrix)
    height = (first + last) / 2.0 * cabin.ROW
    pane = place.cabin_origin + (-(low + high) / 2.0, height, -cabin.DEPTH / 2.0)
    x, y, _, w = matrix @ (*pane, 1.0)
    assert frame[0] < x / w < frame[2]
    assert frame[1] < y / w < frame[3]
    assert (frame[2] - frame[0]) * (frame[3] - frame[1]) < 3.0  # of the 4 that are all of it
    eye, view = from_room(place, (0.4, -3.0, 0.2))  # at the floor
    assert Openings(place).frame(eye, perspective(30.0) @ view) == NOTHING


def test_the_picture_is_the_same_as_without(
    ctx: moderngl.Context, keep: Callable[[Any], Any], place: Place, monkeypatch: pytest.MonkeyPatch
) -> None:
    target = keep(ctx.framebuffer([keep(ctx.texture(SIZE, 4))], keep(ctx.depth_texture(SIZE))))
    scene = SceneRenderer(ctx, place, "low")
    try:
        ways = [(np.sin(turn), -0.1, np.cos(turn)) for turn in np.arange(8) * np.pi / 4.0]
        pictures = []
        for limited in (True, False):
            if not limited:
                monkeypatch.setattr(openings.Openings, "frame", lambda *_: WHOLE)
            for way in ways:
                _, view = from_room(place, way)
                scene.draw(target, view, perspective(), 5.0, Environment(lamps=0.3))
                pictures.append(np.frombuffer(target.read(components=3), "u1").astype(int))
        for ours, theirs in zip(pictures[:8], pictures[8:], strict=True):
            assert (np.abs(ours - theirs) > 8).mean() < 0.002
            assert ours.std() > 5.0
    finally:
        scene.release()
