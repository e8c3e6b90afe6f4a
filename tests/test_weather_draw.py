"""`Weather.draw`: what it asks of window, context and renderer, and what it leaves alone."""

from __future__ import annotations

import gc
import math
import sys
from types import SimpleNamespace
from typing import Any

import esper
import numpy as np
import pytest
from pyglet.math import Mat4

from tests.worlds import fresh_world
from weather_ecs import ContextError, InvalidValueError, Weather
from weather_ecs.components import Observer, RainArea, RippleSurface, Wind
from weather_ecs.gpu import context as gpu_context
from weather_ecs.gpu import renderer as gpu_renderer
from weather_ecs.quality import LEVELS
from weather_ecs.systems import WeatherProcessor

pytestmark = pytest.mark.usefixtures("world")

NEAR, FAR_AWAY = 0.1, 1000.0
FOCUS = 1.0 / math.tan(0.5)
PROJECTION = np.array(
    [
        (FOCUS * 9 / 16, 0, 0, 0),
        (0, FOCUS, 0, 0),
        (0, 0, -(FAR_AWAY + NEAR) / (FAR_AWAY - NEAR), -2 * FAR_AWAY * NEAR / (FAR_AWAY - NEAR)),
        (0, 0, -1, 0),
    ]
)


def view_from(x: float, y: float, z: float) -> np.ndarray:
    matrix = np.eye(4)
    matrix[:3, 3] = (-x, -y, -z)
    return matrix


class FakeRenderer:
    """Keeps what it was asked to draw."""

    def __init__(self, ctx: Any, *, backend: str, seed: int) -> None:
        self.ctx, self.backend, self.seed = ctx, "feedback", seed
        self.asked_backend = backend
        self.stats = {"drops_moved": 10, "drops_drawn": 9, "containers": 1, "gpu_ms": 2.0}
        self.drawn: list[tuple[Any, Any]] = []
        self.forgotten: list[int] = []
        self.released = 0

    def draw(self, view: Any, settings: Any) -> None:
        assert not self.released
        self.drawn.append((view, settings))

    def forget(self, key: int) -> None:
        self.forgotten.append(key)

    def reseed(self, seed: int) -> None:
        self.seed = seed

    def release(self) -> None:
        self.released += 1


class FakeWindow:
    def __init__(self) -> None:
        self.context: object | None = object()
        self.has_exit = False
        self.size = (640, 480)
        self.view, self.projection = view_from(1, 2, 3), PROJECTION
        self.switches = 0

    def get_size(self) -> tuple[int, int]:
        return self.size

    def switch_to(self) -> None:
        assert self.context is not None
        self.switches += 1


@pytest.fixture
def made(monkeypatch):
    """Renderers made, oldest first; no OpenGL."""
    renderers: list[FakeRenderer] = []

    def make(*args: Any, **kwargs: Any) -> FakeRenderer:
        renderers.append(FakeRenderer(*args, **kwargs))
        return renderers[-1]

    monkeypatch.setattr(gpu_context, "obtain", lambda context: SimpleNamespace(given=context))
    monkeypatch.setattr(gpu_renderer, "Renderer", make)
    return renderers


def test_a_window_gives_context_and_matrices(made):
    window = FakeWindow()
    weather = Weather(window, seed=8, backend="feedback")
    assert (made[0].asked_backend, made[0].seed, made[0].ctx.given) == ("feedback", 8, None)
    assert weather.backend == weather.stats.backend == "feedback"
    weather.draw()
    view, settings = made[0].drawn[0]
    assert view.position == pytest.approx((1, 2, 3))
    assert window.switches >= 2  # before the renderer is made, and before it draws
    assert settings.name == "auto"
    weather.draw(view_from(4, 5, 6))
    assert made[0].drawn[1][0].position == pytest.approx((4, 5, 6))
    weather.close()
    weather.close()
    assert made[0].released == 1


def test_a_window_whose_projection_is_still_flat_is_told_once(made, caplog):
    window = FakeWindow()
    weather = Weather(window)
    flat = Mat4.orthogonal_projection(0, 640, 0, 480, -8192, 8192)  # pyglet's first one
    weather.draw()
    weather.draw(projection=flat)  # somebody means it
    window.projection = Mat4.orthogonal_projection(-32, 32, -24, 24, 0.1, 100)
    weather.draw()
    assert not caplog.records
    window.projection = flat
    for _ in range(3):
        weather.draw()
    (record,) = caplog.records
    assert "flat, a pixel for a metre" in record.getMessage()
    weather.close()


def test_the_window_that_was_current_is_current_again(made, monkeypatch):
    class Current:
        """What pyglet keeps of the context that is current."""

        def __init__(self) -> None:
            self.current_context: object = other

    class OtherContext:
        def set_current(self) -> None:
            gl.current_context = self

    other = OtherContext()
    gl = Current()
    monkeypatch.setitem(sys.modules, "pyglet.gl", gl)
    window = FakeWindow()
    monkeypatch.setattr(window, "switch_to", lambda: setattr(gl, "current_context", window.context))

    def draw(view: Any, settings: Any) -> None:
        assert gl.current_context is window.context
        raise RuntimeError("a fault in the middle of drawing")

    weather = Weather(window)
    assert gl.current_context is other
    weather.draw()
    assert gl.current_context is other
    monkeypatch.setattr(made[0], "draw", draw)
    with pytest.raises(RuntimeError, match="a fault"):
        weather.draw()
    assert gl.current_context is other
    weather.close()
    assert gl.current_context is other


