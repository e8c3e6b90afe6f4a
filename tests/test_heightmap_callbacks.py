"""Callbacks that draw into the heightmap, and meshes that it refuses."""

from __future__ import annotations

import logging
import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import moderngl
import numpy as np
import pytest

from tests.boxes import box, placed
from tests.heightmap_stage import HERE, Maps, assert_as_rays
from weather_ecs.components import Occluder
from weather_ecs.errors import InvalidValueError
from weather_ecs.frame import OccluderData


@pytest.fixture
def maps(ctx: moderngl.Context) -> Iterator[Maps]:
    made = Maps(ctx)
    yield made
    made.release()


# Callbacks of the game


def drawing(maps: Maps, transform: np.ndarray, calls: list[np.ndarray]) -> Any:
    """A callback that draws a box by itself, with the matrix it is given."""
    mesh = box(77, transform)

    def draw(matrix: np.ndarray) -> None:
        calls.append(matrix)
        maps.meshes.draw([mesh], matrix)

    return draw


def test_a_callback_draws_with_the_matrix_it_gets(maps: Maps) -> None:
    calls: list[np.ndarray] = []
    transform = placed((0.0, 2.0, 0.0), (2, 2, 2), 0.7)
    it = OccluderData(0, np.eye(4), False, draw=drawing(maps, transform, calls))
    maps.capture(it, wind=(3.0, 0.0, 0.0))
    assert_as_rays(maps, [transform])
    assert calls[0].shape == (4, 4)
    # Static: once. Dynamic: at every frame, since nobody knows whether it has moved.
    assert not maps.capture(it, wind=(3.0, 0.0, 0.0)) and len(calls) == 1
    moving = replace(it, dynamic=True)
    for _ in range(3):
        assert maps.capture(moving, wind=(3.0, 0.0, 0.0))
    assert len(calls) == 4


def test_another_callback_is_seen(maps: Maps) -> None:
    first = OccluderData(0, np.eye(4), False, draw=drawing(maps, placed(HERE, (1, 1, 1)), []))
    maps.capture(first)
    second = replace(first, draw=drawing(maps, placed((9.0, 4.0, 0.0), (1, 1, 1)), []))
    assert maps.capture(second)
    assert maps.at(9.0, 0.0) == pytest.approx(5.0) and maps.at(3.0, -5.0) == -math.inf


def test_what_a_callback_does_to_the_matrix_stays_its_own_affair(maps: Maps) -> None:
    def spoil(matrix: np.ndarray) -> None:
        matrix[:] = np.nan

    transform = placed((0.0, 2.0, 0.0), (2, 2, 2))
    maps.capture(OccluderData(0, np.eye(4), False, draw=spoil), box(1, transform))
    assert_as_rays(maps, [transform])


@pytest.mark.parametrize("dynamic", [False, True])
def test_a_callback_that_raises_is_named_and_left_out(
    maps: Maps, caplog: pytest.LogCaptureFixture, dynamic: bool
) -> None:
    calls = []

    def draw_broken_windmill(matrix: np.ndarray) -> None:
        calls.append(matrix)
        raise RuntimeError("a blade came off")

    transform = placed((0.0, 2.0, 0.0), (2, 2, 2))
    broken = OccluderData(0, np.eye(4), dynamic, draw=draw_broken_windmill)
    with caplog.at_level(logging.ERROR, "weather_ecs"):
        for _ in range(4):
            maps.capture(broken, box(1, transform))
    assert len(calls) == 1 and len(caplog.records) == 1
    assert "draw_broken_windmill" in caplog.text and "a blade came off" in caplog.text
    assert_as_rays(maps, [transform])


def test_one_that_was_mended_is_drawn_again(maps: Maps, caplog: pytest.LogCaptureFixture) -> None:
    class Windmill:
        def draw(self, matrix: np.ndarray) -> None:
            raise RuntimeError("a blade came off")

    mill, mended = Windmill(), drawing(maps, placed(HERE, (1, 1, 1)), [])
    broken = OccluderData(0, np.eye(4), True, draw=mill.draw)
    with caplog.at_level(logging.ERROR, "weather_ecs"):
        for _ in range(3):
            maps.capture(replace(broken, draw=mill.draw))  # the same function, if another object
    assert len(caplog.records) == 1
    assert maps.at(HERE[0], HERE[2]) == -math.inf
    maps.capture(replace(broken, draw=mended))
    assert maps.at(HERE[0], HERE[2]) > -math.inf


def test_a_callback_that_draws_nothing(maps: Maps) -> None:
    maps.capture(OccluderData(0, np.eye(4), True, draw=lambda matrix: None))
    assert (maps.depth() == 1.0).all()


@pytest.mark.parametrize("dynamic", [False, True])
def test_a_callback_that_changes_state_does_no_harm(
    maps: Maps, ctx: moderngl.Context, dynamic: bool
) -> None:
    elsewhere = ctx.simple_framebuffer((16, 16))

    def leave_a_mess(matrix: np.ndarray) -> None:
        elsewhere.use()
        elsewhere.viewport = (1, 2, 3, 4)
        elsewhere.scissor = (0, 0, 2, 2)
        ctx.enable_only(moderngl.CULL_FACE | moderngl.BLEND)
        ctx.cull_face, ctx.depth_func = "front_and_back", ">"
        maps.guard.gl.glDepthMask(0)
        maps.guard.gl.glUseProgram(0)

    house, walker = placed((0.0, 2.0, 0.0), (2, 2, 2)), placed((9.0, 1.0, 0.0), (1, 1, 1))
    mess = OccluderData(1, np.eye(4), dynamic, draw=leave_a_mess)
    for _ in range(2):
        maps.capture(mess, box(0, house), mess, box(2, walker, dynamic=True))
    assert_as_rays(maps, [house, walker])
    for thing in (*elsewhere.color_attachments, elsewhere.depth_attachment, elsewhere):
        thing.release()


# Bad meshes never come so far


@pytest.mark.parametrize(
    "fields",
    [
        {"vertices": np.full((3, 3), np.nan), "indices": [0, 1, 2]},
        {"vertices": np.eye(3), "indices": [0, 1, 3]},
        {"vertices": np.eye(3), "indices": []},
        {"vertices": np.eye(3), "indices": [0, 1, 2], "transform": np.zeros((4, 4))},
        {"vertices": np.eye(3), "indices": [0, 1, 2], "transform": np.diag([1.0, 0.0, 1.0, 1.0])},
        {"vertices": np.eye(3), "indices": [0, 1, 2], "transform": np.full((4, 4), np.inf)},
    ],
)
def test_singular_and_broken_meshes_are_refused(fields: dict[str, Any]) -> None:
    with pytest.raises(InvalidValueError):
        Occluder(**fields)
    sound = Occluder(np.eye(3), [0, 1, 2])
    changes = [*fields.items()]
    with pytest.raises(InvalidValueError):
        [setattr(sound, name, value) for name, value in changes]
    assert np.isfinite(sound.vertices).all() and np.linalg.det(sound.transform) != 0.0
