"""The walk in the weather of a file, and in one that is edited meanwhile."""

from __future__ import annotations

import math
import os
from collections.abc import Iterator
from pathlib import Path

import esper
import moderngl
import pytest

from demo_game.cli import main
from demo_game.file_weather import LOOK_EVERY, FileWeather
from demo_game.game import Game
from demo_game.place import Place
from demo_game.settings import Settings
from tests.worlds import fresh_world
from weather_ecs import WeatherFileError, save_clouds
from weather_ecs.components import Climate, CloudModel, RainArea, SkyLayer, Wind

TEXT = """version = 2
[[models]]
name = "mine"
[[models.seeds]]
[[layers]]
base = 900
[[layers.skies]]
state = 0.5
models = ["mine"]
count = 5
[[rain_areas]]
center = [0, 60]
radii = [40, 30]
rain_rate = 8
drift = 1
[[winds]]
speed = 7
direction = [0, 1]
[air]
temperature = -5
[fog]
visibility = 400
[atmosphere]
time = "2025-12-24T12:00:00Z"
speed = 0
[climate]
initial = 0.5
final = 0.5
"""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    place = tmp_path / "evening.toml"
    place.write_text(TEXT)
    return place


@pytest.fixture
def game(ctx: moderngl.Context, place: Place, path: Path) -> Iterator[Game]:
    made = Game(ctx, Settings(quality="low"), place=place, preset=str(path), watch=True)
    yield made
    made.close()


def write(path: Path, text: str) -> None:
    """Another text; the time of a file may be coarse, its number is not."""
    aside = path.with_suffix(".new")
    aside.write_text(text)
    os.replace(aside, path)


def pass_time(game: Game, seconds: float = LOOK_EVERY + 0.1) -> None:
    for _ in range(round(seconds / 0.1)):
        game.update(0.1)


def test_the_walk_has_the_weather_of_its_file(game: Game) -> None:
    pass_time(game)
    assert game.state == "evening"
    here = game.weather.sample((0.0, 50.0, 60.0))  # over the trees
    assert here.rain_rate + here.snow_rate > 4.0
    assert here.temperature == pytest.approx(-5.325, abs=0.01)  # 50 m up
    assert here.visibility < 401.0
    assert game.mood.current.wind_speed == 7.0
    wind = game.weather.sample((0.0, 10.0, 60.0)).wind
    assert (wind[0], wind[2]) == pytest.approx((0.0, 7.0), abs=0.01)
    assert game.weather.stats.state == 0.5
    assert game.sky.atmosphere.time == 1766577600.0
    assert game.areas[0].rain_rate == 0.0  # the walk's own steps aside
    assert [area.rain_rate for area in game.areas[2:]] == [8.0]


def test_what_is_edited_is_taken_and_the_rest_goes_on(game: Game, path: Path) -> None:
    pass_time(game)
    file = game.given.file
    assert file is not None and file.readings == 1
    [layer] = [each for _, each in esper.get_component(SkyLayer) if each.base == 900.0]
    moved = file.areas[0].center
    assert moved[1] > 60.0  # with the wind
    write(
        path, TEXT.replace("temperature = -5", "temperature = 20").replace("base = 900", "base=900")
    )
    pass_time(game)
    assert file.readings == 2 and "read again" in str(game.take_news())
    assert game.weather.sample((0.0, 1.0, 60.0)).temperature == pytest.approx(20.0, abs=0.1)
    assert [e for _, e in esper.get_component(SkyLayer) if e.base == 900.0] == [layer]
    assert file.areas[0].center[1] > moved[1]
    write(path, TEXT.replace("rain_rate = 8", "rain_rate = 30").replace("speed = 7", "speed = 3"))
    pass_time(game)
    assert [area.rain_rate for area in file.areas] == [30.0]
    assert [wind.speed for _, wind in esper.get_component(Wind) if wind.speed] == [3.0]
    assert len(esper.get_component(CloudModel)) == len(set(_names()))
    write(path, "version = 2\n")
    pass_time(game)
    assert file.areas == [] and "mine" not in _names()
    assert len(esper.get_component(Climate)) == 1 and game.weather.stats.state == 0.5


def _names() -> list[str]:
    return [model.name for _, model in esper.get_component(CloudModel)]


