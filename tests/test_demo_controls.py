"""Keys, sticks, menu, weather by hand and light: all without a window."""

from __future__ import annotations

import math
import sys
from collections.abc import Callable
from types import ModuleType, SimpleNamespace

import esper
import pyglet
import pytest

from demo_game.gamepad import Gamepads
from demo_game.input import PRESET_KEYS, Controls, Stick, dead_zone
from demo_game.mood import CHANGE_TIME, STRONGEST_WIND, MoodChanger, preset_mood
from demo_game.settings import FIELDS_OF_VIEW, QUALITIES, Settings, step
from demo_game.skies import (
    LAMPS_LEAST,
    MOST_EXPOSURE,
    TIMES,
    SkyChanger,
    light_of,
    seconds,
)
from demo_game.ui.menu import Menu, MenuActions, MouseRest, pause_menu
from weather_ecs import Weather
from weather_ecs.presets import PRESETS


def test_keys_become_an_intent() -> None:
    controls = Controls()
    for name in ("W", "UP", "D", "LSHIFT"):
        controls.press(name)
    intent = controls.intent()
    assert (intent.forward, intent.right, intent.run, intent.jump) == (1.0, 1.0, True, False)
    controls.press("S")
    controls.release("UP")
    assert controls.intent().forward == 0.0
    controls.clear()
    assert controls.intent().right == 0.0


def test_a_short_press_of_jump_is_not_lost() -> None:
    controls = Controls()
    controls.press("SPACE")
    controls.release("SPACE")
    assert controls.intent().jump
    assert not controls.intent().jump


def test_sticks_have_a_dead_zone_and_add_to_the_keys() -> None:
    assert dead_zone(0.1) == dead_zone(-0.15) == 0.0
    assert dead_zone(1.0) == 1.0
    assert dead_zone(-1.3) == -1.0
    controls = Controls()
    controls.stick = Stick(left=(0.0, 1.0), right=(1.0, -1.0))
    controls.press("W")
    assert controls.intent().forward == 1.0
    turn, rise = controls.turn(0.1)
    assert turn < 0.0  # stick right turns right
    assert rise < 0.0


def test_every_preset_has_a_number_key() -> None:
    keys = [*(f"_{n}" for n in (1, 2, 3, 4, 5, 6, 7, 8, 9, 0)), "MINUS"]
    assert list(PRESETS) == [PRESET_KEYS[key] for key in keys]
    assert [PRESET_KEYS[f"NUM_{n}"] for n in (1, 9, 0)] == ["clear", "heavy_snow", "blizzard"]
    assert set(PRESET_KEYS.values()) == set(PRESETS)


def menu_and_log() -> tuple[Menu, Settings, list[str]]:
    settings, log = Settings(), []
    actions = MenuActions(
        resume=lambda: log.append("resume"),
        settings_changed=log.append,
        again=lambda: log.append("again"),
        help=lambda: log.append("help"),
        quit=lambda: log.append("quit"),
    )
    return pause_menu(settings, actions), settings, log


def test_menu_by_keys() -> None:
    menu, settings, log = menu_and_log()
    assert menu.key("DOWN")
    menu.key("RIGHT")
    assert settings.quality == QUALITIES[0]  # from auto, the last one, round to the first
    menu.key("LEFT")
    assert settings.quality == "auto"
    menu.key("UP")
    menu.key("ENTER")
    menu.key("UP")
    menu.key("ENTER")
    assert log == ["quality", "quality", "resume", "quit"]
    assert not menu.key("F5")


def test_menu_by_mouse() -> None:
    menu, settings, log = menu_and_log()
    row = next(i for i, item in enumerate(menu.items) if item.label == "Field of view")
    before = FIELDS_OF_VIEW.index(int(settings.field_of_view))
    menu.click(row, -1)
    assert settings.field_of_view == FIELDS_OF_VIEW[before - 1]
    menu.click(row, 1)
    assert settings.field_of_view == FIELDS_OF_VIEW[before]
    menu.click(None, 1)
    menu.click(0, 1)
    assert log == ["field_of_view", "field_of_view", "resume"]
    menu.point(3)
    assert menu.chosen == 3


def test_every_value_of_the_menu_has_a_text() -> None:
    menu, settings, _ = menu_and_log()
    for item in menu.items:
        if item.change is not None and item.value is not None:
            seen = set()
            for _ in range(8):
                seen.add(item.value())
                item.change(1)
            assert len(seen) >= 2
            assert all(seen)
    assert settings.hfov == pytest.approx(math.radians(settings.field_of_view))


def test_step_wraps_and_forgives_an_unknown_value() -> None:
    assert step((1, 2, 3), 3, 1) == 1
    assert step((1, 2, 3), 9, 1) == 1


def test_presets_change_into_each_other_smoothly() -> None:
    mood = MoodChanger("clear", 0.3)
    mood.choose("cloudburst")
    rates = [mood.current.rain_rate]
    for _ in range(round(CHANGE_TIME * 60) + 2):
        mood.update(1 / 60)
        rates.append(mood.current.rain_rate)
    assert rates[0] == 0.0
    assert rates[-1] == PRESETS["cloudburst"].rain_rate
    assert all(b >= a for a, b in zip(rates, rates[1:], strict=False))
    assert max(b - a for a, b in zip(rates, rates[1:], strict=False)) < 0.03 * rates[-1]
    assert not mood.changing


