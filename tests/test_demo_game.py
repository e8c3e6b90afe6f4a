"""The game off screen, driven as the window drives it."""

from __future__ import annotations

import math
from collections.abc import Iterator
from dataclasses import replace
from types import SimpleNamespace

import esper
import moderngl
import numpy as np
import pytest

from demo_game.entities import CENTER, RADII
from demo_game.game import START, Game
from demo_game.letter import State
from demo_game.place import Place
from demo_game.play_keys import play_key
from demo_game.player import Intent
from demo_game.settings import Settings
from demo_game.showers import Showers
from demo_game.tours import make_tour
from tests.targets import window_like
from weather_ecs.errors import InvalidValueError
from weather_ecs.presets import PRESETS

SIZE = (96, 54)


@pytest.fixture
def target(ctx: moderngl.Context) -> Iterator[moderngl.Framebuffer]:
    with window_like(ctx, SIZE) as framebuffer:
        yield framebuffer


@pytest.fixture
def game(ctx: moderngl.Context, place: Place, target: moderngl.Framebuffer) -> Iterator[Game]:
    made = Game(ctx, Settings(quality="low"), place=place)
    yield made
    made.close()


def picture(game: Game, target: moderngl.Framebuffer) -> np.ndarray:
    game.draw(target)
    data = np.frombuffer(target.read(components=3, alignment=1), np.uint8)
    return data.reshape(SIZE[1], SIZE[0], 3)[::-1].astype(np.int16)


def test_a_game_leaves_nothing_behind(
    ctx: moderngl.Context, place: Place, target: moderngl.Framebuffer
) -> None:
    before, worlds = esper.current_world, esper.list_worlds()
    game = Game(ctx, Settings(quality="low"), place=place)
    game.update(1 / 60)
    assert picture(game, target).std() > 10.0
    game.close()
    game.close()
    assert esper.current_world == before
    assert esper.list_worlds() == worlds


def test_a_refused_weather_leaves_nothing_behind(ctx: moderngl.Context, place: Place) -> None:
    worlds = esper.list_worlds()
    with pytest.raises(InvalidValueError, match="backend"):
        Game(ctx, Settings(quality="low", backend="none"), place=place)
    assert esper.list_worlds() == worlds


def test_two_games_do_not_mix(
    ctx: moderngl.Context, place: Place, game: Game, target: moderngl.Framebuffer
) -> None:
    other = Game(ctx, Settings(quality="low"), place=place, preset="clear")
    for one in (game, other):
        one.update(1 / 60)
        one.draw(target)
    assert game.weather.stats.mode == "far"
    assert other.weather.stats.mode == "none"
    other.close()
    game.update(1 / 60)
    middle = (CENTER[0], 1.0, CENTER[1])
    assert game.weather.sample(middle).rain_rate == pytest.approx(game.areas[0].rain_rate)


def test_walks_from_dry_land_into_the_rain(game: Game, target: moderngl.Framebuffer) -> None:
    assert game.player.position[2] == START[1]
    run = Intent(forward=1.0, run=True)
    rates = []
    for _ in range(180):  # 18 s
        game.update(0.1, run)
        x, y, z = game.player.position
        rates.append(game.weather.sample((x, y + 1.0, z)).rain_rate)
    assert rates[0] == 0.0
    assert rates[-1] > 5.0
    picture(game, target)
    assert game.weather.stats.mode == "near"
    x, _, z = game.player.position
    assert ((x - CENTER[0]) / RADII[0]) ** 2 + ((z - CENTER[1]) / RADII[1]) ** 2 < 1.0


def test_the_player_can_walk_into_the_cabin_and_not_through_its_walls(game: Game) -> None:
    x, floor, z = game.place.room
    game.player.place_at(x, z + 9.0, yaw=0.0)
    for _ in range(60 * 8):
        game.player.update(1 / 60, Intent(forward=1.0))
    assert game.player.position[1] == pytest.approx(floor, abs=0.02)
    assert z - 2.5 < game.player.position[2] < z + 2.0  # up the steps, through the door, inside
    for yaw in np.linspace(0.0, math.tau, 16, endpoint=False):
        game.player.place_at(x, z, yaw=float(yaw), y=floor)
        if abs(math.sin(yaw)) < 0.3 and math.cos(yaw) < 0.0:
            continue  # out of the door
        for _ in range(60):
            game.player.update(1 / 60, Intent(forward=1.0, run=True))
        assert abs(game.player.position[0] - x) < 3.0
        assert abs(game.player.position[2] - z) < 2.5


