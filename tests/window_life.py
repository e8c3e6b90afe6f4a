"""What happens to windows while weather is on them; each `case_...` runs in a process of its own.

`window_life.py CASE` exits 0 when all that CASE asserts holds.
"""

from __future__ import annotations

import random
import sys
from typing import Any

import esper
import moderngl
import numpy as np
import pyglet
from pyglet import gl

import gl_state
from weather_ecs import Weather
from weather_ecs.components import RainArea
from weather_ecs.errors import ClosedError, ContextError, WeatherError
from window_host import camera, make_weather, screenshot
from xvfb import wait_until

Window = pyglet.window.Window


def open_window(width: int = 320, height: int = 240, **settings: Any) -> Any:
    return Window(width, height, vsync=False, resizable=True, **settings)


def show(window: Any, weather: Weather, frames: int = 3) -> np.ndarray:
    """Draw frames of rain on black; the last one's picture, RGB."""
    view, projection = camera(window.get_size())
    for _ in range(frames):
        window.switch_to()
        window.dispatch_events()
        window.clear()
        esper.process(1 / 60)
        before = gl_state.read_state()
        weather.draw(view, projection)
        changed = gl_state.differences(before, gl_state.read_state())
        assert not changed, changed
        assert gl_state.error() == 0
        picture = screenshot()
        window.flip()
    return picture[..., :3]


def wait_for_size(window: Any, size: tuple[int, int]) -> None:
    def ask() -> bool:
        window.dispatch_events()
        return window.get_size() == size

    window.set_size(*size)
    wait_until(ask, f"window size {size}")


def case_resize() -> None:
    window = open_window()
    with make_weather(window, "visible") as weather:
        for size in ((320, 240), (640, 200), (200, 500), (1, 1), (300, 300)):
            wait_for_size(window, size)
            picture = show(window, weather)
            assert picture.shape == (size[1], size[0], 3)
            if min(size) > 1:
                # The whole picture gets rain, its upper and right parts too.
                h, w = size[1] // 2, size[0] // 2
                for part in (picture[:h, :w], picture[h:, :w], picture[:h, w:], picture[h:, w:]):
                    assert part.max() > 0, size


def case_minimise() -> None:
    window = open_window()
    with make_weather(window, "visible") as weather:
        show(window, weather)
        window.minimize()
        show(window, weather)
        window.set_visible(False)
        gl.glViewport(0, 0, 0, 0)
        for size in ((0, 0), (320, 0), (0, 240)):
            view, projection = camera((max(size[0], 1), size[1]))
            gl.glViewport(0, 0, *size)
            esper.process(1 / 60)
            weather.draw(view, projection)
            assert gl_state.error() == 0
        assert gl_state.read_state()["VIEWPORT"] == (0, 0, 0, 240)
        gl.glViewport(0, 0, 320, 240)
        window.set_visible(True)
        assert show(window, weather).max() > 0


def case_closed_window() -> None:
    window = open_window()
    weather = make_weather(window, "visible")
    show(window, weather)
    view, projection = camera()
    window.close()
    esper.process(1 / 60)
    weather.draw(view, projection)  # does nothing
    for ask in (weather.air, weather.wetness):
        try:
            ask()
        except ContextError as error:
            assert str(error) == "the window is closed"
        else:
            raise AssertionError("maps of a window that is closed")
    weather.close()
    weather.close()
    try:
        Weather(window)
    except ContextError as error:
        assert str(error) == "the window is closed"
    else:
        raise AssertionError("weather on a window that is closed")


def case_recreated_window() -> None:
    first = open_window()
    weather = make_weather(first, "visible", seed=7)
    show(first, weather, 20)
    saved, time = weather.snapshot(), weather.stats.time
    first.close()
    weather.close()

    second = open_window()
    # The game's entities are still there: the world is the game's, not the window's.
    assert len(esper.get_component(RainArea)) == 1
    with Weather(second, seed=7) as again:
        again.restore(saved)
        assert len(esper.get_component(RainArea)) == 1
        assert show(second, again).max() > 0
        assert again.stats.time > time
    second.close()


