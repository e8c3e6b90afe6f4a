"""The demo's sky: states of its presets, the climate's run, the clouds over its rains."""

from __future__ import annotations

import math
from collections.abc import Iterator
from pathlib import Path
from types import SimpleNamespace

import esper
import moderngl
import pytest

from demo_game.cloudscape import SETTLED
from demo_game.game import Game
from demo_game.mood import CLIMATE, STATES
from demo_game.place import Place
from demo_game.play_keys import play_key
from demo_game.settings import Settings
from demo_game.tours import make_tour
from demo_game.weather_changer import OPENING
from weather_ecs.components import Climate, Cloud, SkyLayer
from weather_ecs.errors import WeatherFileError
from weather_ecs.presets import PRESETS

SHOWN = SimpleNamespace(show_map=False)


@pytest.fixture
def game(ctx: moderngl.Context, place: Place) -> Iterator[Game]:
    made = Game(ctx, Settings(quality="low"), place=place)
    yield made
    made.close()


def clouds_of(game: Game) -> list[Cloud]:
    return [cloud for _, cloud in sorted(esper.get_component(Cloud))]


def test_every_preset_has_a_sky() -> None:
    assert set(STATES) == set(PRESETS)


def test_a_cloud_hangs_over_each_rain_and_goes_with_it(game: Game) -> None:
    game.update(0.1)
    for cloud, area in zip(clouds_of(game), game.areas, strict=True):
        assert cloud.growth > 0.9
        # It is placed before the weather moves its area on: by 0.1 s of wind at most.
        assert math.dist((cloud.position[0], cloud.position[2]), area.center) < 1.5
        assert 0.0 < cloud.position[1] < area.ceiling  # the rain comes out of it
    x = clouds_of(game)[1].position[0]
    for _ in range(20):
        game.update(0.5)
    assert clouds_of(game)[1].position[0] > x + 10.0  # carried off with its shower
    game.changer.choose_preset("clear")
    for _ in range(60):
        game.update(0.1)
    assert [cloud.growth for cloud in clouds_of(game)] == [0.0, 0.0]


def test_presets_turn_the_sky_and_it_comes_to_rest(game: Game) -> None:
    game.update(0.1)
    assert game.weather.stats.state == OPENING[0]
    game.changer.choose_preset("heavy")
    for _ in range(int(SETTLED)):
        game.update(1.0)
    assert game.weather.stats.state == STATES["heavy"]
    before = game.weather.stats.clouds
    game.changer.choose_preset("fog")
    for _ in range(int(SETTLED) + 10):
        game.update(1.0)
    assert game.weather.stats.state == STATES["fog"]
    assert game.weather.stats.clouds < 0.5 * before
    assert all(layer.turnover == 0.0 for _, layer in esper.get_component(SkyLayer))
    assert len(game.areas) == 2  # nothing rains but the game's own


def test_the_climate_runs_to_the_storm_and_back(game: Game) -> None:
    game.update(0.1)
    (climate,) = [climate for _, climate in esper.get_component(Climate)]
    climate.elapsed, climate.duration = 20.0, 40.0
    assert "storm" in (play_key("C", game, SHOWN) or "")
    for _ in range(30):
        game.update(2.0)
    assert game.state == CLIMATE
    assert game.weather.stats.state == 1.0
    assert game.areas[0].rain_rate == game.areas[1].rain_rate == 0.0
    assert max(area.rain_rate for area in game.areas[2:]) > 1.0
    windy = game.mood.current.wind_speed
    assert "clears" in (play_key("C", game, SHOWN) or "")
    for _ in range(25):
        game.update(2.0)
    assert game.weather.stats.state == 0.0
    assert game.mood.current.wind_speed < windy
    play_key("_5", game, SHOWN)
    for _ in range(60):
        game.update(0.1)
    assert game.areas[0].rain_rate > 1.0  # or more, but for a lull
    assert game.weather.stats.state == pytest.approx(STATES["heavy"])


def test_a_sky_by_name_and_from_a_file(ctx: moderngl.Context, place: Place, tmp_path: Path) -> None:
    game = Game(ctx, Settings(quality="low"), place=place, preset="storm")
    game.update(1.5)
    assert game.weather.stats.state == 1.0
    assert len(game.areas) > 2  # its clouds rain
    path = tmp_path / "sky.toml"
    game.weather.save(path)
    game.close()
    with_file = Game(ctx, Settings(quality="low"), place=place, preset=str(path))
    with_file.update(0.1)
    assert with_file.state == "sky"
    assert with_file.weather.stats.state == 1.0
    with_file.close()
    worlds = esper.list_worlds()
    with pytest.raises(WeatherFileError):
        Game(ctx, Settings(quality="low"), place=place, preset=str(tmp_path / "none.toml"))
    assert esper.list_worlds() == worlds


def test_snow_lies_after_its_tour(ctx: moderngl.Context, place: Place) -> None:
    tour = make_tour("snow", place, 10.0)
    game = Game(ctx, Settings(quality="low"), place=place, tour=tour)
    depths = []
    for _ in range(20):
        game.update(0.5)
        depths.append(game.weather.sample((-2.0, 0.1, -40.0)).snow_depth)
    assert depths[0] == 0.0
    assert depths[-1] > 0.01
    assert depths[-1] == pytest.approx(depths[-2], rel=0.02)  # it has stopped
    game.close()
