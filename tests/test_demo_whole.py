"""Whole weathers and METAR reports in the demo, without a window."""

from __future__ import annotations

from collections.abc import Iterator

import esper
import numpy as np
import pytest

from demo_game import cli, headless
from demo_game.game import Game
from demo_game.place import Place
from demo_game.reports import read_report, summary
from demo_game.settings import Settings
from demo_game.wholes import next_whole, shown_name
from weather_ecs.errors import WeatherError
from weather_ecs.presets import WEATHERS

pytest.importorskip("metar")
STORMY = "METAR KEWR 111851Z VRB03G19KT 2SM TSRA BR FEW015 BKN040CB 22/22 A2987"
WINDY = "EHAM 020825Z 21022KT 9999 FEW008 SCT018 BKN022 17/15 Q1002"


@pytest.fixture
def context() -> Iterator[object]:
    context = headless.make_context()
    yield context
    context.release()


def test_a_report_is_read_before_anything_is_built() -> None:
    world = esper.current_world
    report = read_report(STORMY)
    assert esper.current_world == world
    lines = summary(report)
    assert lines[0] == "KEWR, 11 18:51 UTC"
    assert len(lines) == 3
    assert max(map(len, lines)) <= 32
    with pytest.raises(WeatherError):
        read_report("nonsense")
    assert esper.current_world == world


@pytest.mark.parametrize("text", ["", "nonsense", "EHAM 020825Z", "x" * 100_000])
def test_a_bad_report_is_refused_in_one_line(text: str, capsys: pytest.CaptureFixture) -> None:
    with pytest.raises(SystemExit) as end:
        cli.main(["--headless", f"--metar={text}"])
    assert end.value.code == 2
    said = capsys.readouterr()
    assert said.err.startswith("demo_game: argument --metar: ")
    assert said.err.count("\n") == 1
    assert said.out == ""


def test_what_was_understood_is_printed(
    capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    ran: list[headless.HeadlessOptions] = []
    monkeypatch.setattr(cli, "run_tour", lambda tour, settings: ran.append(tour) or "done")
    assert cli.main(["--headless", "--metar", STORMY]) == 0
    said = capsys.readouterr().out
    assert "KEWR, 11 18:51 UTC" in said
    assert "TSRA" in said
    assert ran[0].metar == STORMY


def test_the_games_own_weather_stands_aside(context: object, place: Place) -> None:
    game = Game(context, Settings(quality="low"), place=place, metar=WINDY)
    try:
        for _ in range(3):
            game.update(0.1)
        assert game.state.startswith("EHAM")
        assert game.given.report is not None
        assert game.entities.area.rain_rate == 0.0
        assert game.entities._wind.speed == 0.0
        assert not any(layer.skies[-1].count for layer in game.scape.layers)
        here = game.weather.sample((0.0, 10.0, 0.0))
        assert here.temperature == pytest.approx(17.0, abs=0.2)
        assert here.rain_rate == 0.0
        mean = (here.wind[0] ** 2 + here.wind[2] ** 2) ** 0.5
        assert 6.0 < mean < 20.0
        assert here.wind[2] < 0.0 < here.wind[0]  # from the south-west
        game.changer.choose_preset("heavy")  # and back to the game's own
        for _ in range(80):
            game.update(0.1)
        assert game.state == "heavy" and game.given.report is None
        assert game.entities.area.rain_rate > 10.0
        assert game.entities._wind.speed > 1.0
        assert any(layer.skies[-1].count for layer in game.scape.layers)
        now = game.weather.whole
        assert now is not None
        assert now.conditions.rain_rate == 0.0
        assert now.conditions.wind_speed == 0.0
    finally:
        game.close()


def test_a_whole_weather_comes_smoothly_out_of_a_preset(context: object, place: Place) -> None:
    game = Game(context, Settings(quality="low"), place=place, preset="clear")
    try:
        game.update(0.1)
        assert "steady rain" in game.changer.choose_whole("steady_rain", 10.0).lower()
        rates, moods = [], []
        for _ in range(110):
            game.update(0.1)
            rates.append(game.weather.sample((0.0, 60.0, -40.0)).rain_rate)
            moods.append(game.mood.current.overcast)
        assert rates[-1] == pytest.approx(5.0, rel=0.1)
        assert max(abs(b - a) for a, b in zip(moods, moods[1:], strict=False)) < 0.05
        assert moods[-1] == pytest.approx(1.0)
        assert game.state == "steady_rain"
        assert "there" in game.wholes.status(game.weather)
    finally:
        game.close()


def test_names_of_whole_weathers() -> None:
    assert shown_name("clear") == "whole clear"
    assert shown_name("thunderstorm") == "thunderstorm"
    names = list(WEATHERS)
    assert next_whole("heavy") == names[0]
    assert next_whole("clear") == names[0]  # the preset of that name
    assert next_whole("whole clear") == names[1]
    assert next_whole(names[-1]) == names[0]


def test_a_called_strike_lights_the_scene_and_is_heard(context: object, place: Place) -> None:
    game = Game(context, Settings(quality="low"), place=place, preset="clear")
    color = context.texture((96, 54), 4)
    target = context.framebuffer([color], context.depth_texture((96, 54)))
    heard = []

    def on_thunder(observer: int, strike: object, distance: float) -> None:
        heard.append(distance)

    try:
        esper.set_handler("thunder", on_thunder)
        game.player.look(0.0, -0.6)  # at the ground
        for _ in range(3):
            game.update(0.02)
        game.draw(target)
        dark = np.frombuffer(target.read(components=3), "u1").astype("f4").mean()
        assert game.surroundings.environment(game).air is None
        game.changer.strike()
        bright = 0.0
        for _ in range(8):
            game.update(0.02)
            game.draw(target)
            now = np.frombuffer(target.read(components=3), "u1").astype("f4").mean()
            bright = max(bright, now)
        assert game.surroundings.environment(game).air is not None
        assert bright > dark * 1.1
        for _ in range(40):
            game.update(0.1)
        game.draw(target)
        assert game.surroundings.environment(game).air is None
        assert len(heard) == 1
        assert 600.0 < heard[0] < 1500.0
        assert context.error == "GL_NO_ERROR"
    finally:
        game.close()