def case_two_windows() -> None:
    windows = [open_window(caption=str(i)) for i in range(2)]
    weathers = []
    for i, window in enumerate(windows):
        window.switch_to()
        esper.switch_world(f"world {i}")
        weathers.append(make_weather(window, "visible", seed=i))
    pictures = []
    for _ in range(3):
        for i, window in enumerate(windows):
            esper.switch_world(f"world {i}")
            pictures.append(show(window, weathers[i], 1))
    assert all(picture.max() > 0 for picture in pictures)
    esper.switch_world("world 0")
    windows[0].switch_to()
    weathers[0].close()
    windows[0].close()
    esper.switch_world("world 1")
    assert show(windows[1], weathers[1]).max() > 0
    windows[1].switch_to()
    weathers[1].close()


def case_other_context_current() -> None:
    """Drawing while another window's context is current: an error, or nothing harmed."""
    mine, other = open_window(caption="mine"), open_window(caption="other")
    mine.switch_to()
    weather = make_weather(mine, "visible")
    show(mine, weather)
    other.switch_to()
    other.clear()
    before = gl_state.read_state()
    view, projection = camera()
    esper.process(1 / 60)
    try:
        weather.draw(view, projection)
    except WeatherError as error:
        assert "current" in str(error)
    assert gl.current_context is other.context, "the host goes on drawing to the other window"
    assert not gl_state.differences(before, gl_state.read_state())
    assert gl_state.error() == 0
    assert show(mine, weather).max() > 0
    weather.close()


def case_close_gives_everything_back() -> None:
    window = open_window()
    ctx = moderngl.get_context()
    window.clear()
    processors = list(esper._processors)
    before = gl_state.live_objects()
    for backend in ("feedback", "compute", "auto"):
        weather = make_weather(window, "visible", backend=backend)
        assert len(esper._processors) > len(processors)
        for quality in ("low", "ultra", "medium"):
            weather.quality = quality
            assert show(window, weather).max() > 0
        assert gl_state.live_objects() > before
        weather.close()
        left = gl_state.live_objects() - before
        assert not left, left
        assert esper._processors == processors
        weather.close()
        try:
            weather.draw(*camera())
        except ClosedError:
            pass
        else:
            raise AssertionError("draw after close")
    with Weather(window) as weather:
        weather.draw(*camera())
    weather.close()
    assert gl_state.live_objects() == before
    # The context is the host's and still works.
    ctx.buffer(b"abcd").release()
    window.clear()
    assert gl_state.error() == 0


def case_good_guest() -> None:
    """No handlers, clock callbacks, prints, collection modes or global seeds."""
    window = open_window()
    ctx = moderngl.get_context()
    pyglet.clock.schedule_interval(lambda dt: None, 100.0)

    def look() -> dict[str, Any]:
        clock = pyglet.clock.get_default()
        return {
            "handlers": {name: id(getattr(window, name, None)) for name in ("on_draw",)},
            "stack": [dict(level) for level in getattr(window, "_event_stack", ())],
            "clock": (len(clock._schedule_interval_items), len(clock._schedule_items)),
            "gc": ctx.gc_mode,
            "random": random.getstate(),
            "numpy": [str(part) for part in np.random.get_state()],  # noqa: NPY002
        }

    before = look()
    weather = make_weather(window, "visible")
    show(window, weather)
    assert look() == before
    weather.close()
    assert look() == before


