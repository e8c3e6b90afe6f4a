"""`Weather.air` and weather.glsl: what a game's own shader reads is what the weather says."""

from __future__ import annotations

import math
import re
from collections.abc import Callable, Iterator
from typing import Any

import esper
import moderngl
import numpy as np
import pytest

from tests.gl_host import read_state
from tests.views import look_from, perspective
from weather_ecs import Weather, glsl
from weather_ecs.components import Air, Fog, Observer, RainArea, Sun, Wind
from weather_ecs.errors import ClosedError, ContextError, InvalidValueError
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.weather_air import WEATHER_AIR
from weather_ecs.physics.optics import (
    CLEAR,
    air_extinction,
    falling_extinction,
    fog_factor,
    layer_path,
)
from weather_ecs.physics.phase import share_at

pytestmark = pytest.mark.usefixtures("world")

BLACK, GREY = (0.0, 0.0, 0.0), (0.5, 0.4, 0.3)
FOG = (0.2, 0.3, 0.9)


@pytest.fixture
def weather(ctx: moderngl.Context) -> Iterator[Weather]:
    with Weather(context=ctx, quality="low") as it:
        yield it


Ask = Callable[..., np.ndarray]


@pytest.fixture
def ask(ctx: moderngl.Context) -> Iterator[Ask]:
    """Values of GLSL expressions (vec4 each), in a shader that includes weather.glsl."""
    made: list[Any] = []

    def values(air: Any, *expressions: str) -> np.ndarray:
        names = [f"out_{index}" for index in range(len(expressions))]
        text = "#" + "version 330\n" + glsl("weather.glsl")
        text += "".join(f"out vec4 {name};\n" for name in names) + "void main() {\n"
        text += "".join(f"{n} = {e};\n" for n, e in zip(names, expressions, strict=True)) + "}"
        program = ctx.program(vertex_shader=text, varyings=names)
        array = ctx.vertex_array(program, [])
        out = ctx.buffer(reserve=16 * len(names))
        made.extend((array, out, program))
        air.use(program)
        target.use()
        array.transform(out, moderngl.POINTS, vertices=1)
        return np.frombuffer(out.read(), np.float32).reshape(-1, 4)

    color = ctx.renderbuffer((4, 4))
    target = ctx.framebuffer([color])  # some drivers write nothing without one
    yield values
    for thing in (*made, target, color):
        thing.release()


def test_the_text_and_the_block_have_the_same_members() -> None:
    body = re.search(r"uniform WeatherAir\s*\{(.*?)\};", glsl("weather.glsl"), re.DOTALL)
    assert body is not None
    named = re.findall(r"^\s*(\w+) (\w+);", body[1], re.MULTILINE)
    assert [(name, kind) for kind, name in named] == [
        (field.name, field.type) for field in WEATHER_AIR.fields
    ]