def test_a_change_of_mind_half_way_goes_on_from_there() -> None:
    mood = MoodChanger("heavy", 0.0)
    mood.choose("clear")
    mood.update(CHANGE_TIME / 2)
    half = mood.current.rain_rate
    mood.choose("heavy")
    mood.update(1e-6)
    assert mood.current.rain_rate == pytest.approx(half, rel=1e-3)


def test_wind_by_hand_stays_in_its_range_and_keeps_the_rain() -> None:
    mood = MoodChanger("heavy", 0.0)
    for _ in range(40):
        mood.blow(2.0)
    mood.turn_wind(0.5)
    mood.update(10.0)
    assert mood.current.wind_speed == STRONGEST_WIND
    assert mood.current.wind_heading == pytest.approx(0.5)
    assert mood.current.rain_rate == preset_mood("heavy", 0.0).rain_rate
    for _ in range(40):
        mood.blow(-2.0)
    mood.update(10.0)
    assert mood.current.wind_speed == 0.0


def test_times_of_day_go_round_and_the_light_never_comes_from_below() -> None:
    esper.switch_world("times of day")
    weather, sky = Weather(), SkyChanger(runs=True)
    esper.create_entity(sky.atmosphere)
    lamps = {}
    for _ in range(len(TIMES)):
        sky.next()
        before = float(sky.atmosphere.time)
        for _ in range(26):
            sky.update(0.2)
            esper.process(0.0)
            light = light_of(weather.light)
            sky.cover(0.1, 1.0, light)
            assert light.sun_direction[1] > 0.0
            assert math.hypot(*light.sun_direction) == pytest.approx(1.0)
            for color in (light.sun_color, light.zenith_color, light.horizon_color):
                assert all(0.0 <= channel <= 2.0 for channel in color)
            assert float(sky.atmosphere.time) >= before or sky.atmosphere.speed
        assert sky.atmosphere.time == seconds(next(t.time for t in TIMES if t.name == sky.name))
        assert sky.atmosphere.speed == 1.0
        lamps[sky.name] = light.lamps
    assert sky.name == TIMES[0].name
    assert lamps["dusk"] == lamps["night"] == 1.0
    assert LAMPS_LEAST <= lamps["noon"] < 1.1 * LAMPS_LEAST < lamps["evening"]
    assert 1.0 < sky_exposure(weather, sky, "night") <= MOST_EXPOSURE
    assert sky_exposure(weather, sky, "noon") == 1.0
    weather.close()
    esper.switch_world("default")
    esper.delete_world("times of day")


def sky_exposure(weather: Weather, sky: SkyChanger, time: str) -> float:
    sky.be(time)
    for _ in range(3):
        esper.process(0.0)
        sky.cover(0.1, 1.0, light_of(weather.light))
    return sky.atmosphere.exposure


class FakePad:
    """A gamepad as pyglet gives it, without the plastic."""

    def __init__(self, broken: bool = False) -> None:
        self.broken, self.is_open = broken, False
        self.handlers: dict[str, Callable[..., None]] = {}

    def open(self) -> None:
        if self.broken:
            raise OSError("no permission")
        self.is_open = True

    def close(self) -> None:
        self.is_open = False

    def push_handlers(self, **handlers: Callable[..., None]) -> None:
        self.handlers.update(handlers)

    def remove_handlers(self, **handlers: Callable[..., None]) -> None:
        for name in handlers:
            self.handlers.pop(name)


@pytest.fixture
def pads(monkeypatch: pytest.MonkeyPatch) -> list[FakePad]:
    found: list[FakePad] = []
    manager = FakePad()
    manager.get_controllers = lambda: found  # type: ignore[attr-defined]
    module = ModuleType("pyglet.input")
    module.ControllerManager = lambda: manager  # type: ignore[attr-defined]
    monkeypatch.setitem(sys.modules, "pyglet.input", module)
    monkeypatch.setattr(pyglet, "input", module)
    return found


def test_a_gamepad_walks_looks_jumps_and_pauses(pads: list[FakePad]) -> None:
    pad, controls, paused = FakePad(), Controls(), []
    pads.append(pad)
    gamepads = Gamepads(controls, pause=lambda: paused.append(True))
    assert pad.is_open
    pad.handlers["on_stick_motion"](pad, "leftstick", SimpleNamespace(x=1.0, y=0.0))
    pad.handlers["on_stick_motion"](pad, "rightstick", SimpleNamespace(x=-1.0, y=0.0))
    pad.handlers["on_button_press"](pad, "a")
    pad.handlers["on_button_press"](pad, "b")
    pad.handlers["on_button_press"](pad, "start")
    intent = controls.intent()
    assert (intent.right, intent.run, intent.jump) == (1.0, True, True)
    assert controls.turn(0.1)[0] > 0.0
    assert paused == [True]
    pad.handlers["on_button_release"](pad, "a")
    pad.handlers["on_button_release"](pad, "b")
    assert not controls.intent().jump
    gamepads.close()
    assert not pad.is_open
    assert controls.intent().right == 0.0


def test_a_gamepad_that_does_not_open_is_left_alone(pads: list[FakePad]) -> None:
    pads.append(FakePad(broken=True))
    Gamepads(Controls(), pause=lambda: None).close()
    assert pads[0].handlers == {}


def test_mouse_that_the_game_sets_free_is_no_choice() -> None:
    rest = MouseRest()
    assert not rest.moved(100, 100)
    rest.frame()
    assert not rest.moved(240, 135)  # put back where it was
    for _ in range(3):
        rest.frame()
    assert not rest.moved(241, 135)
    assert rest.moved(250, 135)
