"""`Weather` without OpenGL: a game server, worlds, life and death."""

from __future__ import annotations

import gc
import logging
import math
import random
import subprocess
import sys
from pathlib import Path

import esper
import numpy as np
import pytest
from hypothesis import given, settings
from hypothesis import strategies as st

from tests.worlds import fresh_world
from weather_ecs import (
    ClosedError,
    ContextError,
    InvalidValueError,
    Weather,
    WeatherError,
)
from weather_ecs.components import Observer, PointLight, RainArea, RainContainer, Sun, Wind
from weather_ecs.systems import WeatherProcessor

pytestmark = pytest.mark.usefixtures("world")

ROOT = Path(__file__).resolve().parent.parent
EYE = np.eye(4)


def test_a_weather_lives_in_the_world_that_was_current(world):
    weather = Weather(seed=4)
    assert isinstance(esper.get_processor(WeatherProcessor), WeatherProcessor)
    assert weather.backend == "none"
    assert weather.quality == "auto"
    esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
    esper.process(0.5)
    assert weather.stats.time == pytest.approx(0.5)
    assert weather.sample((0, 0, 0)).rain_rate == 25.0
    weather.close()
    assert esper.get_processor(WeatherProcessor) is None
    esper.process(0.5)
    assert weather.stats.time == pytest.approx(0.5)


def test_importing_loads_no_opengl_and_making_a_server_neither():
    program = (
        "import sys, logging, random, weather_ecs, numpy as np; w = weather_ecs.Weather();"
        "import esper; esper.process(0.1); w.sample((0, 0, 0)); w.close();"
        "assert not {'moderngl', 'pyglet'} & set(sys.modules);"
        "assert not logging.getLogger().handlers"
    )
    result = subprocess.run(
        [sys.executable, "-c", program], cwd=ROOT, timeout=60, capture_output=True, text=True
    )
    assert result.returncode == 0, result.stderr
    assert result.stdout == result.stderr == ""


@pytest.mark.parametrize(
    ("arguments", "field"),
    [
        ({"seed": -1}, "seed"),
        ({"seed": 1.5}, "seed"),
        ({"seed": True}, "seed"),
        ({"seed": None}, "seed"),
        ({"seed": 2**63}, "seed"),
        ({"quality": "best"}, "quality"),
        ({"quality": None}, "quality"),
        ({"backend": "vulkan"}, "backend"),
        ({"backend": None}, "backend"),
        ({"backend": "none"}, "backend"),
    ],
)
def test_bad_arguments_leave_nothing_behind(arguments, field):
    with pytest.raises(InvalidValueError, match=f"{field}: got .* allowed: "):
        Weather(**arguments)
    assert esper.get_processor(WeatherProcessor) is None


def test_a_world_has_one_weather():
    first = Weather()
    with pytest.raises(WeatherError, match="has a weather already: close"):
        Weather()
    assert esper.get_processor(WeatherProcessor) is first._processor
    first.close()
    second = Weather()
    first.close()
    assert esper.get_processor(WeatherProcessor) is second._processor


def test_several_worlds_each_with_its_weather(world):
    mine = Weather()
    esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
    with fresh_world() as other:
        theirs = Weather()
        esper.create_entity(RainArea((0, 0), (60, 40), 3.0))
        esper.process(1.0)
        assert mine.sample((0, 0, 0)).rain_rate == 25.0
        assert theirs.sample((0, 0, 0)).rain_rate == 3.0
        assert esper.current_world == other
        assert mine.stats.rain_rate_here == 25.0
        assert mine.stats.time == 0.0
        data = mine.snapshot()
        esper.switch_world(world)
        esper.process(2.0)
        assert theirs.stats.time == pytest.approx(1.0)
        esper.switch_world(other)
        mine.restore(data)
        assert esper.current_world == other
        assert mine.stats.time == 0.0
        assert len(esper.get_component(RainArea)) == 1
        mine.close()
        assert esper.current_world == other
        assert esper.get_processor(WeatherProcessor) is theirs._processor
    assert esper.get_processor(WeatherProcessor) is None
    Weather().close()


