"""What stands near the place that lightning looks for: corners of meshes, surfaces below."""

from __future__ import annotations

import esper
import numpy as np
import pytest

from weather_ecs.components import Occluder
from weather_ecs.systems.strike_place import tips_near

pytestmark = pytest.mark.usefixtures("world")

# A roof of 4 m by 4 m, as two triangles, 3 m up.
ROOF = np.array([(-2, 3, -2), (2, 3, -2), (2, 3, 2), (-2, 3, 2)], np.float32)
FACES = np.array([0, 1, 2, 0, 2, 3], np.uint32)


def moved(x: float, y: float, z: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, 3] = x, y, z
    return matrix


def found(x: float, z: float, reach: float) -> set[tuple[float, ...]]:
    return {tuple(np.round(tip, 6).tolist()) for tip in tips_near(x, z, reach)}


def test_nothing_stands_in_an_empty_world() -> None:
    assert tips_near(0.0, 0.0, 100.0).shape == (0, 3)


def test_corners_within_reach_and_the_surface_below() -> None:
    esper.create_entity(Occluder(ROOF, FACES, moved(10.0, 1.0, 0.0)))
    assert found(10.0, 0.5, 1.0) == {(10.0, 4.0, 0.5)}  # no corner as near as that
    assert found(12.0, 2.0, 0.5) == {(12.0, 4.0, 2.0)}
    corners = {(x, 4.0, z) for x in (8.0, 12.0) for z in (-2.0, 2.0)}
    assert found(10.0, 0.5, 50.0) == corners | {(10.0, 4.0, 0.5)}


def test_what_is_far_and_what_draws_itself_is_not_seen() -> None:
    esper.create_entity(Occluder(ROOF, FACES, moved(200.0, 0.0, 0.0)))
    esper.create_entity(Occluder(draw=lambda *_: None, transform=moved(0.0, 0.0, 0.0)))
    assert found(0.0, 0.0, 100.0) == set()
    assert len(found(0.0, 0.0, 250.0)) == 4