def case_hostile_state() -> None:
    """The same rain whatever state the host left behind."""
    window = open_window()
    ctx = moderngl.get_context()
    sampler = ctx.sampler(repeat_x=False, filter=(moderngl.NEAREST, moderngl.NEAREST))
    trash = ctx.texture((4, 4), 4, b"\x7f" * 64)
    unpack = gl.GLuint()
    gl.glGenBuffers(1, unpack)
    vertex_array = gl.GLuint()
    gl.glGenVertexArrays(1, vertex_array)

    def calm() -> None:
        pass

    def functions() -> None:
        gl.glEnable(gl.GL_BLEND)
        gl.glBlendFuncSeparate(gl.GL_ZERO, gl.GL_ZERO, gl.GL_ZERO, gl.GL_ZERO)
        gl.glBlendEquation(gl.GL_FUNC_REVERSE_SUBTRACT)
        gl.glBlendColor(0.3, 0.4, 0.5, 0.6)
        gl.glEnable(gl.GL_CULL_FACE)
        gl.glCullFace(gl.GL_FRONT_AND_BACK)
        gl.glFrontFace(gl.GL_CW)
        gl.glDisable(gl.GL_DEPTH_TEST)

    def depth() -> None:
        gl.glEnable(gl.GL_DEPTH_TEST)
        gl.glDepthFunc(gl.GL_NEVER)
        gl.glDepthMask(gl.GL_FALSE)

    def raster() -> None:
        gl.glPolygonMode(gl.GL_FRONT_AND_BACK, gl.GL_LINE)
        gl.glEnable(gl.GL_RASTERIZER_DISCARD)
        gl.glEnable(gl.GL_PRIMITIVE_RESTART)
        gl.glPrimitiveRestartIndex(1)
        gl.glEnable(gl.GL_POLYGON_OFFSET_FILL)
        gl.glPolygonOffset(50.0, 1000.0)

    def bindings() -> None:
        for unit in range(16):
            trash.use(unit)
            sampler.use(unit)
        gl.glActiveTexture(gl.GL_TEXTURE9)
        gl.glBindBuffer(gl.GL_PIXEL_UNPACK_BUFFER, unpack)
        gl.glPixelStorei(gl.GL_UNPACK_ALIGNMENT, 8)
        gl.glPixelStorei(gl.GL_UNPACK_ROW_LENGTH, 77)
        gl.glBindVertexArray(vertex_array)
        gl.glUseProgram(0)

    def restore() -> None:
        for switch in ("CULL_FACE", "RASTERIZER_DISCARD", "PRIMITIVE_RESTART", "BLEND"):
            gl.glDisable(getattr(gl, "GL_" + switch))
        gl.glDisable(gl.GL_POLYGON_OFFSET_FILL)
        gl.glPolygonMode(gl.GL_FRONT_AND_BACK, gl.GL_FILL)
        gl.glBindBuffer(gl.GL_PIXEL_UNPACK_BUFFER, 0)
        gl.glPixelStorei(gl.GL_UNPACK_ALIGNMENT, 4)
        gl.glPixelStorei(gl.GL_UNPACK_ROW_LENGTH, 0)
        gl.glDepthFunc(gl.GL_LESS)
        gl.glDepthMask(gl.GL_TRUE)
        for unit in range(16):
            gl.glBindSampler(unit, 0)
        gl.glActiveTexture(gl.GL_TEXTURE0)

    view, projection = camera()
    pictures = {}
    for disturb in (calm, functions, depth, raster, bindings):
        esper.clear_database()
        # A fresh weather each time: what it makes on first use is made in that state too.
        weather = make_weather(window, "visible", seed=3)
        for _ in range(3):
            window.clear()
            esper.process(1 / 60)
            disturb()
            before = gl_state.read_state()
            weather.draw(view, projection)
            changed = gl_state.differences(before, gl_state.read_state())
            assert not changed, (disturb.__name__, changed)
            assert gl_state.error() == 0
            restore()
        pictures[disturb.__name__] = screenshot()
        weather.close()
    assert pictures["calm"][..., :3].max() > 0
    for name, picture in pictures.items():
        wrong = int((picture != pictures["calm"]).any(axis=2).sum())
        assert wrong == 0, f"{name}: {wrong} pixels differ"


def main(case: str) -> None:
    globals()[f"case_{case}"]()


if __name__ == "__main__":
    main(sys.argv[1])