def test_a_deleted_world_is_an_error_not_a_new_world(world):
    with fresh_world() as other:
        weather = Weather()
        esper.switch_world(world)
        esper.delete_world(other)
        for use in (lambda: weather.sample((0, 0, 0)), weather.snapshot):
            with pytest.raises(WeatherError, match="deleted"):
                use()
        weather.close()
        assert other not in esper.list_worlds()


def test_closed_is_closed_twice_without_harm():
    with Weather() as weather:
        esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
        esper.process(0.1)
        data = weather.snapshot()
    weather.close()
    for use in (
        lambda: weather.sample((0, 0, 0)),
        lambda: weather.draw(EYE, EYE),
        weather.snapshot,
        lambda: weather.restore(data),
        lambda: setattr(weather, "quality", "low"),
        lambda: setattr(weather, "paused", True),
        lambda: setattr(weather, "speed", 2.0),
    ):
        with pytest.raises(ClosedError):
            use()
    assert weather.stats.frame == 1
    assert len(esper.get_component(RainArea)) == 1  # components belong to the game


def test_an_error_in_a_with_block_closes_too():
    with pytest.raises(KeyError), Weather():
        raise KeyError
    assert esper.get_processor(WeatherProcessor) is None


def test_closing_while_the_world_is_processed():
    class Ending(esper.Processor):
        def process(self, dt: float) -> None:
            weather.close()

    weather = Weather()
    esper.add_processor(Ending(), priority=5)
    esper.process(0.1)
    esper.process(0.1)
    assert esper.get_processor(WeatherProcessor) is None


def test_a_server_cannot_draw():
    with pytest.raises(ContextError, match="neither window nor context"):
        Weather(backend="compute").draw(EYE, EYE)


def test_pause_speed_and_quality():
    weather = Weather(quality="low")
    assert (weather.quality, weather.stats.quality) == ("low", "low")
    weather.quality = "ultra"
    assert (weather.quality, weather.stats.quality) == ("ultra", "ultra")
    with pytest.raises(InvalidValueError, match="quality"):
        weather.quality = "best"
    assert weather.quality == "ultra"
    weather.paused = True
    esper.process(1.0)
    assert weather.stats.time == 0.0
    assert weather.stats.frame == 1
    weather.paused = False
    weather.speed = 2.0
    esper.process(1.0)
    assert weather.stats.time == pytest.approx(2.0)
    with pytest.raises(InvalidValueError, match="speed"):
        weather.speed = -1
    with pytest.raises(InvalidValueError, match="paused"):
        weather.paused = "yes"
    assert (weather.speed, weather.paused) == (2.0, False)


@pytest.mark.parametrize("dt", [-1, math.nan, math.inf, -math.inf, "1", None, True])
def test_a_bad_dt_loses_nothing(dt):
    weather = Weather()
    esper.create_entity(RainArea((0, 0), (60, 40), velocity=(1, 0)))
    esper.process(0.13)
    before = weather.snapshot()
    with pytest.raises(InvalidValueError, match="dt"):
        esper.process(dt)
    assert weather.snapshot() == before
    esper.process(0.1)


def test_a_debuggers_pause_goes_on_without_a_burst():
    weather = Weather()
    area = RainArea((0, 0), (60, 40), velocity=(1, 0))
    esper.create_entity(area)
    esper.process(86_400.0)
    assert weather.stats.time == pytest.approx(10.0)
    assert area.center[0] == pytest.approx(10.0)


