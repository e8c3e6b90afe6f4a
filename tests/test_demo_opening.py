"""What a game shows first."""

from __future__ import annotations

import math

import moderngl

from demo_game.game import Game
from demo_game.mood import preset_mood
from demo_game.place import Place
from demo_game.settings import Settings
from demo_game.weather_changer import OPENING


def test_a_game_opens_on_sun_and_a_shower_ahead(ctx: moderngl.Context) -> None:
    """Cumulus and sun where one stands, rain in the way, and a rainbow in it."""
    game = Game(ctx, Settings(quality="low"), place=Place(0))
    color, depth = ctx.texture((320, 180), 4), ctx.depth_texture((320, 180))
    target = ctx.framebuffer([color], depth)
    for _ in range(3):
        game.update(1 / 60)
        game.draw(target)
    here = game.weather.sample(game.pose.eye)
    assert here.rain_rate == 0.0 and here.light > 0.75
    x, z = game.areas[0].center
    ahead = math.atan2(-(x - game.pose.eye[0]), -(z - game.pose.eye[2]))
    assert abs(ahead - game.pose.yaw) < 0.2
    assert game.weather.sample((x, 2.0, z)).rain_rate > 5.0
    assert game.light.sun_direction[2] > 0.3 < game.light.sun_direction[1]  # behind, high enough
    sky = game.weather._renderer._layers._sky  # type: ignore[union-attr]
    assert sky is not None and sky.has_bow
    # The bow's top stands clear over the hills, and its left foot on the path that one looks along.
    x, y, z = game.light.sun_direction
    assert math.radians(18.0) < math.radians(42.0) - math.asin(y) < math.radians(26.0)
    aside = math.acos(math.cos(math.radians(42.0)) / math.hypot(x, z))
    assert abs(math.atan2(-x, z) + aside) < math.radians(80.0)
    assert abs(math.atan2(-x, z) - aside) < math.radians(20.0)
    assert game.mood.current.state == OPENING[0] < preset_mood("heavy", 0.0).state
    game.changer.choose_preset("moderate")
    for _ in range(300):
        game.update(1 / 60)
    assert game.mood.current.state == preset_mood("moderate", 0.0).state
    game.close()
    for thing in (target, color, depth):
        thing.release()
