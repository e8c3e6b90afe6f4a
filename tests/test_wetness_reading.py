"""The water on the ground as a game's own shader reads it."""

from __future__ import annotations

import re
from collections.abc import Callable, Iterator
from typing import Any

import esper
import moderngl
import numpy as np
import pytest

from tests.gl_host import Host, read_state
from tests.views import look_from, perspective
from tests.wetness_stage import Point
from tests.worlds import fresh_world
from weather_ecs import Weather, glsl
from weather_ecs.components import CollisionHeightmap, Observer, Occluder, RainArea, RainGauge, Wind
from weather_ecs.errors import ContextError
from weather_ecs.gpu.gl import GL
from weather_ecs.gpu.guard import StateGuard
from weather_ecs.gpu.wetness_map import WEATHER_WETNESS
from weather_ecs.physics.footprint import fall_speed_over
from weather_ecs.physics.wetness import DRYING

# As a game reads it


def test_the_block_in_the_public_include_is_the_declared_one() -> None:
    text = glsl("wetness.glsl")
    (found,) = re.findall(r"layout\(std140\) uniform WeatherWetness\s*\{(.*?)\};", text, re.S)
    members = [line.strip() for line in found.strip().splitlines()]
    assert members == [f"{field.glsl};" for field in WEATHER_WETNESS.fields]


VERTEX = "in vec3 in_at; in vec3 in_normal; in float in_relief; out vec4 got;"
BODY = """
    got = vec4(weather_wetness(in_at, in_normal), weather_puddle(in_at, in_normal, in_relief),
               weather_open_wetness(in_at), weather_damp(weather_water(in_at)));
"""


class Reader:
    """A game's own program that includes wetness.glsl."""

    def __init__(self, ctx: moderngl.Context) -> None:
        self.ctx = ctx
        main = "void " + "main() {" + BODY + "}"  # the import rules look for GLSL in Python
        text = "#" + "version 330\n" + glsl("wetness.glsl") + VERTEX + main
        self.program = ctx.program(vertex_shader=text, varyings=["got"])

    def __call__(
        self, weather: Weather, points: Any, normal: Point = (0, 1, 0), relief: float = 2.0,
        observer: Observer | None = None,
    ) -> np.ndarray:  # fmt: skip
        rows = np.array([(*p, *normal, relief) for p in points], np.float32)
        source, out = self.ctx.buffer(rows.tobytes()), self.ctx.buffer(reserve=16 * len(rows))
        names = ("in_at", "in_normal", "in_relief")
        array = self.ctx.vertex_array(self.program, [(source, "3f 3f 1f", *names)])
        weather.wetness(observer=observer).use(self.program)
        array.transform(out, moderngl.POINTS)
        got = np.frombuffer(out.read(), np.float32).reshape(-1, 4)
        for thing in (array, out, source):
            thing.release()
        return got


@pytest.fixture
def reader(ctx: moderngl.Context) -> Iterator[Reader]:
    target = ctx.simple_framebuffer((8, 8))
    target.use()
    made = Reader(ctx)
    yield made
    made.program.release()
    target.color_attachments[0].release()  # type: ignore[union-attr]
    target.depth_attachment.release()  # type: ignore[union-attr]
    target.release()


def ground(y: float = 0.0, half: float = 90.0) -> Occluder:
    at = [(x, y, z) for x in (-half, half) for z in (-half, half)]
    return Occluder(at, [0, 1, 2, 1, 3, 2])


