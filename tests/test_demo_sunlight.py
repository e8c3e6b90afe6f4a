"""Shadows are sharp under the sun, soft under cloud, and what moves throws none in a downpour."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from typing import Any

import moderngl
import numpy as np
import pytest
from numpy.typing import NDArray

from demo_game.place import Place
from demo_game.render import Environment, SceneRenderer, sunlight
from tests.demo_views import look, perspective

SIZE = (160, 90)
CLEAR = Environment(lamps=0.3)
GREY = replace(CLEAR, sun_color=(0.22, 0.20, 0.17), zenith_color=(0.55, 0.58, 0.62), overcast=0.85)


def rain(at: tuple[float, float], rate: float) -> Environment:
    """Grey, with a round shower of 40 m at a place."""
    return replace(GREY, rain_areas=[(at, (40.0, 40.0), 0.4, rate, 60.0)])


def test_the_sun_counts_against_the_sky() -> None:
    sky = np.add(CLEAR.zenith_color, CLEAR.horizon_color).max() / 2.0
    assert sunlight.contrast(CLEAR) == pytest.approx(sunlight.SUN_STRENGTH / sky)
    assert not sunlight.is_dull(CLEAR)
    assert sunlight.is_dull(GREY)
    assert sunlight.is_dull(replace(CLEAR, sun_color=(0.0, 0.0, 0.0)))


def test_rain_takes_its_share_of_the_sun() -> None:
    shower = rain((10.0, -5.0), 25.0)
    dark = 0.35 + 0.5 * (1.0 - np.exp(-25.0 / 4.0))
    assert sunlight.share(shower, 10.0, -5.0) == pytest.approx(1.0 - 0.9 * dark)
    assert sunlight.share(shower, 10.0 + 40.0 * 1.36, -5.0) == 1.0
    along = [sunlight.share(shower, 10.0 + x, -5.0) for x in np.linspace(0.0, 60.0, 30)]
    assert (np.diff(along) >= 0.0).all()
    assert sunlight.share(rain((10.0, -5.0), 0.0), 10.0, -5.0) == 1.0


def test_a_shower_turned_by_its_heading_shades_along_it() -> None:
    area = ((0.0, 0.0), (50.0, 10.0), 0.6, 25.0, 60.0)
    env = replace(GREY, rain_areas=[area])
    cos, sin = np.cos(0.6), np.sin(0.6)
    assert sunlight.share(env, 30.0 * cos, -30.0 * sin) < 0.5  # along its longer side
    assert sunlight.share(env, 30.0 * sin, 30.0 * cos) == 1.0  # across it


def test_shadows_soften_and_in_a_downpour_go(
    ctx: moderngl.Context, keep: Callable[[Any], Any], monkeypatch: pytest.MonkeyPatch
) -> None:
    place = Place()
    target = keep(ctx.framebuffer([keep(ctx.texture(SIZE, 4))], keep(ctx.depth_texture(SIZE))))
    scene = SceneRenderer(ctx, place, "low")

    def drawn(environment: Environment) -> NDArray:
        x, _, z = place.porch
        eye = (x - 7.0, place.height(x - 7.0, z + 9.0) + 1.7, z + 9.0)
        scene.draw(target, look(eye, place.porch), perspective(), 5.0, environment)
        return np.frombuffer(target.read(components=3), "u1").astype(int)

    try:
        sharp = drawn(CLEAR)
        assert not scene._statics.soft
        assert len(scene._casting) == 2  # figure and sails
        grey = drawn(GREY)
        assert scene._statics.soft
        assert len(scene._casting) == 2
        x, _, z, _ = place.figure_position(5.0)
        mill = place.mover_pose(5.0)["sails"]
        drawn(rain((x, z), 25.0))
        kept = [center for center, _ in scene._casting]
        assert len(kept) == 1
        assert np.allclose(kept[0], mill[:3, 3])
        assert (drawn(CLEAR) == sharp).all()
        # What is soft is the same but for the edges of shadows.
        monkeypatch.setattr(sunlight, "DULL", 0.0)
        exact = drawn(GREY)
        assert (np.abs(exact - grey) > 12).mean() < 0.02
        assert (exact != grey).any()
    finally:
        scene.release()