def test_stats_say_where_the_observer_is():
    weather = Weather()
    stats = weather.stats
    assert (stats.mode, stats.rain_rate_here) == ("none", 0.0)
    area = RainArea((100, 0), (20, 10), 8.0, soft_edge=0.0)
    entity = esper.create_entity(area)
    observer = Observer()
    esper.create_entity(observer)
    assert weather.stats is stats
    assert stats.mode == "far"
    observer.position = (100, 1, 0)
    assert weather.stats.mode == "near"
    assert stats.rain_rate_here == 8.0
    area.rain_rate = 0.0
    assert weather.stats.mode == "none"
    esper.delete_entity(entity)
    assert weather.stats.mode == "none"
    assert stats.backend == "none"


def test_areas_may_come_and_go_within_a_frame():
    class Chaos(esper.Processor):
        def process(self, dt: float) -> None:
            for entity, _ in esper.get_component(RainArea):
                esper.delete_entity(entity)
            esper.create_entity(RainArea((0, 0), (5, 5), 1.0, soft_edge=0.0))

    weather = Weather()
    for priority in (-5, 5):
        esper.add_processor(Chaos(), priority=priority)
    for _ in range(20):
        esper.process(0.07)
        assert weather.sample((0, 0, 0)).rain_rate == 1.0


def test_ten_thousand_creations_and_deletions_leave_memory_where_it_was():
    weather = Weather()

    def churn(count: int) -> None:
        for number in range(count):
            entity = esper.create_entity(
                RainArea((number, 0), (2, 1)), Wind(), Sun(), PointLight(), RainContainer()
            )
            if number % 10 == 0:
                esper.process(0.016)
                weather.sample((0, 0, 0))
            esper.delete_entity(entity, immediate=bool(number % 2))
        esper.process(0.016)
        weather.sample((0, 0, 0))
        gc.collect()

    churn(200)
    before = sys.getallocatedblocks()
    churn(10_000)
    assert sys.getallocatedblocks() - before < 500
    assert not weather._state.uids.by_entity


@settings(deadline=None, max_examples=30)
@given(st.lists(st.floats(0.0, 10.0), max_size=30), st.integers(0, 100))
def test_any_frame_times_keep_everything_finite(times, seed):
    rng = np.random.default_rng(seed)
    with fresh_world(), Weather() as weather:
        for _ in range(3):
            x, z, speed = rng.uniform(-100, 100, 3)
            esper.create_entity(
                RainArea((x, z), (50, 20), velocity=(speed, -speed), drift=rng.random())
            )
            esper.create_entity(Wind((x, z), abs(speed)))
        for dt in times:
            esper.process(dt)
            assert all(
                math.isfinite(x) and math.isfinite(z)
                for _, area in esper.get_component(RainArea)
                for x, z in [area.center]
            )
            sample = weather.sample((float(rng.uniform(-200, 200)), 0.0, 0.0))
            assert math.isfinite(sample.rain_rate + sample.visibility + sample.light)
            assert sample.visibility > 0.0


def test_an_hour_at_twenty_five_frames_a_second():
    weather = Weather()
    esper.create_entity(Wind((1, 1), 10.0))
    area = RainArea((0, 0), (60, 40), drift=0.5, velocity=(1, 0))
    esper.create_entity(area)
    for _ in range(2 * 3600):
        esper.process(0.5)
    assert weather.stats.time == pytest.approx(3600.0, abs=1e-6)
    assert area.center[1] == pytest.approx(3600.0 * 0.5 * 10.0 / math.sqrt(2.0), rel=1e-9)


def test_the_hosts_generators_and_loggers_are_left_alone():
    random.seed(1)
    python, handlers = random.getstate(), list(logging.getLogger().handlers)
    mine = np.random.get_state()[1].tolist()  # noqa: NPY002
    with Weather(seed=5):
        esper.create_entity(RainArea((0, 0), (2, 1)))
        esper.process(1.0)
    assert random.getstate() == python
    assert np.random.get_state()[1].tolist() == mine  # noqa: NPY002
    assert logging.getLogger().handlers == handlers
    assert esper.event_registry == {}
