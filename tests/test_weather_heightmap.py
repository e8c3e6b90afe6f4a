"""The collision heightmap as a game's own shaders read it."""

from __future__ import annotations

import re

import esper
import moderngl
import numpy as np
import pytest

from tests.boxes import CORNERS, TRIANGLES, placed
from tests.views import look_from, perspective
from weather_ecs import Weather, glsl
from weather_ecs.components import Occluder, RainArea, Wind
from weather_ecs.errors import ContextError
from weather_ecs.gpu.weather_heightmap import WEATHER_HEIGHTMAP

pytestmark = pytest.mark.usefixtures("world")
BODY = "got = vec2(weather_rain_meets(in_at), weather_rained_on(in_at));"


def read(ctx: moderngl.Context, weather: Weather, points: np.ndarray) -> np.ndarray:
    """Both functions of the include, at points (n, 3)."""
    main = "in vec3 in_at; out vec2 got; void " + "main() {" + BODY + "}"
    text = "#" + "version 330\n" + glsl("heightmap.glsl") + main
    program = ctx.program(vertex_shader=text, varyings=["got"])
    source = ctx.buffer(points.astype(np.float32).tobytes())
    out = ctx.buffer(reserve=8 * len(points))
    array = ctx.vertex_array(program, [(source, "3f", "in_at")])
    target = ctx.simple_framebuffer((8, 8))
    target.use()
    weather.heightmap().use(program)
    array.transform(out, moderngl.POINTS)
    got = np.frombuffer(out.read(), np.float32).reshape(-1, 2).copy()
    for thing in (*target.color_attachments, target.depth_attachment, target):
        thing.release()
    for thing in (array, out, source, program):
        thing.release()
    return got


def test_the_block_in_the_public_include_is_the_declared_one() -> None:
    text = glsl("heightmap.glsl")
    (found,) = re.findall(r"uniform WeatherHeightmap\s*\{(.*?)\};", text, re.S)
    members = [line.strip() for line in found.strip().splitlines()]
    assert members == [f"{field.glsl};" for field in WEATHER_HEIGHTMAP.fields]


@pytest.mark.parametrize("speed", [0.0, 6.0])
def test_a_games_shader_is_told_what_samples_say(ctx: moderngl.Context, speed: float) -> None:
    target = ctx.simple_framebuffer((32, 18))
    with Weather(context=ctx, quality="medium") as weather:
        points = np.random.default_rng(4).uniform((-9, 0.1, -9), (9, 2.5, 9), (300, 3))
        bare = read(ctx, weather, points)
        assert (bare == (np.float32(-1e9), 1.0)).all()  # before the first draw
        assert weather.heightmap().texture is None and weather.heightmap().matrix is None
        esper.create_entity(RainArea((0, 0), (90, 90), 25.0))
        esper.create_entity(Wind((1, 0), speed))
        esper.create_entity(Occluder(CORNERS, TRIANGLES, placed((0, -0.5, 0), (40, 0.5, 40))))
        roof = Occluder(CORNERS, TRIANGLES, placed((2, 4, 0), (3, 0.1, 4)), dynamic=True)
        esper.create_entity(roof)
        for shift in (0.0, -5.0):
            roof.transform = placed((2 + shift, 4, 0), (3, 0.1, 4))
            target.use()
            for _ in range(4):
                esper.process(0.1)
                weather.draw(look_from((0, 1.7, 0), 0.0), perspective())
            top, open_sky = read(ctx, weather, points).T
            covered = np.array([weather.sample(p).sheltered for p in points.tolist()])
            assert 20 < covered.sum() < 280
            # Texels at the roof's rim aside.
            assert ((open_sky < 0.5) == covered).mean() > 0.96
            assert np.allclose(top[(open_sky < 0.5) & covered], 4.1, atol=0.25)
            assert np.median(np.abs(top[~covered])) < 0.02
        matrix = weather.heightmap().matrix
        assert matrix is not None
        u, v, depth = (matrix @ (0.0, 0.0, 0.0, 1.0))[:3]
        assert 0.4 < u < 0.6 and 0.4 < v < 0.6 and 0.0 < depth < 1.0
        assert weather.heightmap() is weather.heightmap()
        assert weather.heightmap().texture is not None
    for thing in (*target.color_attachments, target.depth_attachment, target):
        thing.release()


def test_there_is_none_without_opengl() -> None:
    with Weather() as weather, pytest.raises(ContextError):
        weather.heightmap()
