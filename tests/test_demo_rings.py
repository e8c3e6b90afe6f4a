"""Rings that rain makes on puddles of the trails."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import moderngl
import numpy as np
from numpy.typing import NDArray

from demo_game.place import Place, rings
from demo_game.render import Environment, SceneRenderer
from demo_game.render.drips import RINGS_SEEN
from tests.demo_views import look, perspective

SIZE = (240, 135)
DRY = Environment(lamps=0.3)
RAIN = replace(DRY, rain_areas=[((0.0, -40.0), (70.0, 60.0), 0.0, 25.0, 62.0)])
PUDDLES = replace(DRY, wetness=1.0)  # that are left when rain has ended


def test_places_are_on_bare_ground_all_along_the_trails(place: Place) -> None:
    found = rings.sites(place.terrain, place.meadow)
    x, y, z = found.T
    assert np.allclose(y, place.height(x, z), atol=1e-6)
    assert (np.diff(z) <= 0.0).all()  # so that those near a camera are one stretch
    on_trail = place.terrain.trail_distance(found[:, [0, 2]]) < 3.0
    near_path = np.abs(z + 20.0) < 20.0  # where nothing but the path is bare
    assert near_path.sum() > 500 and on_trail[near_path].mean() > 0.95
    crowd = np.histogram(z, bins=np.arange(-140.0, 80.0, 10.0))[0]
    assert crowd.min() > 100


def test_rings_come_with_the_rain_and_go_with_it(
    ctx: moderngl.Context, place: Place, keep: Callable[[Any], Any]
) -> None:
    color, depth = keep(ctx.texture(SIZE, 4)), keep(ctx.depth_renderbuffer(SIZE))
    target = keep(ctx.framebuffer([color], depth))
    scene = keep(SceneRenderer(ctx, place, "low"))
    eye = (-0.5, place.height(-0.5, -14.0) + 1.7, -14.0)
    view = look(eye, (0.2, eye[1] - 1.7, -17.5))
    drawn = scene._rings.draw

    def shown(environment: Environment, time: float) -> NDArray:
        pictures = []
        for draw in (drawn, lambda *_: None):
            scene._rings.draw = draw
            scene.draw(target, view, perspective(), time, environment)
            raw = np.frombuffer(target.read(components=3, alignment=1), "u1")
            pictures.append(raw.reshape(SIZE[1], SIZE[0], 3)[::-1].astype("f8"))
        return np.asarray(pictures[0] - pictures[1])

    for still in (DRY, PUDDLES):
        assert not shown(still, 4.0).any()
    first = shown(RAIN, 4.0)
    there = abs(first).max(axis=2) > 2.0
    assert 0.002 < there.mean() < 0.4
    assert (first > 2.0).any() and (first < -2.0).any()  # crests and what is behind them
    assert np.array_equal(first, shown(RAIN, 4.0))
    later = abs(shown(RAIN, 4.3)).max(axis=2) > 2.0
    assert (there & later).sum() < 0.6 * there.sum()
    # None far off, where they would be smaller than pixels.
    far = look((eye[0], eye[1] + RINGS_SEEN + 2.0, eye[2]), (0.2, eye[1] - 1.7, -17.5))
    view = far
    assert not shown(RAIN, 4.0).any()