def test_the_whole_path_can_be_walked(game: Game) -> None:
    player = game.player
    points = game.place.path[24::4]
    player.place_at(float(points[0, 0]), float(points[0, 1]), yaw=0.0)
    for x, z in points[1:-1].tolist():
        for _ in range(600):
            dx, dz = x - player.position[0], z - player.position[2]
            if math.hypot(dx, dz) < 0.7:
                break
            player.yaw = math.atan2(-dx, -dz)
            player.update(1 / 20, Intent(forward=1.0, run=True))
        assert math.hypot(x - player.position[0], z - player.position[2]) < 0.8, (x, z)


def test_keys_change_the_weather(game: Game) -> None:
    shown = SimpleNamespace(show_map=False)
    assert play_key("_6", game, shown)
    for _ in range(60):
        game.update(0.1)
    assert game.areas[0].rain_rate == 100.0
    assert play_key("NUM_1", game, shown)
    for _ in range(60):
        game.update(0.1)
    assert game.areas[0].rain_rate == 0.0
    before = game.mood.target
    assert "m/s" in (play_key("BRACKETRIGHT", game, shown) or "")
    assert "m/s" in (play_key("BRACERIGHT", game, shown) or "")  # with Shift held down
    assert game.mood.target.wind_speed == pytest.approx(before.wind_speed + 4.0)
    assert play_key("COMMA", game, shown) != play_key("PERIOD", game, shown)
    name = game.sky.name
    play_key("T", game, shown)
    assert game.sky.name != name
    assert play_key("M", game, shown) == ""
    assert shown.show_map
    assert play_key("W", game, shown) is None


def test_time_of_day_changes_the_picture(game: Game, target: moderngl.Framebuffer) -> None:
    game.update(1 / 60)
    afternoon = picture(game, target).mean()
    for _ in range(2):  # to dusk
        game.sky.next()
        for _ in range(60):
            game.update(0.1)
    for _ in range(20):
        game.update(1 / 60)
        dusk = picture(game, target).mean()
    assert dusk < 0.7 * afternoon


def take_letter(game: Game) -> None:
    x, floor, z = game.place.room
    game.player.place_at(x - 0.6, z + 0.1, yaw=0.0, y=floor)
    game.update(1 / 60)


def test_the_letter_is_taken_carried_and_lost(game: Game, target: moderngl.Framebuffer) -> None:
    assert game.letter.state is State.LYING
    assert "cabin" in (game.take_news() or "")
    game.player.place_at(*game.place.letter[::2], yaw=0.0)  # high above the table's floor
    game.player.position[1] += 4.0
    game.update(1e-4)
    assert game.letter.state is State.LYING
    take_letter(game)
    assert game.letter.state is State.CARRIED
    assert "dry" in (game.take_news() or "")
    assert game.take_news() is None
    for _ in range(30):
        game.update(1 / 30)
    assert game.letter.wetness == 0.0
    assert game.letter.sheltered
    game.player.place_at(-5.0, -66.0, yaw=0.0)
    while game.letter.state is State.CARRIED and game.time < 120.0:
        game.update(1 / 10)
    assert game.letter.state is State.RUINED
    assert 24.0 < game.letter.time < 32.0  # 0.08 mm of 25 mm/h on half a sheet, and a second
    game.again()
    assert game.letter.state is State.LYING
    assert game.player.position[1] == pytest.approx(game.place.room[1], abs=0.02)
    game.update(1 / 60)
    picture(game, target)
    assert game.letter.state is State.LYING  # one has to go to the table


def test_the_letter_on_the_table_is_seen_until_it_is_taken(
    game: Game, target: moderngl.Framebuffer
) -> None:
    x, _, z = game.place.letter
    pictures = []
    for take in (False, True):
        if take:
            take_letter(game)
        game.player.place_at(x + 0.2, z + 0.9, yaw=0.2)
        game.player.pitch = -0.8
        game.pose = game.player.pose()
        pictures.append(picture(game, target))
    assert (abs(pictures[0] - pictures[1]).max(axis=2) > 40).sum() > 20