def test_a_closed_or_empty_window_is_a_harmless_frame(made):
    window = FakeWindow()
    weather = Weather(window)
    esper.process(0.1)
    window.size = (0, 480)
    weather.draw()
    window.size = (640, 0)
    weather.draw(np.zeros((4, 4)), None)  # an aspect of 0 gives no matrix either
    window.size = (640, 480)
    window.has_exit = True
    weather.draw()
    window.has_exit, window.context = False, None
    weather.draw()
    assert made[0].drawn == []
    assert weather.stats.time == pytest.approx(0.1)
    weather.close()
    assert made[0].released == 0  # its objects went with the window


def test_what_was_drawn_is_forgotten_in_the_window_s_context(made, monkeypatch):
    window = FakeWindow()
    weather = Weather(window)
    switches = []
    monkeypatch.setattr(made[0], "forget", lambda key: switches.append(window.switches))
    before = window.switches
    weather.forget_drawn()
    window.context = None  # what it was drawn with went with the window
    weather.forget_drawn()
    assert switches == [before + 1]
    weather.close()
    weather.forget_drawn()
    assert len(switches) == 1


def test_a_window_that_is_closed_from_the_start(made):
    window = FakeWindow()
    window.context = None
    with pytest.raises(ContextError, match="closed"):
        Weather(window)
    with pytest.raises(InvalidValueError, match="window"):
        Weather("window")
    assert esper.get_processor(WeatherProcessor) is None
    assert made == []


def test_a_renderer_that_fails_leaves_no_weather(monkeypatch, made):
    def fail(*args: Any, **kwargs: Any) -> None:
        raise ContextError("too old")

    monkeypatch.setattr(gpu_renderer, "Renderer", fail)
    with pytest.raises(ContextError, match="too old"):
        Weather(FakeWindow())
    assert esper.get_processor(WeatherProcessor) is None


@pytest.mark.parametrize(
    ("view", "projection"),
    [
        (None, PROJECTION),
        (np.eye(4), None),
        (np.eye(3), PROJECTION),
        (np.zeros((4, 4)), PROJECTION),
        (np.full((4, 4), np.nan), PROJECTION),
        (np.eye(4), np.zeros((4, 4))),
        (np.eye(4), [1.0] * 15),
        ("view", PROJECTION),
    ],
)
def test_bad_matrices_draw_nothing(made, view, projection):
    weather = Weather(context=object())
    with pytest.raises(InvalidValueError, match=r"view|projection"):
        weather.draw(view, projection)
    assert made[0].drawn == []


def test_a_draw_does_not_move_time(made):
    weather = Weather(context=object())
    esper.create_entity(RainArea((0, 0), (60, 40), velocity=(1, 0)))
    esper.process(0.13)
    before = weather.snapshot()
    for _ in range(3):
        weather.draw(np.eye(4), PROJECTION)
    assert weather.snapshot() == before
    views = [view for view, _ in made[0].drawn]
    assert views[0].frame is views[1].frame is views[2].frame
    assert [view.dt for view in views[1:]] == [0.0, 0.0]


def test_observers_have_keys_of_their_own(made):
    weather = Weather(context=object())
    left, right = Observer(), Observer()
    for observer in (None, left, right, left, None):
        weather.draw(np.eye(4), PROJECTION, observer=observer)
    keys = [view.key for view, _ in made[0].drawn]
    assert keys == [0, keys[1], keys[2], keys[1], 0]
    assert len(set(keys)) == 3
    for wrong in (1, "left", RainArea((0, 0), (2, 1)), Observer):
        with pytest.raises(InvalidValueError, match="observer"):
            weather.draw(np.eye(4), PROJECTION, observer=wrong)


def test_observers_that_are_gone_are_forgotten(made):
    weather = Weather(context=object())
    for _ in range(300):
        weather.draw(np.eye(4), PROJECTION, observer=Observer())
    gc.collect()
    weather.draw(np.eye(4), PROJECTION)
    assert len(weather._keys) <= 1
    assert len(weather._view._observed) <= 2
    keys = {view.key for view, _ in made[0].drawn}
    assert len(keys) == 301
    assert set(made[0].forgotten) == keys - {0}


def test_stats_of_a_draw(made):
    weather = Weather(context=object(), quality="low")
    esper.create_entity(RainArea((50, 0), (20, 20), 9.0, soft_edge=0.0))
    weather.draw(view_from(0, 2, 0), PROJECTION)
    assert weather.stats.mode == "far"
    weather.draw(view_from(50, 2, 0), PROJECTION)
    stats = weather.stats
    assert (stats.mode, stats.rain_rate_here) == ("near", 9.0)
    assert (stats.drops_moved, stats.drops_drawn, stats.containers) == (10, 9, 1)
    assert (stats.impacts, stats.splashes) == (0, 0)
    assert stats.ms > 0.0
    assert made[0].drawn[-1][1] is LEVELS["low"]


