"""The small splashes around one, splashes whose surface has gone, and those seen from below."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import moderngl
import numpy as np
import pytest

from tests.splash_capture import Quads, SplashCapture, impacts, law_of
from tests.splash_scenes import play, scene
from tests.splash_views import LOOK, view_at
from tests.weather_pictures import stage
from weather_ecs.frame import RippleData, ViewData
from weather_ecs.gpu import splash_texture as texture
from weather_ecs.physics import splash

AGE = 0.15
MANY, FEW = 500.0, 10.0  # weights: six companions, none


@pytest.fixture
def capture(ctx: moderngl.Context) -> Iterator[SplashCapture]:
    made = SplashCapture(ctx)
    yield made
    made.release()


def crowns(found: Quads) -> np.ndarray:
    """Corners of the crowns and bursts, without the films."""
    return found.ndc[found.layer < texture.FILM * texture.FRAMES]


def shown(view: ViewData, points: np.ndarray) -> np.ndarray:
    """(n, 2) places in the picture, -1 to 1."""
    clip = np.column_stack([points, np.ones(len(points))]) @ (view.projection @ view.view).T
    return clip[:, :2] / clip[:, 3:]


def test_a_splash_has_as_many_as_its_drop_stands_for():
    seed = np.random.default_rng(4).random(4000).astype(np.float32)
    law = law_of(LOOK, view_at())
    number = {
        w: splash.companions(np.full(4000, w), seed, law) for w in (10.0, 100.0, 200.0, 5000.0)
    }
    assert not number[10.0].any()
    assert number[100.0].mean() == pytest.approx(0.5, abs=0.03)
    assert number[200.0].mean() == pytest.approx(2.0, abs=0.03)
    assert (number[5000.0] == splash.COMPANIONS).all()
    assert not splash.companions(np.full(4000, 5000.0), seed, replace(law, share=0.0)).any()


def test_companions_lie_around_the_hit_and_come_later():
    seed = np.random.default_rng(5).random(4000).astype(np.float32)
    law = law_of(LOOK, view_at())
    places = []
    for k in range(splash.COMPANIONS):
        place, later, radius = splash.companion(seed, k, law)
        assert later.min() >= 0.0 and later.max() <= splash.LONGEST - LOOK.duration
        assert (radius > 0.02).all() and (radius < LOOK.largest).all()
        places.append(place)
    away = np.linalg.norm(np.concatenate(places), axis=1)
    # Even over a disc: half of them within its half area.
    assert away.max() <= splash.SCATTER
    assert (away < splash.SCATTER / np.sqrt(2.0)).mean() == pytest.approx(0.5, abs=0.02)
    assert np.abs(np.corrcoef(places[0][:, 0], places[1][:, 0])[0, 1]) < 0.06


def expected(view: ViewData, records: np.ndarray, heights: Any) -> np.ndarray:
    """(n, 3) where the oracle has companions that are to be seen now."""
    law = law_of(LOOK, view)
    found = []
    for one in records:
        seed = one["seed"][None]
        for k in range(int(splash.companions(one["weight"][None].astype(float), seed, law)[0])):
            (place,), (later,), _ = splash.companion(seed, k, law)
            x = (view.frame.time - float(one["time"]) - later) / LOOK.duration
            if 0.0 < x < 0.9:
                at = one["position"][[0, 2]] + place
                found.append((at[0], heights(at[0]), at[1]))
    return np.array(found)


def test_companions_are_where_the_oracle_has_them(capture: SplashCapture):
    view = view_at((0.0, 1.7, 4.0), -0.35)
    records = impacts(1, time=100.0 - AGE, weight=MANY, seed=0.37, position=(-0.1, 0.0, 0.0))
    alone = crowns(capture.quads(impacts(1, time=100.0 - AGE, weight=FEW, seed=0.37), view, LOOK))
    assert len(alone) == 1
    capture.ground(edge=0.0, low=-0.8)
    found = crowns(capture.quads(records, view, LOOK))
    places = expected(view, records, lambda x: -0.8 if x > 0.0 else 0.0)
    assert len(places) >= 3 and len({p[1] for p in places}) == 2
    # And the splash itself.
    assert len(found) == len(places) + 1
    low, high = found[1:, :, :2].min(axis=1), found[1:, :, :2].max(axis=1)
    feet = shown(view, places)
    assert (low <= feet).all() and (feet <= high).all()
    assert np.abs((0.5 * (low + high) - feet)[:, 0]).max() < 0.03


def test_there_are_none_on_water_nor_far_off(capture: SplashCapture):
    records = impacts(20, time=100.0 - AGE, weight=MANY)
    pond = RippleData(
        1, (0.0, 0.0, 0.0), (2.0, 2.0), 0.0, False, 0.1, 0.5, 6, 1.0, (0.1, 0.2, 0.2), 1.0, True
    )
    assert len(crowns(capture.quads(records, view_at(), LOOK))) > 60
    assert len(crowns(capture.quads(records, view_at(ripples=(pond,)), LOOK))) == 20
    far = view_at((0.0, 1.7, 12.0), -0.15)
    assert len(crowns(capture.quads(records, far, LOOK))) == 20


def test_what_was_hit_has_gone_and_its_splash_with_it(capture: SplashCapture):
    records = impacts(20, time=100.0 - AGE, weight=FEW)
    records["position"][:, 1] = 1.0  # nothing is there any more
    assert len(crowns(capture.quads(records, view_at(), LOOK))) == 0
    assert len(capture.quads(records, view_at(), LOOK).beads) == 0
    records["position"][:, 1] = 0.05
    assert len(crowns(capture.quads(records, view_at(), LOOK))) == 20


def test_none_shows_through_a_wall(capture: SplashCapture):
    records = impacts(4, time=100.0 - AGE, weight=FEW)
    # A wall to x = 0: hits of the map's texels beside it may lie within it.
    capture.ground(edge=0.0, low=-3.0)
    records["position"][:, 0] = (-0.2, -0.02, 0.03, 0.25)
    records["position"][:, 1] = (0.0, 0.0, -3.0, -3.0)
    view = view_at((0.0, 1.7, 3.0), -0.5)
    feet = shown(view, records["position"])
    low, high = (f(crowns(capture.quads(records, view, LOOK)), axis=1) for f in (np.min, np.max))
    among = [((low[:, :2] <= foot) & (foot <= high[:, :2])).all(axis=1).any() for foot in feet]
    assert among == [True, True, False, True]
    # Nor do droplets fly into it: those that are left are beside it.
    records = impacts(40, time=99.8, weight=MANY, position=(0.1, -3.0, 0.0))
    left = capture.quads(records, view, LOOK).droplets
    wall = shown(view, np.array([(0.0, -3.0 + 0.2, z) for z in (-0.2, 0.2)]))[:, 0].min()
    assert len(left) > 20 and (left[:, 0] > wall - 0.01).all()
    capture.ground(edge=-9.0, low=-3.0)
    every = capture.quads(records, view, LOOK).droplets
    assert len(every) > len(left) + 5 and (every[:, 0] < wall - 0.01).any()
    # Hits on the far face of a wall, seen from within.
    capture.ground()
    records = impacts(4, time=100.0 - AGE, weight=FEW, normal=(-0.97, 0.24, 0.0))
    assert len(crowns(capture.quads(records, view_at((-1.0, 0.4, 3.0), 0.0), LOOK))) == 4
    assert len(crowns(capture.quads(records, view_at((1.0, 0.4, 3.0), 0.0), LOOK))) == 0


def test_no_ceiling_shows_what_is_on_the_roof(capture: SplashCapture):
    records = impacts(30, time=100.0 - AGE, weight=MANY)
    above = capture.quads(records, view_at((0.0, 1.7, 3.0), -0.5), LOOK)
    below = capture.quads(records, view_at((0.0, -1.7, 3.0), 0.5), LOOK)
    assert (above.layer >= texture.FILM * texture.FRAMES).any()
    assert not (below.layer >= texture.FILM * texture.FRAMES).any()
    # What is left stands on the roof and is nowhere nearer than it is.
    assert len(below.corners)
    projection = view_at().projection
    depth = projection[2, 3] / (below.ndc[..., 2] + projection[2, 2])
    assert np.allclose(depth, below.corners[..., 3], rtol=1e-3)


def test_splashes_find_the_map_whatever_other_passes_have_bound(ctx: moderngl.Context):
    pictures = []
    for busy in (False, True):
        with stage(ctx, (320, 180), quality="low") as it:
            scene()
            play(it, 20)
            assert it.weather._renderer is not None
            layers = it.weather._renderer._layers
            draw, other = layers._draw_splashes, ctx.texture((4, 4), 4, bytes(64))

            def after_others(
                *given: Any, draw: Any = draw, other: Any = other, busy: bool = busy
            ) -> None:
                for unit in range(8) if busy else ():
                    other.use(unit)
                draw(*given)

            layers._draw_splashes = after_others  # type: ignore[method-assign]
            pictures.append(play(it, 3).astype(int))
            assert it.weather.stats.splashes > 0
            other.release()
    # The order in which the impacts were listed may differ, and so which lies over which.
    changed = np.abs(pictures[0] - pictures[1]).max(axis=2)
    assert (changed > 8).mean() < 1e-3