def test_the_letter_is_delivered(game: Game) -> None:
    take_letter(game)
    x, _, z = game.place.mailbox
    game.player.place_at(x + 3.0, z, yaw=math.pi / 2)
    for _ in range(60):
        game.update(1 / 30, Intent(forward=1.0))
    assert game.letter.state is State.DELIVERED
    assert game.letter.wetness < 0.05


def test_the_rain_has_lulls_in_play_and_none_on_tours(ctx: moderngl.Context, place: Place) -> None:
    tour = make_tour("still", place, 1.0)
    for used in (None, tour):
        game = Game(ctx, Settings(quality="low"), place=place, tour=used)
        rates = []
        for _ in range(140):
            game.update(0.5)
            rates.append(game.areas[0].rain_rate)
        full = PRESETS["heavy"].rain_rate
        if used is tour:
            assert rates == [full] * len(rates)
            assert game.letter.state is State.LYING
        else:
            showers = Showers(0)
            expected = [full * showers.share(0.5 * (k + 1)) for k in range(len(rates))]
            assert rates == pytest.approx(expected)
            assert min(rates) < 0.2 * full < max(rates) == full
        assert game.areas[1].rain_rate == pytest.approx(0.6 * full)
        game.close()


def test_settings_take_effect_without_losing_the_weather(
    game: Game, target: moderngl.Framebuffer
) -> None:
    for _ in range(30):
        game.update(1 / 60)
        game.draw(target)
    time = game.weather.stats.time
    backend = game.weather.backend
    game.settings.backend = "feedback" if backend == "compute" else "compute"
    game.settings_changed("backend")
    assert game.weather.backend == game.settings.backend
    assert game.weather.stats.time == pytest.approx(time)
    game.settings.quality = "medium"
    game.settings_changed("quality")
    game.update(1 / 60)
    picture(game, target)
    assert game.weather.quality == "medium"
    assert game.weather.stats.time > time


def test_a_tour_has_the_same_scene_with_any_preset(
    ctx: moderngl.Context, place: Place, target: moderngl.Framebuffer
) -> None:
    """Away from the rain, where nothing of it is in view, the pictures are the same."""
    pictures = []
    for preset in ("clear", "cloudburst"):
        tour = make_tour("walk", place, 10.0)
        looks_away = SimpleNamespace(
            name=tour.name, pose=lambda time, tour=tour: away(tour.pose(0.0))
        )
        game = Game(ctx, Settings(quality="low"), place=place, preset=preset, tour=looks_away)  # type: ignore[arg-type]
        for _ in range(3):
            game.update(1 / 60)
        pictures.append(picture(game, target))
        game.close()
    assert (pictures[0] == pictures[1]).all()


def test_the_scenery_sways_in_the_wind_there_is_but_where_pictures_are_compared(
    ctx: moderngl.Context, place: Place
) -> None:
    for name, follows in (("walk", False), ("still", True)):
        tour = make_tour(name, place, 10.0)
        game = Game(ctx, Settings(quality="low"), place=place, preset="heavy", tour=tour)
        found = []
        for speed in (3.0, 15.0):
            game.mood.put(replace(game.mood.current, wind_speed=speed), "heavy")
            game.update(1 / 60)
            found.append(math.hypot(*game.surroundings.environment(game).wind))
        assert (found[1] > 2.0 * found[0]) is follows
        if not follows:
            assert found[0] == pytest.approx(found[1])
        game.close()


def away(pose):  # type: ignore[no-untyped-def]
    return type(pose)(pose.eye, pose.yaw + math.pi, pose.pitch)


def test_a_picture_without_size_is_harmless(game: Game) -> None:
    game.update(1 / 60)
    game.draw(SimpleNamespace(viewport=(0, 0, 0, 0)))  # type: ignore[arg-type]


def test_a_moment_of_any_length_is_survived(game: Game, target: moderngl.Framebuffer) -> None:
    for dt in (0.0, 1e-6, 0.25, 10.0):
        game.update(dt, Intent(forward=1.0))
        game.draw(target)
    assert np.isfinite(game.player.position).all()