@pytest.mark.usefixtures("world")
@pytest.mark.parametrize("speed", [0.0, 6.0])
def test_a_games_shader_reads_what_samples_say(
    ctx: moderngl.Context, reader: Reader, speed: float
) -> None:
    with Weather(context=ctx, quality="low") as weather:
        points = [(4.0, 0.0, 3.0), (-6.0, 0.0, -8.0), (20.0, 3.1, 0.0), (150.0, 0.0, 0.0)]
        assert (reader(weather, points) == 0.0).all()  # before the first draw
        esper.create_entity(RainArea((0, 0), (70, 70), 25.0))
        esper.create_entity(Wind((1, 0), speed))
        esper.create_entity(ground())
        cover = Occluder([(x, 3, z) for x in (17, 23) for z in (-3, 3)], [0, 1, 2, 1, 3, 2])
        esper.create_entity(cover)
        for _ in range(60 * 5):
            esper.process(0.2)
            weather.draw(look_from((0, 1.7, 0), 0.0), perspective())
        got = reader(weather, points)
        for k in (0, 1):
            wet = weather.sample(points[k]).wetness
            assert got[k, 0] == pytest.approx(wet, rel=0.05)
            assert got[k, 2] == pytest.approx(wet, rel=0.05)
            assert got[k, 1] == pytest.approx(np.clip(6.0 * wet - 2.0, 0, 1), abs=0.15)
            assert got[k, 3] == pytest.approx(1.0 - np.exp(-wet / 0.12), abs=0.02)
        assert got[2, 0] == pytest.approx(weather.sample(points[0]).wetness, rel=0.05)
        assert (got[3] == 0.0).all()
        shift = 3.0 * speed / fall_speed_over(np.array([25.0]))
        below = [(20.0 + shift, 0.0, 0.0), (20.0 + shift + 1.5, 1.0, 1.0)]
        assert all(weather.sample(p).sheltered for p in below)
        assert (reader(weather, below)[:, :2] < 1e-3).all()
        walls = reader(weather, points[:1], normal=(1, 0, 0))[0, 0]
        roofs = reader(weather, points[:1], normal=(0, -1, 0))[0, 0]
        assert roofs == 0.0
        assert walls < 0.5 * got[0, 0]
        assert reader(weather, points[:1], normal=(0.7, 0.7, 0.1))[0, 1] == 0.0
        assert reader(weather, points[:1], relief=9.0)[0, 1] == 0.0


@pytest.mark.usefixtures("world")
def test_it_dries_when_the_rain_is_over(ctx: moderngl.Context, reader: Reader) -> None:
    with Weather(context=ctx, quality="low") as weather:
        rain = RainArea((0, 0), (70, 70), 60.0, onset=0.0)
        esper.create_entity(rain)
        esper.create_entity(Wind((1, 0), 4.0))
        esper.create_entity(ground())

        def run(seconds: float) -> float:
            for _ in range(round(seconds / 0.5)):
                esper.process(0.5)
                weather.draw(look_from((0, 1.7, 0), 0.0), perspective())
            return float(reader(weather, [(4.0, 0.0, 3.0)])[0, 0])

        wet = run(40.0)
        place = weather._renderer._wetness._observed[0].place
        rain.rain_rate = 0.0
        assert run(90.0) == pytest.approx(wet * np.exp(-90.0 / DRYING), rel=0.05)
        assert weather._renderer._wetness._observed[0].place == place


@pytest.mark.usefixtures("world")
def test_every_observer_has_a_map_of_its_own(ctx: moderngl.Context, reader: Reader) -> None:
    with Weather(context=ctx, quality="low") as weather:
        esper.create_entity(RainArea((0, 0), (70, 70), 25.0))
        esper.create_entity(ground())
        left, right = Observer((0, 1.7, 0)), Observer((60, 1.7, 0))
        for _ in range(20):
            esper.process(0.25)
            for it in (left, right):
                weather.draw(look_from(it.position, 0.0), perspective(), observer=it)
        assert weather.wetness(observer=left) is weather.wetness(observer=left)
        assert weather.wetness(observer=left) is not weather.wetness(observer=right)
        for it in (left, right):
            at = (it.position[0] + 3.0, 0.0, 1.0)
            expected = weather.sample(at).wetness
            assert reader(weather, [at], observer=it)[0, 0] == pytest.approx(expected, rel=0.2)


@pytest.mark.usefixtures("world")
def test_a_host_that_has_the_map_bound_may_close_the_weather(
    ctx: moderngl.Context, reader: Reader, gl: GL
) -> None:
    weather = Weather(context=ctx, quality="low")
    reader(weather, [(0.0, 0.0, 0.0)])
    weather.wetness().use(reader.program)
    weather.close()
    assert gl.error() == 0