def test_a_games_shader_reads_what_the_weather_says(weather: Weather, ask: Ask) -> None:
    esper.create_entity(Air(0.9, 0.95))
    esper.create_entity(Fog(400.0, FOG, depth=120.0))
    esper.create_entity(RainArea((0, 0), (60, 60), 20.0))
    esper.create_entity(Wind((0, 1), 7.0, exponent=0.2, ground=5.0))
    esper.create_entity(
        Sun((0, 2, 0), (2, 1, 0.5), zenith_color=(0, 0, 1), horizon_color=(1, 0, 0))
    )
    esper.process(0.5)
    share = share_at(0.9 - 6.5e-3 * 1.7, 0.95)
    assert 0.2 < share < 0.9  # a scene with both
    air = weather.air(position=(0.0, 1.7, 0.0))
    both = air_extinction(400.0) + falling_extinction(20.0 * (1 - share), 20.0 * share)
    found = ask(
        air, "weather_fog_color", "weather_fog_law", "weather_sun_direction", "weather_sun_color",
        "weather_zenith_color", "weather_horizon_color", "weather_wind_now", "weather_now",
        "weather_air", "vec4(weather_wind(15.0), 0.0)", "vec4(weather_wind(1000.0), 0.0)",
    )  # fmt: skip
    wanted = [
        (*FOG, air_extinction(400.0)), (both, 120.0, air_extinction(400.0) - CLEAR, 0),
        (0, 1, 0, 0), (2, 1, 0.5, 0), (0, 0, 1, 0), (1, 0, 0, 0), (0, 0, 7, 0),
        (0.5, 20 * (1 - share), 20 * share, 0), (0.9, 0.95, share_at(0.9, 0.95), 0),
        (*weather.sample((0, 15, 0)).wind, 0), (*weather.sample((0, 1000, 0)).wind, 0),
    ]  # fmt: skip
    np.testing.assert_allclose(found, np.array(wanted), rtol=1e-5, atol=1e-6)
    assert air.extinction == pytest.approx(air_extinction(400.0))
    assert air.extinction_with_rain == pytest.approx(both)
    assert air.visibility == pytest.approx(weather.sample((0, 1.7, 0)).visibility)
    assert (air.color, air.depth) == (FOG, 120.0)


def test_its_functions_keep_to_the_laws(weather: Weather, ask: Ask) -> None:
    esper.create_entity(Fog(400.0, FOG, depth=120.0))
    esper.create_entity(RainArea((0, 0), (60, 60), 50.0))
    air = weather.air(position=(0.0, 1.7, 0.0))
    far = [0.0, 100.0, 400.0, 5000.0]
    found = ask(
        air,
        *(f"vec4(weather_fog(vec3(0.5, 0.4, 0.3), {d}), weather_fog_left({d}))" for d in far),
        *(f"vec4(weather_fog_and_rain(vec3(0.5, 0.4, 0.3), {d}), 0.0)" for d in far),
    )
    for rows, extinction in (
        (found[:4], air_extinction(400.0)),
        (found[4:], air_extinction(400.0) + falling_extinction(50.0, 0.0)),
    ):
        left = fog_factor(far, extinction)[:, None]
        np.testing.assert_allclose(
            rows[:, :3], left * np.array(GREY) + (1 - left) * np.array(FOG), atol=1e-5
        )
    np.testing.assert_allclose(found[:4, 3], fog_factor(far, air_extinction(400.0)), atol=1e-5)
    assert found[2, 3] == pytest.approx(0.02, rel=1e-3)  # at the visibility

    rise = [-0.5, 0.0, 0.1, 1.0]
    ways = [f"vec3({math.sqrt(1 - y * y)}, {y}, 0.0)" for y in rise]
    found = ask(
        air, *(f"vec4(weather_sky_fog(vec3(0.0), {w}), weather_sky_left({w}))" for w in ways)
    )
    left = fog_factor(layer_path(rise, 120.0), air_extinction(400.0) - CLEAR)
    np.testing.assert_allclose(found[:, 3], left, atol=1e-5)
    np.testing.assert_allclose(found[:, :3], (1 - left)[:, None] * np.array(FOG), atol=1e-5)


def test_the_light_comes_from_sun_sky_and_ground(weather: Weather, ask: Ask) -> None:
    esper.create_entity(
        Sun((0, 1, 0), (3, 3, 3), zenith_color=(0.2,) * 3, horizon_color=(0.4,) * 3,
            ground_color=(0.1,) * 3)
    )  # fmt: skip
    air = weather.air()
    cases = (
        "vec3(0, 1, 0), 1.0",
        "vec3(0, 1, 0), 0.25",
        "vec3(0, -1, 0), 1.0",
        "vec3(1, 0, 0), 1.0",
    )
    found = ask(air, *(f"vec4(weather_light({case}), 0.0)" for case in cases))
    np.testing.assert_allclose(found[:, 0], [3.3, 1.05, 0.1, 0.2], atol=1e-5)