@pytest.mark.parametrize(
    ("old", "new", "words"),
    [
        ("rain_rate = 8", "rain_rate = -8", ["line", "rain_rate"]),
        ("[air]", "[air", ["not", "TOML"]),
        (TEXT, "", ["version"]),
    ],
)
def test_a_broken_state_keeps_the_last_good_one_and_says_so(game, path, old, new, words) -> None:
    pass_time(game)
    before = [id(area) for area in game.given.file.areas]
    write(path, TEXT.replace(old, new))
    pass_time(game)
    assert [id(area) for area in game.given.file.areas] == before
    assert "not good" in game.take_news()
    lines = game.given.file.lines()
    assert lines[0].startswith("not good: evening.toml") and len(lines) <= 3
    assert all(word in " ".join(lines) for word in words)
    assert all(len(line) <= 34 for line in lines)
    pass_time(game, 2.0)
    assert game.take_news() is None  # said once
    write(path, TEXT.replace("temperature = -5", "temperature = 3"))
    pass_time(game)
    assert game.given.file.problem == ""
    assert game.given.file.lines() == ["watching evening.toml, read again…"]


def test_a_file_that_is_deleted_and_comes_back(game: Game, path: Path) -> None:
    path.unlink()
    pass_time(game)
    assert game.given.file is not None and "no such file" in game.given.file.problem
    path.write_text(TEXT.replace("rain_rate = 8", "rain_rate = 9"))
    pass_time(game)
    assert game.given.file.problem == "" and game.given.file.areas[0].rain_rate == 9.0


def test_keys_leave_the_file(game: Game) -> None:
    pass_time(game)
    game.changer.choose_preset("heavy")
    pass_time(game, 6.0)
    assert game.given.file is None and game.state == "heavy"
    assert game.areas[0].rain_rate > 1.0
    assert all(area.radii != (40.0, 30.0) for area in game.areas)
    assert game.mood.current.lent == 0.0


def test_a_model_gives_the_games_own_back(path: Path) -> None:
    with fresh_world():
        own = CloudModel("mine", ({"center": (0, 0, 0)},))  # type: ignore[arg-type]
        entity = esper.create_entity(own)
        file = FileWeather(str(path), watch=True)
        assert esper.component_for_entity(entity, CloudModel) is not own
        assert len(esper.get_component(CloudModel)) == 1
        write(path, TEXT.replace('"mine"', '"yours"'))
        assert "read again" in file.look(LOOK_EVERY)
        assert esper.component_for_entity(entity, CloudModel) is own
        assert sorted(_names()) == ["mine", "yours"]


def test_what_the_walk_saves_it_can_walk_in(ctx, place: Place, tmp_path: Path) -> None:
    path = tmp_path / "saved.toml"
    first = Game(ctx, Settings(quality="low"), place=place, preset="storm")
    first.update(1.0)
    first.weather.save(path)
    first.close()
    second = Game(ctx, Settings(quality="low"), place=place, preset=str(path))
    second.update(0.1)
    assert second.weather.stats.state == 1.0
    assert math.isfinite(second.mood.current.wind_speed)
    assert [type(area) for area in second.areas[:2]] == [RainArea, RainArea]
    assert second.given.file is not None and second.given.file.lines() == []
    second.close()


def test_bad_files_and_arguments_are_refused(ctx, place: Place, tmp_path: Path, capsys) -> None:
    worlds = esper.list_worlds()
    bad = tmp_path / "bad.toml"
    bad.write_text("version = 9")
    with pytest.raises(WeatherFileError):
        Game(ctx, Settings(quality="low"), place=place, preset=str(bad), watch=True)
    assert esper.list_worlds() == worlds
    with pytest.raises(SystemExit) as stop:
        main(["--watch"])
    assert stop.value.code == 2 and "--watch: needs a file" in capsys.readouterr().err


def test_layers_of_a_file_bring_their_own_climates(tmp_path: Path) -> None:
    path = tmp_path / "own.toml"
    path.write_text("version = 2\n[[layers]]\n[layers.climate]\ninitial = 0.3\n[[layers]]\n")
    with fresh_world():
        file = FileWeather(str(path))
        assert [climate.initial for _, climate in esper.get_component(Climate)] == [0.3]
        assert file.climate is None
        save_clouds(path, file.content)