@pytest.mark.usefixtures("world")
def test_a_server_has_no_map() -> None:
    with Weather() as weather, pytest.raises(ContextError):
        weather.wetness()


@pytest.mark.usefixtures("world")
@pytest.mark.parametrize("seed", [1, 2, 3])
def test_a_host_in_any_state_gets_the_same_map_and_its_state_back(
    ctx: moderngl.Context, gl: GL, keep: Callable[[Any], Any], seed: int
) -> None:
    found, outer = [], StateGuard(ctx, gl)
    host = Host(ctx, gl, keep, seed)
    for scrambled in (False, True):
        esper.clear_database()
        with outer, Weather(context=ctx, quality="low", seed=seed) as weather:
            esper.create_entity(RainArea((0, 0), (70, 70), 25.0))
            esper.create_entity(ground())
            gauge = RainGauge((5, 0.5, 0), window=5.0)
            esper.create_entity(gauge)
            host.framebuffers[0].use()
            for k in range(12):
                esper.process(0.25)
                if scrambled:
                    host.scramble()
                    before = read_state(gl)
                weather.draw(look_from((0.8 * k, 1.7, 0), 0.0), perspective())
                if scrambled:
                    assert read_state(gl) == before
            outer.reset()
            gl.glDisable(0x8DB9)  # sRGB, which the guard leaves to the host
            seen = weather._renderer._wetness._observed[0]
            found.append((seen.textures[seen.current].read(), gauge.rate))
    outer.release()
    while gl.error() == 0x0506:  # the host has had the window's framebuffer bound; there is none
        pass
    assert found[0] == found[1]


@pytest.mark.usefixtures("world")
def test_drawing_gauges_and_maps_leave_no_trace_in_a_snapshot(ctx: moderngl.Context) -> None:
    def run(draws: bool) -> bytes:
        target = ctx.simple_framebuffer((32, 18)) if draws else None
        if target is not None:
            target.use()
        with fresh_world(), Weather(context=ctx if draws else None, seed=3) as weather:
            esper.create_entity(RainArea((0, 0), (70, 40), 25.0, velocity=(3, 0)))
            esper.create_entity(RainArea((90, 0), (40, 40), 5.0, drift=0.5))
            esper.create_entity(Wind((0, 1), 6.0))
            esper.create_entity(ground())
            esper.create_entity(RainGauge((4, 0, 0)))
            for _ in range(30):
                esper.process(0.37)
                if draws:
                    weather.draw(look_from((0, 1.7, 0), 0.0), perspective())
            data = weather.snapshot()
        if target is not None:
            for thing in (*target.color_attachments, target.depth_attachment, target):
                thing.release()  # type: ignore[union-attr]
        return data

    assert run(True) == run(False)


@pytest.mark.usefixtures("world")
@pytest.mark.parametrize(("resolution", "extent"), [(0.125, 1.05), (0.3, 8.0), (4.0, 2.0)])
def test_maps_of_any_size(
    ctx: moderngl.Context, reader: Reader, resolution: float, extent: float
) -> None:
    with Weather(context=ctx, quality="low") as weather:
        limits = CollisionHeightmap()
        esper.create_entity(limits)
        esper.create_entity(RainArea((0, 0), (400, 400), 60.0))
        esper.create_entity(ground(half=500.0))
        for k in range(60):
            if k == 20:
                limits.resolution, limits.extent = resolution, extent
            esper.process(0.5)
            weather.draw(look_from((0, 1.7, 0), 0.0), perspective())
        heightmap = weather._renderer.heightmap()
        assert heightmap.size == pytest.approx(256 * resolution, abs=4)
        assert heightmap.footprint.half == extent * 30.0
        assert weather._renderer._wetness._observed[0].place.size == heightmap.size // 2 - 2
        points = [(4.0, 0.0, 3.0), (-0.8 * extent * 30.0, 0.0, 20.0)]
        expected = weather.sample(points[0]).wetness
        assert reader(weather, points)[:, 0] == pytest.approx([expected] * 2, rel=0.05)