def test_drawing_from_another_world(made, world):
    weather = Weather(context=object())
    esper.create_entity(RainArea((0, 0), (60, 40), 9.0))
    with fresh_world() as other:
        weather.draw(np.eye(4), PROJECTION)
        assert esper.current_world == other
    assert len(made[0].drawn[0][0].frame.areas) == 1


def test_an_area_that_dies_between_process_and_draw(made):
    weather = Weather(context=object())
    entity = esper.create_entity(RainArea((0, 0), (60, 40), 9.0))
    esper.process(0.1)
    esper.delete_entity(entity)
    weather.draw(np.eye(4), PROJECTION)
    esper.process(0.1)
    weather.draw(np.eye(4), PROJECTION)
    assert all(len(view.frame.areas) == 0 for view, _ in made[0].drawn)


def test_a_snapshot_with_another_seed_gets_other_drops(made):
    weather = Weather(context=object(), seed=1)
    esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
    same = weather.snapshot()
    weather.draw(np.eye(4), PROJECTION)
    weather.restore(same)
    weather.draw(np.eye(4), PROJECTION)
    assert len(made) == 1
    with fresh_world(), Weather(seed=2) as server:
        esper.create_entity(RainArea((0, 0), (60, 40), 25.0))
        other = server.snapshot()
    weather.restore(other)
    weather.draw(np.eye(4), PROJECTION)
    assert [renderer.seed for renderer in made] == [2]
    assert made[0].released == 0
    first, second, third = (view.containers[0].births for view, _ in made[0].drawn)
    assert first is second
    assert not np.array_equal(first, third)


def test_auto_learns_from_frames_and_not_from_draws(made, monkeypatch):
    weather = Weather(context=object())
    fed: list[tuple[float, float, float]] = []
    monkeypatch.setattr(weather._auto, "feed", lambda *figures: fed.append(figures))
    for _ in range(4):
        esper.process(1 / 60)
        weather.draw(np.eye(4), PROJECTION)
        weather.draw(np.eye(4), PROJECTION)
    assert len(fed) == 3
    for frame, gpu, cpu in fed:
        assert gpu == 4.0  # both draws
        assert 0.0 < cpu <= frame


# With OpenGL


@pytest.fixture
def target(ctx, keep):
    """A framebuffer with colour and depth, bound."""
    size = (160, 90)
    color, depth = keep(ctx.texture(size, 4)), keep(ctx.depth_renderbuffer(size))
    result = keep(ctx.framebuffer([color], depth))
    result.use()
    return result


def test_a_client_that_draws_and_a_server_have_the_same_bytes(ctx, target):
    def play(**arguments: Any) -> bytes:
        with fresh_world(), Weather(seed=6, quality="low", **arguments) as weather:
            esper.create_entity(RainArea((0, 0), (60, 40), 25.0, velocity=(1, 2), drift=0.3))
            esper.create_entity(Wind((1, 0), 5.0))
            for number in range(4):
                esper.process(0.07 * number)
                if arguments:
                    weather.draw(view_from(0, 2, 0), PROJECTION)
                    weather.draw(view_from(0, 2, 0), PROJECTION, observer=Observer())
            return weather.snapshot()

    assert play(context=ctx) == play()


@pytest.mark.parametrize("wrong", [5, "me", (0.0, 1.0, 2.0), RainArea((0, 0), (2, 1))])
def test_what_is_no_observer_is_named_everywhere(wrong):
    with Weather() as weather:
        asked = (weather.draw, weather.air, weather.wetness, weather.cloud_shadow, weather.sky)
        for ask in asked:
            with pytest.raises(InvalidValueError, match="observer: got"):
                ask(observer=wrong)
        with pytest.raises(InvalidValueError, match="observer: got"):
            weather.ripples(RippleSurface((0, 0, 0), (2, 2)), observer=wrong)


@pytest.mark.parametrize("backend", ["compute", "feedback"])
def test_it_rains_on_the_picture_and_close_gives_all_back(ctx, target, backend):
    from weather_ecs.gpu.context import probe

    if backend == "compute" and not probe(ctx).compute:
        with pytest.raises(ContextError, match=r"4\.3"):
            Weather(context=ctx, backend="compute")
        return
    pictures = []
    with Weather(context=ctx, seed=6, quality="medium", backend=backend) as weather:
        assert weather.backend == backend
        for rate in (0.0, 50.0):
            esper.create_entity(RainArea((0, 0), (60, 40), rate))
            for _ in range(3):
                esper.process(1 / 30)
                target.clear()
                weather.draw(view_from(0, 2, 0), PROJECTION)
            pictures.append(np.frombuffer(target.read(), np.uint8))
            assert weather.stats.mode == ("near" if rate else "none")
    assert pictures[0].max() == 0
    assert pictures[1].mean() > 1.0
    assert weather.stats.drops_moved > 0
