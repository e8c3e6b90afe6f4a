"""The demo's air: how far one sees in the picture, by its row of posts; what follows a tour."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from typing import Any

import moderngl
import numpy as np
import pytest

from demo_game.camera import Pose, projection_matrix, view_matrix
from demo_game.entities import CLEAREST, clearest, fog_depth, fog_overhead, shown
from demo_game.game import Game
from demo_game.mood import AIRS
from demo_game.place import Place, layout, sight_posts
from demo_game.settings import Settings
from tests.targets import window_like
from weather_ecs.physics.optics import fog_factor, visibility_to_extinction
from weather_ecs.presets import PRESETS
from weather_ecs.systems.air import fog_color

SIZE = (480, 270)
LIT = np.linspace(0.0, 4.0, 40_001)  # scene light
CURVE = np.array([shown(value) for value in LIT])


@pytest.fixture
def target(ctx: moderngl.Context) -> Iterator[moderngl.Framebuffer]:
    with window_like(ctx, SIZE) as framebuffer:
        yield framebuffer


class Look:
    """A tour that stands still where the posts are looked at from."""

    name = "still"

    def __init__(self, place: Place) -> None:
        x, z = layout.SIGHT_FROM
        self.eye = (x, place.height(x, z) + 1.7, z)

    def pose(self, time: float) -> Pose:
        return Pose(self.eye, sight_posts.heading(), 0.0)


@pytest.fixture
def look(place: Place) -> Any:
    return Look(place)


def scene_light(game: Game, target: moderngl.Framebuffer) -> np.ndarray:
    """The picture before the tone curve, (height, width), top first."""
    game.draw(target)
    data = np.frombuffer(target.read(components=3, alignment=1), np.uint8)
    display = data.reshape(SIZE[1], SIZE[0], 3)[::-1].mean(axis=2) / 255.0
    return np.interp(display, CURVE, LIT)


@pytest.mark.parametrize("visibility", [100.0, 300.0])
def test_posts_fade_as_koschmieder_says(
    ctx: moderngl.Context, place: Place, target: moderngl.Framebuffer, look: Any, visibility: float
) -> None:
    settings = Settings(quality="low", field_of_view=14.0)
    game = Game(ctx, settings, place=place, tour=look, preset="fog")
    game.mood.current = replace(game.mood.current, visibility=visibility)
    for _ in range(3):
        game.update(1 / 30)
    seen = scene_light(game, target)
    assert game.weather.sample(look.eye).visibility == pytest.approx(visibility)
    game.close()

    matrix = projection_matrix(settings.hfov, SIZE[0] / SIZE[1]) @ view_matrix(look.pose(0.0))
    found, away = [], []
    for x, z in sight_posts.feet().tolist():
        middle = np.array([x, place.height(x, z) + 0.6 * sight_posts.TALL, z, 1.0])
        clip = matrix @ middle
        column = round((clip[0] / clip[3] * 0.5 + 0.5) * SIZE[0] - 0.5)
        row = round((0.5 - clip[1] / clip[3] * 0.5) * SIZE[1] - 0.5)
        fog = np.median(seen[:12, column - 3 : column + 4])  # high above the hills
        found.append(1.0 - seen[row, column - 1 : column + 2].min() / fog)
        away.append(math.dist(middle[:3], look.eye))
    expected = fog_factor(away, visibility_to_extinction(visibility))
    clear = expected > 0.05
    assert clear.sum() >= (1 if visibility < 200.0 else 4)
    np.testing.assert_allclose(np.array(found)[clear], expected[clear], rtol=0.12, atol=0.012)
    beyond = np.array(away) > 1.15 * visibility
    assert np.array(found)[beyond].max() < 0.035


def test_rains_leave_a_tours_scenery_and_airs_change_it(
    ctx: moderngl.Context, place: Place, look: Any
) -> None:
    env = {}
    for preset in ("clear", "heavy", "cloudburst", "fog", "heavy_snow"):
        game = Game(ctx, Settings(quality="low"), place=place, tour=look, preset=preset)
        game.update(1 / 30)
        made = game.surroundings.environment(game)
        env[preset] = (made.fog_density, made.fog_overhead, made.overcast, made.zenith_color)
        here = game.weather.sample((0.0, 0.0, -70.0))
        assert here.temperature == pytest.approx(PRESETS[preset].temperature, abs=0.1)
        game.close()
    assert env["clear"] == env["heavy"] == env["cloudburst"]
    assert env["fog"][0] == pytest.approx(3.912 / PRESETS["fog"].visibility)
    assert env["fog"][1] > 3.0 > 0.01 > env["heavy"][1]
    assert env["heavy_snow"][0] == pytest.approx(3.912 / CLEAREST)
    assert set(PRESETS) >= AIRS


def test_visibility_glides_and_the_scene_keeps_to_the_weathers_air(
    ctx: moderngl.Context, place: Place
) -> None:
    game = Game(ctx, Settings(quality="low"), place=place, preset="clear")
    game.changer.choose_preset("fog")
    before, lost = game.weather.sample(game.pose.eye), []
    for _ in range(270):
        game.update(1 / 60)
        lost.append(game.surroundings.environment(game).fog_density)
    after = game.weather.sample(game.pose.eye)
    game.close()
    assert before.visibility == pytest.approx(CLEAREST)
    assert after.visibility == pytest.approx(PRESETS["fog"].visibility)
    assert lost[-1] == pytest.approx(3.912 / after.visibility)
    assert all(1.0 <= b / a < 1.06 for a, b in zip(lost, lost[1:], strict=False))


def test_fog_takes_the_sun_and_lights_from_all_round(ctx: moderngl.Context, place: Place) -> None:
    assert clearest(1e5) == CLEAREST
    assert fog_depth(CLEAREST) == 0.0 == fog_overhead(1e9)
    lights = {}
    for preset in ("clear", "fog"):
        game = Game(ctx, Settings(quality="low"), place=place, preset=preset)
        game.update(0.0)
        lights[preset] = game.light
        env = game.surroundings.environment(game)
        assert env.sun_color == game.weather.light.sun_color
        assert env.horizon_color == game.weather.light.horizon_color
        assert env.fog_color == pytest.approx(fog_color(game.weather.light))
        game.close()
    day, dull = lights["clear"], lights["fog"]
    assert max(dull.sun_color) < 0.05 * max(day.sun_color)
    spread = [max(c) / min(c) for c in (dull.horizon_color, dull.zenith_color, day.zenith_color)]
    assert max(spread[:2]) < 1.5 < 1.6 < spread[2]
    assert dull.lamps > day.lamps
