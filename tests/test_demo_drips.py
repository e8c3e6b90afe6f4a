"""Drops off the cabin's eaves: where they fall, and when there are any."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from demo_game.place import Place, cabin, cabin_porch, eaves
from demo_game.render import Environment, SceneRenderer
from tests.demo_views import look, perspective

SIZE = (320, 180)
DRY = Environment(lamps=0.3)
# Wet all over, with no rain area that would change the light.
WET = replace(DRY, wetness=1.0)
DAMP = replace(DRY, wetness=0.05)
Picture = Callable[..., NDArray]


@pytest.fixture
def picture(ctx: moderngl.Context, place: Place, keep: Callable[[Any], Any]) -> Picture:
    """(height, width, 3) of 0 to 255 of the porch's edge from the side, the top row first."""
    color, depth = keep(ctx.texture(SIZE, 4)), keep(ctx.depth_renderbuffer(SIZE))
    target = keep(ctx.framebuffer([color], depth))
    scene = keep(SceneRenderer(ctx, place, "low"))
    x, y, z = place.porch
    view = look((x + 3.6, y + 1.2, z + 6.0), (x - 1.0, y + 0.9, z + 1.2))

    def draw(environment: Environment, time: float, drips: bool = True) -> NDArray:
        plain, nothing = scene._drips, _Nothing()
        scene._drips = plain if drips else nothing  # type: ignore[assignment]
        scene.draw(target, view, perspective(), time, environment)
        scene._drips = plain
        raw = np.frombuffer(target.read(components=3, alignment=1), "u1")
        return raw.reshape(SIZE[1], SIZE[0], 3)[::-1].astype("f8")

    return draw


class _Nothing:
    def draw(self, *_: object) -> None:
        """Draw none."""


def test_drops_fall_from_the_edges_of_the_roof_onto_what_is_below(place: Place) -> None:
    points = eaves.points(place.cabin_origin, place.floor_height)
    local = points[:, :3] - place.cabin_origin
    front = local[:, 2] > 0.0
    assert front.any() and (~front).any()
    # Outside of the porch's floor and of the wall behind, below the shingles, above head height.
    assert (local[front, 2] > cabin.DEPTH / 2.0 + cabin_porch.PORCH).all()
    assert (local[~front, 2] < -cabin.DEPTH / 2.0 - 0.2).all()
    assert (abs(local[:, 0]) < cabin.WIDTH / 2.0 + cabin.GABLE).all()
    assert (local[:, 1] > 1.6).all() and (local[:, 1] < cabin.TOP).all()
    ground = place.height(points[:, 0], points[:, 2])
    assert (points[:, 3] >= ground - 1e-9).all()
    steps = front & (abs(local[:, 0]) < cabin_porch.STEPS_WIDE / 2.0 - 0.1)
    assert (points[steps, 3] > ground[steps] + 0.05).all()
    beside = ~front | (abs(local[:, 0]) > cabin_porch.STEPS_WIDE / 2.0 + 0.1)
    assert points[beside, 3] == pytest.approx(ground[beside], abs=0.05)


def test_eaves_drip_while_the_roof_is_wet(picture: Picture) -> None:
    def drips(environment: Environment, time: float) -> NDArray:
        away = picture(environment, time) - picture(environment, time, drips=False)
        return np.asarray(abs(away).max(axis=2) > 3.0)

    assert not drips(DRY, 5.0).any()
    wet, damp = drips(WET, 5.0), drips(DAMP, 5.0)
    assert wet.sum() > 60
    assert 0 < damp.sum() < 0.6 * wet.sum()
    # They are streaks: more of them goes on to the pixel below than to the one beside.
    upright = (wet[1:] & wet[:-1]).sum()
    assert upright > 1.5 * (wet[:, 1:] & wet[:, :-1]).sum()
    # A little later they are elsewhere; the same moment is the same picture.
    later = drips(WET, 5.0 + 1.0 / 15.0)
    assert (later & wet).sum() < 0.5 * min(later.sum(), wet.sum())
    assert np.array_equal(picture(WET, 5.0), picture(WET, 5.0))