def test_clear_air_leaves_things_as_they_are(weather: Weather, ask: Ask) -> None:
    found = ask(
        weather.air(), "vec4(weather_fog(vec3(1.0), 10.0), weather_sky_left(vec3(0, 1, 0)))"
    )
    assert found[0] == pytest.approx([1.0] * 4, abs=1e-3)
    esper.create_entity(Fog(0.0, FOG))
    found = ask(
        weather.air(), "vec4(weather_fog(vec3(1.0), 10.0), weather_sky_left(vec3(0, 1, 0)))"
    )
    assert found[0] == pytest.approx([*FOG, 0.0], abs=1e-5)


def test_walking_in_the_rain_comes_smoothly(weather: Weather) -> None:
    esper.create_entity(RainArea((0, 0), (60, 60), 25.0, soft_edge=20.0))
    lost = [
        weather.air(position=(62.0 - 0.5 * k, 1.7, 0.0)).extinction_with_rain for k in range(60)
    ]
    assert lost[0] == pytest.approx(CLEAR)
    assert lost[-1] == pytest.approx(CLEAR + falling_extinction(25.0, 0.0))
    assert all(0.0 <= b - a < 2e-4 for a, b in zip(lost, lost[1:], strict=False))
    assert weather.air().extinction == pytest.approx(CLEAR)  # without the rain, everywhere


def test_it_is_the_last_draws_place_and_each_observers_own(
    ctx: moderngl.Context, weather: Weather
) -> None:
    esper.create_entity(RainArea((100, 0), (20, 20), 25.0))
    left, right = Observer((0, 1.7, 0)), Observer((100, 1.7, 0))
    for it in (left, right):
        esper.create_entity(it)
    assert weather.air(observer=left) is weather.air(observer=left)
    assert weather.air(observer=left) is not weather.air(observer=right)
    assert weather.air(observer=left).extinction_with_rain == pytest.approx(CLEAR)
    assert weather.air(observer=right).extinction_with_rain > 10 * CLEAR
    target = ctx.simple_framebuffer((32, 18))
    target.use()
    weather.draw(look_from((100.0, 1.7, 0.0), 0.0), perspective())
    assert weather.air().extinction_with_rain > 10 * CLEAR
    weather.draw(look_from((0.0, 1.7, 0.0), 0.0), perspective())
    assert weather.air().extinction_with_rain == pytest.approx(CLEAR)
    for thing in (*target.color_attachments, target.depth_attachment, target):
        thing.release()


def test_lightning_lights_the_air_where_one_asks(weather: Weather) -> None:
    """Also for the second place in a frame."""
    weather.strike((0.0, 0.0, 0.0), current=30.0)
    while not weather.frame().strikes["light"].sum() > 1.0:
        esper.process(0.002)
        assert weather.stats.time < 1.0

    def seen(x: float) -> np.ndarray:
        air = weather.air(position=(x, 2.0, 0.0))
        return np.array(air._block.data["weather_fog_color"][:3])

    here, far = seen(50.0), seen(20_000.0)
    assert (here > 1.05 * far).all()
    assert np.array_equal(seen(50.0), here)


def test_a_host_keeps_its_state(ctx: moderngl.Context, gl: GL, weather: Weather) -> None:
    buffer = ctx.buffer(reserve=64)
    buffer.bind_to_uniform_block(0)
    fog = Fog(100.0)
    esper.create_entity(fog)
    weather.air()
    before = read_state(gl)
    for visibility in (50.0, 20.0):
        fog.visibility = visibility
        esper.process(0.1)
        weather.air()
        assert read_state(gl) == before
    buffer.release()


def test_without_opengl_closed_or_nowhere() -> None:
    with Weather() as weather, pytest.raises(ContextError):
        weather.air()
    with pytest.raises(ClosedError):
        weather.air()


def test_a_place_that_is_none(weather: Weather) -> None:
    with pytest.raises(InvalidValueError, match="position"):
        weather.air(position=(1.0, math.nan, 0.0))
