"""Occluders that are there for less than a frame, whichever way they go."""

from __future__ import annotations

from types import SimpleNamespace

import esper
import moderngl
import numpy as np
import pytest

from tests.boxes import CORNERS, TRIANGLES, placed
from tests.splash_scenes import scene
from tests.weather_pictures import Stage, stage
from weather_ecs.components import Occluder
from weather_ecs.systems import queries


def brief(number: int) -> Occluder:
    """Roofs over everything: still ones, moving ones, and some that draw themselves."""
    roof = placed((0.0, 6.0, 0.0), (40.0, 0.2, 40.0))
    if number % 3 == 2:

        def draw_nothing_more(matrix: np.ndarray) -> None:
            raise AssertionError("it was deleted before anything was drawn")

        return Occluder(draw=draw_nothing_more)
    return Occluder(CORNERS, TRIANGLES, roof, dynamic=bool(number % 2))


def depths(it: Stage) -> np.ndarray:
    renderer = it.weather._renderer
    assert renderer is not None
    heightmap = renderer.heightmap()
    assert heightmap is not None
    return np.frombuffer(heightmap.texture.read(), np.float32).copy()


@pytest.mark.parametrize("at_once", [False, True])
@pytest.mark.parametrize("late", [False, True])
def test_occluders_that_come_and_go_within_a_frame_are_never_met(
    ctx: moderngl.Context, caplog: pytest.LogCaptureFixture, at_once: bool, late: bool
) -> None:
    found = []
    for busy in (False, True):
        with stage(ctx, quality="low") as it:
            scene()
            for number in range(18):
                if late:
                    esper.process(1 / 30)
                if busy:
                    entity = esper.create_entity(brief(number))
                    assert not it.weather.sample((0.0, 9.0, 0.0)).sheltered
                    esper.delete_entity(entity, immediate=at_once)
                if not late:
                    esper.process(1 / 30)
                assert not it.weather.sample((0.0, 1.0, 0.0)).sheltered
                it.draw()
            found.append((depths(it), it.weather.stats.impacts > 0))
    assert np.array_equal(found[0][0], found[1][0])
    assert found[1][1]
    assert not caplog.records


def test_deletions_are_found_where_esper_does_not_list_them(
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    other = SimpleNamespace(entity_exists=lambda entity: entity != 2)
    monkeypatch.setattr(queries, "esper", other)
    assert (queries.leaving([1, 2, 3]), queries.leaving([1, 3])) == (1, 0)
